//! Wavefront OBJ: vertices, normals, faces, material names. Unknown statements are ignored, as the format requires; errors
//! name the line. Files are untrusted: every index is checked, nothing is allocated by their word.

use std::borrow::Cow;
use std::path::Path;

use glam::Vec3;

use crate::files::read_regular_file;
use crate::{Error, Progress, Result};

/// Largest file read [bytes].
const MAX_BYTES: u64 = 8 << 30;
/// Most triangles of one file.
const MAX_TRIANGLES: usize = 50_000_000;
/// No normal given.
pub(super) const NONE: u32 = u32::MAX;

/// A triangle by indices into [`ObjFile`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Face {
    pub vertices: [u32; 3],
    /// [`NONE`] where the file gives none.
    pub normals: [u32; 3],
    pub material: u32,
}

/// The content of a file: all indices checked, all vertices finite.
#[derive(Debug, Default)]
pub(super) struct ObjFile {
    pub positions: Vec<Vec3>,
    /// Not normalized; may be zero.
    pub normals: Vec<Vec3>,
    pub faces: Vec<Face>,
    /// Names by `usemtl`; the first is for faces before any.
    pub materials: Vec<String>,
    pub libraries: Vec<String>,
    /// Polygons of more than four corners, which were split into fans.
    pub polygons: usize,
}

/// Reads a file.
pub(super) fn read(path: &Path, progress: &Progress) -> Result<ObjFile> {
    parse(&read_regular_file(path, MAX_BYTES)?, path, progress)
}

/// The text of a file: UTF-8 with or without a byte order mark; other bytes (in names) are replaced.
pub(super) fn text<'a>(bytes: &'a [u8], path: &Path) -> Result<Cow<'a, str>> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(Error::format(path, "", "is UTF-16; save it as UTF-8 or plain text"));
    }
    Ok(String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)))
}

/// Calls `each` with number and text of every line; a `\` at its end continues a line.
pub(super) fn lines(text: &str, mut each: impl FnMut(usize, &str) -> Result<()>) -> Result<()> {
    let mut joined = String::new();
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        if let Some(head) = line.strip_suffix('\\') {
            joined.push_str(head);
            joined.push(' ');
        } else if joined.is_empty() {
            each(index + 1, line)?;
        } else {
            joined.push_str(line);
            each(index + 1, &joined)?;
            joined.clear();
        }
    }
    if joined.is_empty() { Ok(()) } else { each(text.lines().count(), &joined) }
}

fn parse(bytes: &[u8], path: &Path, progress: &Progress) -> Result<ObjFile> {
    let text = text(bytes, path)?;
    let mut reader = Reader { path, file: ObjFile::default(), material: 0, bad: 0, first_bad: 0 };
    reader.file.materials.push(String::new());
    lines(&text, |number, line| {
        progress.check()?;
        reader.line(number, line)
    })?;
    if reader.bad > 0 {
        let what = format!(
            "{} vertices or normals are no finite numbers; export the mesh again without them",
            reader.bad
        );
        return Err(Error::format(path, format!("first on line {}", reader.first_bad), what));
    }
    if reader.file.faces.is_empty() {
        let vertices = reader.file.positions.len();
        return Err(Error::format(path, "", format!("has no faces ({vertices} vertices): nothing to show")));
    }
    Ok(reader.file)
}

struct Reader<'a> {
    path: &'a Path,
    file: ObjFile,
    material: u32,
    /// Vectors that are not finite.
    bad: usize,
    first_bad: usize,
}

