//! Names of the files of a sequence: `name.0001.exr`.

use std::path::{Path, PathBuf};

use super::FrameFormat;
use crate::{Error, Result};

/// A name with a placeholder for the frame number, such as `shot.####` or `shot.%04d`. Compositing programs recognise a
/// sequence by the dot before the number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FramePattern {
    before: String,
    digits: usize,
    after: String,
}

impl FramePattern {
    /// Parses a pattern: one run of `#` (a digit each, at least) or `%04d`, after a dot. A known extension may follow and is
    /// dropped.
    ///
    /// # Errors
    /// Names `place` for a pattern without number or with a folder.
    pub fn parse(pattern: &str, place: &str) -> Result<Self> {
        let refuse = |what: String| Err(Error::value(place, what));
        if pattern.contains(['/', '\\', '\0']) {
            return refuse(format!("'{pattern}' must be a file name without folders"));
        }
        let stem = FrameFormat::ALL
            .iter()
            .find_map(|f| pattern.strip_suffix(f.extension())?.strip_suffix('.'))
            .unwrap_or(pattern);
        let Some((before, digits, after)) = split_number(stem) else {
            return refuse(format!(
                "'{pattern}' has no place for the frame number, so every frame would overwrite the last; write for \
                 example '{}.####'",
                stem.trim_end_matches('.')
            ));
        };
        if split_number(after).is_some() {
            return refuse(format!("'{pattern}' has two places for the frame number; keep one"));
        }
        let name = before.strip_suffix('.').filter(|name| !name.is_empty());
        if name.is_none() || !(1..=10).contains(&digits) {
            return refuse(format!(
                "'{pattern}' must be a name, a dot and a number of 1 to 10 digits: 'name.####'"
            ));
        }
        Ok(Self { before: before.to_owned(), digits, after: after.to_owned() })
    }

    /// The pattern of a sequence beside this one: `name_LAYER.####`.
    pub fn beside(&self, layer: &str) -> Self {
        let name = self.before.strip_suffix('.').unwrap_or(&self.before);
        Self { before: format!("{name}_{layer}."), ..self.clone() }
    }

    /// The file of a frame in `folder`.
    pub fn path(&self, folder: &Path, frame: i32, format: FrameFormat) -> PathBuf {
        let Self { before, digits, after } = self;
        folder.join(format!("{before}{frame:0digits$}{after}.{}", format.extension(), digits = *digits))
    }
}

/// The text before the placeholder, its digits, and the text after it.
fn split_number(text: &str) -> Option<(&str, usize, &str)> {
    if let Some(start) = text.find('#') {
        let digits = text[start..].bytes().take_while(|b| *b == b'#').count();
        return Some((&text[..start], digits, &text[start + digits..]));
    }
    text.match_indices('%').find_map(|(start, _)| {
        let rest = &text[start + 1..];
        let width = rest.bytes().take_while(u8::is_ascii_digit).count();
        let after = rest[width..].strip_prefix('d')?;
        let digits = if width == 0 { 1 } else { rest[..width].parse().ok()? };
        Some((&text[..start], digits, after))
    })
}
