//! An OBJ file in the form that tobj reads: what it refuses is repaired, what nobody can read is an error with its line.
//!
//! Of each vertex and normal three numbers are left, of each corner its vertex and its normal. Faces of one material stand
//! under `g NUMBER`, since tobj forgets the names of materials that it does not know. Long groups are cut, which bounds the
//! memory that tobj takes for them.

use std::collections::HashMap;
use std::io::{self, BufRead, Read, Write as _};
use std::path::Path;

use super::super::text::{self, Lines};
use crate::{Error, Progress, Result};

/// Most triangles of one file.
const MAX_TRIANGLES: usize = 50_000_000;
/// Bytes handed on at once.
const CHUNK: usize = 64 << 10;
/// Most polygons of a group.
const GROUP: usize = 64 << 10;

/// The reader of a repaired file.
pub(super) struct Repair<'a> {
    path: &'a Path,
    lines: Lines<'a>,
    progress: &'a Progress,
    /// Repaired lines; those before `used` have been read.
    out: Vec<u8>,
    used: usize,
    positions: usize,
    normals: usize,
    /// Where the zero normal was put in, for corners that have none.
    zero_normal: Option<usize>,
    triangles: usize,
    /// Polygons since the last `g`.
    in_group: usize,
    material: usize,
    by_name: HashMap<String, usize>,
    /// Names by `usemtl`; the first is for faces before any.
    pub(super) materials: Vec<String>,
    /// The rest of every `mtllib` line.
    pub(super) libraries: Vec<String>,
    /// Normals that are not finite, and the line of the first.
    pub(super) bad_normals: (usize, usize),
    bad_vertices: (usize, usize),
    /// Why reading ended early.
    pub(super) failure: Option<Error>,
}

impl<'a> Repair<'a> {
    /// # Errors
    /// `Format` where the file is no text.
    pub(super) fn new(bytes: &'a [u8], path: &'a Path, progress: &'a Progress) -> Result<Self> {
        Ok(Self {
            path,
            lines: Lines::new(bytes, path)?,
            progress,
            out: b"g 0\n".to_vec(),
            used: 0,
            positions: 0,
            normals: 0,
            zero_normal: None,
            triangles: 0,
            in_group: 0,
            material: 0,
            by_name: HashMap::from([(String::new(), 0)]),
            materials: vec![String::new()],
            libraries: Vec::new(),
            bad_normals: (0, 0),
            bad_vertices: (0, 0),
            failure: None,
        })
    }

    /// Repairs the next lines.
    fn refill(&mut self) -> Result<()> {
        self.progress.check()?;
        self.out.clear();
        self.used = 0;
        while self.out.len() < CHUNK
            && let Some((number, line)) = self.lines.next()
        {
            self.line(number, &line)?;
        }
        if self.out.is_empty() {
            return self.end();
        }
        Ok(())
    }

    /// At the end of the file.
    fn end(&self) -> Result<()> {
        let (bad, first) = self.bad_vertices;
        if bad > 0 {
            let what = format!("{bad} vertices are no finite numbers; export the mesh again without them");
            return Err(Error::format(self.path, format!("first on line {first}"), what));
        }
        if self.triangles == 0 {
            let what = format!("has no faces ({} vertices): nothing to show", self.positions);
            return Err(Error::format(self.path, "", what));
        }
        Ok(())
    }

    fn line(&mut self, number: usize, line: &str) -> Result<()> {
        let (keyword, rest) = text::keyword(line);
        if keyword.eq_ignore_ascii_case("v") {
            self.vertex(number, rest)?;
        } else if keyword.eq_ignore_ascii_case("vn") {
            self.normal(number, rest)?;
        } else if keyword.eq_ignore_ascii_case("f") {
            self.face(number, rest)?;
        } else if keyword.eq_ignore_ascii_case("usemtl") {
            self.material = self.material_index(rest);
            self.group();
        } else if keyword.eq_ignore_ascii_case("mtllib") {
            self.libraries.push(rest.to_owned());
        } // Else texture coordinates, groups, lines, curves, comments.
        Ok(())
    }

    /// Begins a group of the material.
    fn group(&mut self) {
        self.in_group = 0;
        let material = self.material;
        self.write(format_args!("g {material}\n"));
    }

    fn vertex(&mut self, number: usize, rest: &str) -> Result<()> {
        let (words, finite) = self.vector(number, rest)?;
        self.positions += 1;
        if !finite {
            count(&mut self.bad_vertices, number);
        }
        self.push_vector("v", if finite { words } else { ["0"; 3] });
        Ok(())
    }

    fn normal(&mut self, number: usize, rest: &str) -> Result<()> {
        let (words, finite) = self.vector(number, rest)?;
        if self.normals == 0 && self.in_group > 0 {
            // tobj would take normals for these faces, too, which have none.
            self.group();
        }
        self.normals += 1;
        if !finite {
            count(&mut self.bad_normals, number);
        }
        self.push_vector("vn", if finite { words } else { ["0"; 3] });
        Ok(())
    }

