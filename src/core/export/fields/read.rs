//! Reading `fields.npz` back.

use std::path::Path;

use glam::Vec2;

use super::SegmentFields;
use crate::files::npz::NpzReader;
use crate::files::read_regular_file;
use crate::flow::field::{Field, Grid};
use crate::flow::meeting::MeetingFields;
use crate::flow::{Fade, Fields, SegmentFlow, Turbulence};
use crate::math::bspline::EXTRA;
use crate::{Error, Result};

/// Largest file.
const MAX_BYTES: u64 = 2 << 30;

/// Reads a file that [`super::write_fields`] wrote, in its order. Without walls, the fields carry photons as those that
/// were written do, bit for bit.
///
/// # Errors
/// `Io`, `Limit` (2 GiB), or `Format` naming the array that is missing or wrong, such as in a file of an older version.
pub fn load_fields(path: &Path) -> Result<Vec<SegmentFields>> {
    let bytes = read_regular_file(path, MAX_BYTES)?;
    let npz = NpzReader::new(&bytes).map_err(|error| Error::format(path, "", error.to_string()))?;
    let file = FieldsFile { path, npz };
    let [extent_x, extent_y] = file.numbers("extent")?;
    let suffixes = file.npz.names().filter_map(|name| name.strip_prefix("psi_"));
    let segments = suffixes.map(|suffix| {
        let (segment, caustic) = file.numbers_in(suffix)?;
        let flow = file.flow(suffix, Vec2::new(extent_x, extent_y))?;
        Ok(SegmentFields { segment, caustic, flow })
    });
    segments.collect()
}

struct FieldsFile<'a> {
    path: &'a Path,
    npz: NpzReader<'a>,
}

/// An array of coefficients: those of each time, on a grid of this many nodes along x and y.
struct Stack {
    nodes: [usize; 2],
    times: Vec<Vec<f32>>,
}

impl FieldsFile<'_> {
    fn flow(&self, suffix: &str, extent: Vec2) -> Result<SegmentFlow> {
        let name = |array: &str| format!("{array}_{suffix}");
        let (psi, phi) = (self.stack(&name("psi"))?, self.stack(&name("phi"))?);
        let cells = psi.nodes.map(|n| n - EXTRA);
        let grid = Grid { cells, extent };
        if psi.nodes != phi.nodes || psi.times.len() != phi.times.len() || extent.min_element() <= 0.0 {
            return Err(self.wrong(&name("phi"), "does not fit psi and the extent"));
        }
        let nodes = psi.times.iter().zip(&phi.times);
        let nodes = nodes.map(|(psi, phi)| Field::from_potentials(grid, psi, phi)).collect();
        let meeting = name("meeting");
        if self.npz.names().any(|own| own == meeting) {
            let [steps, mean_way, hold] = self.numbers(&meeting)?;
            let fields = MeetingFields::from_nodes(nodes, steps as usize, mean_way);
            let fields = fields.ok_or_else(|| self.wrong(&meeting, "asks for other fits than there are"))?;
            let fields = fields.with_hold(hold).with_turbulence(self.turbulence(suffix)?);
            return Ok(SegmentFlow::Meeting(fields));
        }
        let steps = self.numbers(&name("steps"))?.map(|n| n as usize);
        let [mean_straight] = self.numbers(&name("mean_straight"))?;
        let fields = Fields::from_spaced_nodes(nodes, steps, self.fade(suffix)?, mean_straight);
        let fields =
            fields.ok_or_else(|| self.wrong(&name("steps"), "asks for other fits than there are"))?;
        Ok(SegmentFlow::Fields(fields.with_turbulence(self.turbulence(suffix)?)))
    }

    fn fade(&self, suffix: &str) -> Result<Fade> {
        let paper = format!("fade_paper_{suffix}");
        let fade = if self.npz.names().any(|name| name == paper) {
            let [tau] = self.numbers(&paper)?;
            Fade::Paper { tau }
        } else {
            let [start, end, limit] = self.numbers(&format!("fade_smooth_{suffix}"))?;
            Fade::Smooth { start, end, limit }
        };
        fade.check("fade").map_err(|error| Error::format(self.path, "", error.to_string()))?;
        Ok(fade)
    }

    fn turbulence(&self, suffix: &str) -> Result<Option<Turbulence>> {
        let name = format!("turbulence_{suffix}");
        if !self.npz.names().any(|own| own == name) {
            return Ok(None);
        }
        let [rate, segment, speed] = self.numbers(&name)?;
        let prefix = format!("noise_keys_{suffix}_");
        let mut keys: Vec<Vec<Field>> = Vec::new();
        for array in self.npz.names().filter(|own| own.starts_with(&prefix)) {
            // The arrays of a segment's caustics begin like those of its shared flow.
            let Ok(cells) = array[prefix.len()..].parse() else { continue };
            let stack = self.stack(array)?;
            let grid = Turbulence::grid(cells, stack.nodes);
            let grid = grid.ok_or_else(|| self.wrong(array, "is no grid of square cells"))?;
            keys.resize_with(stack.times.len(), Vec::new);
            for (key, psi) in keys.iter_mut().zip(&stack.times) {
                key.push(Field::from_potentials(grid, psi, &vec![0.0; psi.len()]));
            }
        }
        let turbulence = Turbulence::from_keys(keys, rate, segment as usize, speed);
        turbulence.map(Some).ok_or_else(|| self.wrong(&name, "asks for other key noises than there are"))
    }

    fn array(&self, name: &str) -> Result<(Vec<u64>, Vec<f32>)> {
        let array = self.npz.array(name).map_err(|error| Error::format(self.path, "", error.to_string()))?;
        let (header, values) = array.ok_or_else(|| self.wrong(name, "is missing; fit the project anew"))?;
        if header.fortran_order || values.iter().any(|value| !value.is_finite()) {
            return Err(self.wrong(name, "is not in C order or holds a number that is not finite"));
        }
        Ok((header.shape, values))
    }

    fn numbers<const N: usize>(&self, name: &str) -> Result<[f32; N]> {
        let (_, values) = self.array(name)?;
        values.try_into().map_err(|_| self.wrong(name, &format!("has not {N} numbers")))
    }

    fn stack(&self, name: &str) -> Result<Stack> {
        let (shape, values) = self.array(name)?;
        match shape[..] {
            [_, rows, columns] if !values.is_empty() && rows.min(columns) > EXTRA as u64 => {
                let times = values.chunks_exact((rows * columns) as usize).map(<[f32]>::to_vec).collect();
                Ok(Stack { nodes: [columns as usize, rows as usize], times })
            }
            _ => Err(self.wrong(name, "is no stack of grids")),
        }
    }

    /// Segment and caustic in the end of an array's name.
    fn numbers_in(&self, suffix: &str) -> Result<(usize, Option<usize>)> {
        let (segment, caustic) = suffix.split_once('_').map_or((suffix, None), |(a, b)| (a, Some(b)));
        let numbers = segment.parse().ok().zip(caustic.map(str::parse).transpose().ok());
        numbers.ok_or_else(|| self.wrong(&format!("psi_{suffix}"), "has no segment's number in its name"))
    }

    fn wrong(&self, array: &str, what: &str) -> Error {
        Error::format(self.path, format!("array '{array}'"), what)
    }
}
