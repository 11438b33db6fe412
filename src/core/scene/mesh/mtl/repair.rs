//! An MTL file in the form that tobj reads: of each material the values that a scene uses, spelled as the format asks.

use std::fmt::Write as _;
use std::path::Path;

use super::super::text::{self, Lines};
use crate::{Error, Result};

/// Most materials of a file: a scene can tell no more objects apart.
const MOST_MATERIALS: usize = u16::MAX as usize;
/// Most notes on a material.
const MOST_NOTES: usize = 8;

/// The spelling of the values that are used.
const VALUES: [(&str, Kind); 8] = [
    ("Kd", Kind::Colour),
    ("Ks", Kind::Colour),
    ("Tf", Kind::Colour),
    ("absorption", Kind::Colour),
    ("Ni", Kind::Number),
    ("d", Kind::Number),
    ("Tr", Kind::Number),
    ("illum", Kind::Model),
];

#[derive(Clone, Copy)]
enum Kind {
    Colour,
    Number,
    Model,
}

/// The name of a material, and notes on its lines.
pub(super) struct Header {
    pub(super) name: String,
    pub(super) notes: Vec<String>,
}

/// A repaired file. A material is called by its number in `headers`, since tobj refuses some names.
#[derive(Default)]
pub(super) struct Repaired {
    pub(super) text: String,
    pub(super) headers: Vec<Header>,
}

/// Repairs the file at `path`.
///
/// # Errors
/// `Format` where the file is no text or has too many materials.
pub(super) fn repair(bytes: &[u8], path: &Path) -> Result<Repaired> {
    let mut file = Repaired::default();
    for (number, line) in Lines::new(bytes, path)? {
        let (keyword, rest) = text::keyword(&line);
        if keyword.eq_ignore_ascii_case("newmtl") {
            if file.headers.len() == MOST_MATERIALS {
                let what = format!("more than {MOST_MATERIALS} materials; leave out those that are not used");
                return Err(Error::format(path, format!("line {number}"), what));
            }
            let _ = writeln!(file.text, "newmtl {}", file.headers.len());
            file.headers.push(Header { name: rest.to_owned(), notes: Vec::new() });
            continue;
        }
        let value = VALUES.iter().find(|(name, _)| keyword.eq_ignore_ascii_case(name));
        let (Some((name, kind)), Some(header)) = (value, file.headers.last_mut()) else { continue };
        let mut why = None;
        let numbers = numbers(rest, &mut why);
        if let Some(value) = kind.spelled(&numbers) {
            let _ = writeln!(file.text, "{name} {value}");
        } else {
            why.get_or_insert_with(|| "a number is missing or out of range".to_owned());
        }
        if let Some(why) = why.filter(|_| header.notes.len() < MOST_NOTES) {
            let file = path.file_name().unwrap_or_default().to_string_lossy();
            header.notes.push(format!("'{file}', line {number}, {keyword}: {why}"));
        }
    }
    Ok(file)
}

impl Kind {
    /// The value as tobj reads it; nothing where a number is missing or makes no sense.
    fn spelled(self, numbers: &[f64]) -> Option<String> {
        let first = *numbers.first()?;
        match self {
            // One number applies to all channels.
            Self::Colour => {
                let channel = |i: usize| numbers.get(i).unwrap_or(&first);
                Some(format!("{first} {} {}", channel(1), channel(2)))
            }
            Self::Number => Some(first.to_string()),
            // Some programs write 6.0.
            Self::Model => (0.0..=255.0).contains(&first).then(|| first.round().to_string()),
        }
    }
}

/// The numbers at the beginning of a value, after options such as `-halo`; `why` tells what could not be read as written.
fn numbers(rest: &str, why: &mut Option<String>) -> Vec<f64> {
    let mut numbers = Vec::new();
    let words = text::without_comment(rest).split_ascii_whitespace();
    for word in words.skip_while(|word| word.starts_with('-') && word.parse::<f64>().is_err()).take(3) {
        match word.parse().ok().filter(|number: &f64| number.is_finite()) {
            Some(number) => numbers.push(number),
            None => {
                let comma = text::decimal_comma(word);
                *why = Some(match comma {
                    Some(number) => format!("'{word}' has a decimal comma; read as {number}"),
                    None => format!("'{word}' is no number that is read here; the line is left out"),
                });
                let Some(number) = comma else { return Vec::new() };
                numbers.push(number);
            }
        }
    }
    numbers
}