impl Reader<'_> {
    fn line(&mut self, number: usize, line: &str) -> Result<()> {
        let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        match keyword {
            "v" => {
                let position = self.vector(number, rest)?;
                self.file.positions.push(position);
            }
            "vn" => {
                let normal = self.vector(number, rest)?;
                self.file.normals.push(normal);
            }
            "f" => self.face(number, rest)?,
            "usemtl" => self.material = self.material_index(rest.trim()),
            "mtllib" => self.file.libraries.push(rest.trim().to_owned()),
            _ => (), // Texture coordinates, groups, lines, curves, comments.
        }
        Ok(())
    }

    fn error(&self, number: usize, what: String) -> Error {
        Error::format(self.path, format!("line {number}"), what)
    }

    fn vector(&mut self, number: usize, rest: &str) -> Result<Vec3> {
        let mut values = [0.0_f32; 3];
        let mut words = rest.split_ascii_whitespace();
        for value in &mut values {
            let word = words.next().unwrap_or("");
            *value = word
                .parse()
                .map_err(|_| self.error(number, format!("'{word}' is no number; three are needed")))?;
        }
        let vector = Vec3::from(values);
        if !vector.is_finite() {
            self.bad += 1;
            self.first_bad = if self.bad == 1 { number } else { self.first_bad };
        }
        Ok(vector)
    }

    fn material_index(&mut self, name: &str) -> u32 {
        let known = self.file.materials.iter().position(|known| known == name);
        known.unwrap_or_else(|| {
            self.file.materials.push(name.to_owned());
            self.file.materials.len() - 1
        }) as u32
    }

    /// One polygon, split into a fan of triangles.
    fn face(&mut self, number: usize, rest: &str) -> Result<()> {
        let mut first = None;
        let mut last = None;
        let mut count = 0;
        for word in rest.split_ascii_whitespace().take_while(|word| !word.starts_with('#')) {
            let corner = self.corner(number, word)?;
            count += 1;
            if let (Some(a), Some(b)) = (first, last) {
                self.push(number, [a, b, corner])?;
            }
            if first.is_none() {
                first = Some(corner);
            } else {
                last = Some(corner);
            }
        }
        self.file.polygons += usize::from(count > 4);
        if count < 3 {
            return Err(self.error(number, format!("face with {count} corners; at least 3 are needed")));
        }
        Ok(())
    }

    fn push(&mut self, number: usize, corners: [(u32, u32); 3]) -> Result<()> {
        if self.file.faces.len() >= MAX_TRIANGLES {
            return Err(Error::Limit {
                place: format!("'{}', line {number}", self.path.display()),
                what: format!(
                    "more than {MAX_TRIANGLES} triangles, which need about {} GB; reduce the mesh",
                    MAX_TRIANGLES / 5_000_000
                ),
            });
        }
        self.file.faces.push(Face {
            vertices: corners.map(|(vertex, _)| vertex),
            normals: corners.map(|(_, normal)| normal),
            material: self.material,
        });
        Ok(())
    }

    /// `vertex`, `vertex/texture`, `vertex//normal` or `vertex/texture/normal`, from 1, or from the end if negative.
    fn corner(&self, number: usize, word: &str) -> Result<(u32, u32)> {
        let mut fields = word.split('/');
        let vertex = fields.next().unwrap_or("");
        let normal = fields.nth(1).filter(|field| !field.is_empty());
        let vertex = self.index(number, vertex, self.file.positions.len(), "vertex")?;
        let normal = normal.map(|field| self.index(number, field, self.file.normals.len(), "normal"));
        Ok((vertex, normal.transpose()?.unwrap_or(NONE)))
    }

    fn index(&self, number: usize, field: &str, count: usize, kind: &str) -> Result<u32> {
        let wrong = |why: String| self.error(number, format!("face names {kind} '{field}', {why}"));
        let index: i64 = field.parse().map_err(|_| wrong("which is no whole number".into()))?;
        let from_zero = if index < 0 { i128::from(index) + count as i128 } else { i128::from(index) - 1 };
        if index == 0 {
            return Err(wrong("but OBJ counts from 1".into()));
        }
        if from_zero < 0 || from_zero >= count as i128 || from_zero >= i128::from(NONE) {
            return Err(wrong(format!("but only {count} stand before it")));
        }
        Ok(from_zero as u32)
    }
}
