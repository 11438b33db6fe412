//! Target points, and their CSV and NPY files.

use std::path::Path;

use glam::{Vec2, Vec3};

use crate::files::npy::{self, Header, NpyError};
use crate::files::read_regular_file;
use crate::math::colour::luminance;
use crate::math::hilbert;
use crate::math::rng::{Purpose, Stream};
use crate::{Error, Result};

/// Largest file, bytes.
const MAX_BYTES: u64 = 64 << 20;
/// Most points.
const MAX_POINTS: usize = 10_000_000;
/// Largest coordinate; beyond it f32 squares lose their meaning.
const MAX_COORDINATE: f32 = 1e6;

/// Points on the plane, with optional colours.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points {
    /// Plane coordinates.
    pub positions: Vec<Vec2>,
    /// Relative colours, linear Rec. 709, of mean luminance 1; empty when the points have none.
    pub colours: Vec<Vec3>,
}

impl Points {
    /// A resampling to `n` points that keeps the density: a subset when there are more (another one in each pass),
    /// repetitions when there are fewer.
    pub fn resampled(&self, n: usize, seed: u64, pass: u64) -> Self {
        let count = self.positions.len();
        if count == n || count == 0 {
            return self.clone();
        }
        // Systematic sampling along a space-filling curve: neighbours on it are neighbours in the plane.
        let order = hilbert::order(&self.positions, Vec2::ZERO);
        let offset = Stream::new(seed, Purpose::Target, pass, 1).f64();
        let row = |i: usize| order[((i as f64 + offset) * count as f64 / n as f64) as usize % count] as usize;
        let positions = (0..n).map(|i| self.positions[row(i)]).collect();
        let colours =
            if self.colours.is_empty() { Vec::new() } else { (0..n).map(|i| self.colours[row(i)]).collect() };
        Self { positions, colours }.with_mean_luminance_one()
    }

    /// The points at the given rows, in that order.
    ///
    /// # Panics
    /// When a row is out of range.
    pub fn rows(&self, rows: &[usize]) -> Self {
        let positions = rows.iter().map(|&row| self.positions[row]).collect();
        let colours = if self.colours.is_empty() {
            Vec::new()
        } else {
            rows.iter().map(|&row| self.colours[row]).collect()
        };
        Self { positions, colours }.with_mean_luminance_one()
    }

    /// The same points with colours scaled to mean luminance 1; without colours if all are black.
    pub(super) fn with_mean_luminance_one(mut self) -> Self {
        let sum: f64 = self.colours.iter().map(|colour| f64::from(luminance(*colour))).sum();
        if sum > 0.0 {
            let scale = (self.colours.len() as f64 / sum) as f32;
            self.colours.iter_mut().for_each(|colour| *colour *= scale);
        } else {
            self.colours.clear();
        }
        self
    }
}

/// Reads a file of points in plane coordinates.
///
/// NPY (known by its content): an n x 2 or n x 5 array of f32 or f64. Anything else is text: on each line x, y and perhaps r,
/// g, b, parted by commas, semicolons, spaces or tabs; a first line of names, empty lines and lines from `#` are skipped.
///
/// # Errors
/// `Io`, `Limit` (64 MiB, 10 million points), or `Format` naming the line or row that cannot be a point.
pub fn load_points(path: &Path) -> Result<Points> {
    let bytes = read_regular_file(path, MAX_BYTES)?;
    let mut reader = PointReader { path, points: Points::default(), columns: 0 };
    if bytes.starts_with(npy::MAGIC) {
        reader.read_npy(&bytes)?;
    } else {
        reader.read_text(&bytes)?;
    }
    let points = reader.points;
    if points.positions.is_empty() {
        return Err(Error::format(path, "", "there are no points in it"));
    }
    let coloured = !points.colours.is_empty();
    let points = points.with_mean_luminance_one();
    if coloured && points.colours.is_empty() {
        return Err(Error::format(
            path,
            "",
            "all points are black; leave the colours out, or give them light",
        ));
    }
    Ok(points)
}

struct PointReader<'a> {
    path: &'a Path,
    points: Points,
    /// Numbers per point, 2 or 5; 0 before the first point.
    columns: usize,
}

