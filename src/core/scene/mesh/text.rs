//! The lines of OBJ and MTL files: their line ends, continued lines, byte order marks and encodings.

use std::borrow::Cow;
use std::path::Path;

use crate::{Error, Result};

/// The lines of a file with the numbers they begin at, from 1.
///
/// A line ends with LF, CR LF or CR alone. A `\` at its end continues it, except in a comment. Lines that are not UTF-8 are
/// taken as Latin-1.
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    /// Of the next line.
    number: usize,
}

impl<'a> Lines<'a> {
    /// # Errors
    /// `Format` where the file is UTF-16.
    pub(super) fn new(bytes: &'a [u8], path: &Path) -> Result<Self> {
        if matches!(bytes, [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [_, 0, _, 0, ..] | [0, _, 0, _, ..]) {
            return Err(Error::format(path, "", "is UTF-16; save it as UTF-8 or plain text"));
        }
        Ok(Self { rest: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), number: 1 })
    }

    /// The next line as it stands in the file, without its end.
    fn physical(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let end = self.rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(self.rest.len());
        let (line, rest) = self.rest.split_at(end);
        self.rest = rest.strip_prefix(b"\r\n").or_else(|| rest.get(1..)).unwrap_or_default();
        Some(line.trim_ascii())
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, Cow<'a, str>);

    fn next(&mut self) -> Option<Self::Item> {
        let number = self.number;
        let line = self.physical()?;
        let Some(mut head) = continued(line) else { return Some((number, decode(line))) };
        let mut joined = Vec::new();
        loop {
            joined.extend_from_slice(head);
            joined.push(b' ');
            let Some(next) = self.physical() else { break };
            match continued(next) {
                Some(more) => head = more,
                None => {
                    joined.extend_from_slice(next);
                    break;
                }
            }
        }
        Some((number, Cow::Owned(decode(joined.trim_ascii()).into_owned())))
    }
}

/// What stands before the `\` at the end of a line that goes on; a comment does not.
fn continued(line: &[u8]) -> Option<&[u8]> {
    let head = line.strip_suffix(b"\\")?;
    let comment = head
        .iter()
        .enumerate()
        .any(|(at, byte)| *byte == b'#' && (at == 0 || head[at - 1].is_ascii_whitespace()));
    (!comment).then_some(head)
}

fn decode(line: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(line) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(line.iter().map(|byte| char::from(*byte)).collect()),
    }
}

/// First word and rest of a line.
pub(super) fn keyword(line: &str) -> (&str, &str) {
    let (word, rest) = line.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((line, ""));
    (word, rest.trim())
}

/// A name without what follows a `#`.
pub(super) fn without_comment(name: &str) -> &str {
    let comment = name
        .match_indices('#')
        .map(|(at, _)| at)
        .find(|at| name[..*at].chars().next_back().is_none_or(char::is_whitespace));
    name[..comment.unwrap_or(name.len())].trim()
}

/// A name without the quotes around it.
pub(super) fn without_quotes(name: &str) -> &str {
    let inner = ['"', '\''].iter().find_map(|quote| name.strip_prefix(*quote)?.strip_suffix(*quote));
    inner.unwrap_or(name).trim()
}

/// Why a word is no number, and what to do.
pub(super) fn no_number(word: &str) -> String {
    match decimal_comma(word) {
        Some(value) => format!("'{word}' has a decimal comma; export the file with decimal points ({value})"),
        None => format!("'{word}' is no number"),
    }
}

/// The number of a word whose decimal point is a comma.
pub(super) fn decimal_comma(word: &str) -> Option<f64> {
    let comma = word.matches(',').count() == 1
        && !word.contains('.')
        && !word.starts_with(',')
        && !word.ends_with(',');
    comma.then(|| word.replace(',', ".").parse().ok()).flatten()
}