    /// The first three words, and whether all are finite; further ones are weights and colours.
    fn vector<'t>(&self, number: usize, rest: &'t str) -> Result<([&'t str; 3], bool)> {
        let mut words = rest.split_ascii_whitespace().take_while(|word| !word.starts_with('#'));
        let mut vector = [""; 3];
        let mut finite = true;
        for word in &mut vector {
            *word = words.next().unwrap_or("");
            let value = word.parse().ok().or_else(|| undefined(word).then_some(f64::NAN));
            let value = value.ok_or_else(|| {
                self.error(number, format!("{}; three numbers are needed", text::no_number(word)))
            })?;
            finite &= (value as f32).is_finite();
        }
        Ok((vector, finite))
    }

    fn push_vector(&mut self, keyword: &str, words: [&str; 3]) {
        for part in [keyword, " ", words[0], " ", words[1], " ", words[2], "\n"] {
            self.out.extend_from_slice(part.as_bytes());
        }
    }

    fn material_index(&mut self, name: &str) -> usize {
        let new = self.materials.len();
        let index = *self.by_name.entry(name.to_owned()).or_insert(new);
        if index == new {
            self.materials.push(name.to_owned());
        }
        index
    }

    fn face(&mut self, number: usize, rest: &str) -> Result<()> {
        let begin = self.out.len();
        self.out.push(b'f');
        let mut corners = 0;
        for word in rest.split_ascii_whitespace().take_while(|word| !word.starts_with('#')) {
            self.corner(number, word, begin)?;
            corners += 1;
        }
        self.out.push(b'\n');
        if corners < 3 {
            let what = format!("face with {corners} corners; at least 3 are needed");
            return Err(self.error(number, what));
        }
        self.triangles += corners - 2;
        if self.triangles > MAX_TRIANGLES {
            return Err(Error::Limit {
                place: format!("'{}', line {number}", self.path.display()),
                what: format!(
                    "more than {MAX_TRIANGLES} triangles, which need about {} GB; reduce the mesh",
                    MAX_TRIANGLES / 5_000_000
                ),
            });
        }
        self.in_group += 1;
        if self.in_group == GROUP {
            self.group();
        }
        Ok(())
    }

    /// `vertex`, `vertex/texture`, `vertex//normal` or `vertex/texture/normal`, from 1, or from the end if negative, of the
    /// face that begins at byte `begin`.
    fn corner(&mut self, number: usize, word: &str, begin: usize) -> Result<()> {
        let mut fields = word.split('/');
        let vertex = fields.next().unwrap_or("");
        let normal = fields.nth(1).filter(|field| !field.is_empty());
        let position = self.index(number, vertex, self.positions, "vertex")?;
        self.out.push(b' ');
        self.push_index(vertex, position, 0);
        let Some(normal) = normal else {
            if self.normals > 0 {
                let zero = self.zero_normal(begin);
                self.write(format_args!("//{}", zero + 1));
            }
            return Ok(());
        };
        let index = self.index(number, normal, self.normals, "normal")?;
        self.out.extend_from_slice(b"//");
        self.push_index(normal, index, usize::from(self.zero_normal.is_some_and(|zero| index >= zero)));
        Ok(())
    }

    /// The index that is written `field`, counted from 1, `shift` later.
    fn push_index(&mut self, field: &str, index: usize, shift: usize) {
        if shift == 0 && !field.starts_with('-') {
            self.out.extend_from_slice(field.as_bytes());
        } else {
            self.write(format_args!("{}", index + 1 + shift));
        }
    }

    /// The index of the zero normal, which is put before the face that begins at byte `begin`: tobj gives a corner without
    /// a normal that of the corner before it.
    fn zero_normal(&mut self, begin: usize) -> usize {
        *self.zero_normal.get_or_insert_with(|| {
            self.out.splice(begin..begin, *b"vn 0 0 0\n");
            self.normals
        })
    }

    fn index(&self, number: usize, field: &str, count: usize, kind: &str) -> Result<usize> {
        let wrong = |why: String| self.error(number, format!("face names {kind} '{field}', {why}"));
        let index: i64 = field.parse().map_err(|_| wrong("which is no whole number".into()))?;
        if index == 0 {
            return Err(wrong("but OBJ counts from 1".into()));
        }
        let from_zero = if index < 0 { i128::from(index) + count as i128 } else { i128::from(index) - 1 };
        usize::try_from(from_zero)
            .ok()
            .filter(|index| *index < count)
            .ok_or_else(|| wrong(format!("but only {count} stand before it")))
    }

    fn write(&mut self, text: std::fmt::Arguments<'_>) {
        // A Vec takes all that is written.
        let _ = self.out.write_fmt(text);
    }

    fn error(&self, number: usize, what: String) -> Error {
        Error::format(self.path, format!("line {number}"), what)
    }
}

/// Counts a line, and remembers the first.
fn count((count, first): &mut (usize, usize), line: usize) {
    *first = if *count == 0 { line } else { *first };
    *count += 1;
}

/// Whether a word is how the C libraries spell what is no number: `-nan(ind)`, `1.#QNAN`, `1.#INF`.
fn undefined(word: &str) -> bool {
    let word = word.trim_start_matches(['-', '+']);
    word.contains(".#") || word.get(..4).is_some_and(|head| head.eq_ignore_ascii_case("nan("))
}

impl Read for Repair<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(into)?;
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Repair<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.used == self.out.len()
            && let Err(error) = self.refill()
        {
            self.failure = Some(error);
            return Err(io::Error::other("the file was refused"));
        }
        Ok(&self.out[self.used..])
    }

    fn consume(&mut self, count: usize) {
        self.used += count;
    }
}