impl PointReader<'_> {
    fn read_text(&mut self, bytes: &[u8]) -> Result<()> {
        let text =
            std::str::from_utf8(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)).map_err(|_| {
                Error::format(self.path, "", "this is neither NPY nor UTF-8 text; save it as one of them")
            })?;
        let mut first = true;
        // Lines that end with CR alone are those of old Macs.
        let end = if text.contains('\n') { '\n' } else { '\r' };
        for (number, line) in text.split(end).enumerate() {
            if line.trim().is_empty() || line.trim_start().starts_with('#') {
                continue;
            }
            let (numbers, count, readable) = numbers_of(line);
            if !(first && readable == 0) {
                let place = || format!("line {}", number + 1);
                if readable < count {
                    return Err(Error::format(self.path, place(), "not all its fields are numbers"));
                }
                self.add(&numbers[..count.min(6)], place)?;
            }
            first = false;
        }
        Ok(())
    }

    fn read_npy(&mut self, bytes: &[u8]) -> Result<()> {
        let bad = |error: NpyError| Error::format(self.path, "", error.to_string());
        let header = Header::parse(bytes).map_err(bad)?;
        let shape = &header.shape;
        // As many rows as points; a row for each of their numbers is read, too.
        let (count, columns, by_column) = match shape[..] {
            [count, columns @ (2 | 5)] => (count, columns, header.fortran_order),
            [columns @ (2 | 5), count] => (count, columns, !header.fortran_order),
            _ => {
                let what = format!(
                    "an array of shape {shape:?} cannot be points; save n x 2 (x, y) or n x 5 (x, y, r, g, b)"
                );
                return Err(Error::format(self.path, "", what));
            }
        };
        if count > MAX_POINTS as u64 {
            return Err(self.too_many());
        }
        let numbers = header.values(bytes).map_err(bad)?;
        let (count, columns) = (count as usize, columns as usize);
        let mut point = vec![0.0; columns];
        for row in 0..count {
            for (column, number) in point.iter_mut().enumerate() {
                *number = numbers[if by_column { column * count + row } else { row * columns + column }];
            }
            self.add(&point, || format!("row {row}"))?;
        }
        Ok(())
    }

    fn add(&mut self, numbers: &[f32], place: impl Fn() -> String) -> Result<()> {
        let bad = |what: &str| Err(Error::format(self.path, place(), what));
        if self.columns == 0 {
            self.columns = numbers.len();
        }
        if !matches!(numbers.len(), 2 | 5) || numbers.len() != self.columns {
            return bad("each point needs x, y, or x, y, r, g, b, and all points the same");
        }
        if !numbers.iter().all(|n| n.is_finite()) || numbers[..2].iter().any(|n| n.abs() > MAX_COORDINATE) {
            return bad("a number is NaN, infinite or too large; remove or correct the point");
        }
        if numbers[2..].iter().any(|n| *n < 0.0) {
            return bad("a colour is negative; give 0 or more");
        }
        if self.points.positions.len() == MAX_POINTS {
            return Err(self.too_many());
        }
        self.points.positions.push(Vec2::from_slice(numbers));
        if numbers.len() == 5 {
            self.points.colours.push(Vec3::from_slice(&numbers[2..]));
        }
        Ok(())
    }

    fn too_many(&self) -> Error {
        Error::Limit {
            place: format!("'{}'", self.path.display()),
            what: format!("there are more than {MAX_POINTS} points; use fewer"),
        }
    }
}

/// The first six numbers of a line, its number of fields, and how many of them are numbers.
///
/// Fields stand between commas, semicolons, tabs or spaces; commas are decimal points where others stand between the fields.
fn numbers_of(line: &str) -> ([f32; 6], usize, usize) {
    let mut numbers = [0.0; 6];
    let (mut count, mut readable) = (0, 0);
    let decimal_comma = has_decimal_commas(line);
    let separator = |c: char| matches!(c, ';' | '\t' | ' ' | '\r') || (c == ',' && !decimal_comma);
    for field in line.split(separator).filter(|field| !field.is_empty()) {
        let number = if decimal_comma { field.replace(',', ".").parse() } else { field.parse::<f32>() };
        if let Ok(number) = number {
            numbers[count.min(5)] = number;
            readable += 1;
        }
        count += 1;
    }
    (numbers, count, readable)
}

/// Whether a line has fields such as `0,5`, of which several stand in a row, and no decimal point.
fn has_decimal_commas(line: &str) -> bool {
    let fields = || line.split([';', '\t', ' ', '\r']).filter(|field| !field.is_empty());
    let decimal = |field: &str| {
        field.split_once(',').is_some_and(|(whole, part)| {
            whole.ends_with(|c: char| c.is_ascii_digit()) && part.starts_with(|c: char| c.is_ascii_digit())
        })
    };
    let single = |field: &str| field.matches(',').count() <= 1 && !field.ends_with(',');
    fields().count() > 1 && !line.contains('.') && fields().all(single) && fields().any(decimal)
}
