//! Loading of a project file; errors name the place and the reason.

use std::path::Path;

use super::file::unknown;
use super::{Project, VERSION, field, schema_docs};
use crate::{Error, Result};

/// Largest project file; photons and pictures are in separate files.
pub(super) const MAX_BYTES: u64 = 64 << 20;

impl Project {
    /// Reads and checks a project file.
    ///
    /// # Errors
    /// A file that is unreadable, malformed or out of range; each names the file and the place in it.
    pub fn load(path: &Path) -> Result<Self> {
        Self::parse(&crate::files::read_regular_file(path, MAX_BYTES)?, path)
    }

    /// Parses and checks a project from text; `path` appears only in errors.
    pub fn parse(text: &[u8], path: &Path) -> Result<Self> {
        parse(text, path)
    }
}

/// See [`Project::parse`].
pub(super) fn parse(bytes: &[u8], path: &Path) -> Result<Project> {
    let text = text(bytes, path)?;
    if let Some(newer) = Newer::of(text) {
        newer.check_sufficient(path)?;
        return newer.known_part(text, path).map(|(project, _)| project);
    }
    strictly(text, path)
}

/// The project of a text without unknown fields.
fn strictly(text: &str, path: &Path) -> Result<Project> {
    let mut json = serde_json::Deserializer::from_str(text);
    let read: Result<Project, _> = serde_path_to_error::deserialize(&mut json);
    let project = read.map_err(|error| {
        let field = field::at_fault(text, &error);
        let inner = error.into_inner();
        let place = place(&inner, &field);
        Error::format(path, place, what(&inner, &field))
    })?;
    json.end().map_err(|e| {
        Error::format(path, place(&e, "."), "more text stands after the project's closing brace")
    })?;
    project.check().map_err(|error| in_file(error, path))?;
    Ok(project)
}

/// As [`parse`], but unknown fields are skipped; their paths are returned with the project. A file of a later version is read
/// as far as this program knows it.
pub(super) fn parse_tolerantly(bytes: &[u8], path: &Path) -> Result<(Project, Vec<String>)> {
    if let Some(newer) = Newer::of(text(bytes, path)?) {
        newer.check_readable(path)?;
        return newer.known_part(text(bytes, path)?, path);
    }
    match parse(bytes, path) {
        Ok(project) => Ok((project, Vec::new())),
        Err(_) => known_part(text(bytes, path)?, path),
    }
}

/// The project without unknown fields, and the paths of those.
fn known_part(text: &str, path: &Path) -> Result<(Project, Vec<String>)> {
    let stripped = unknown::strip(text, &Project::json_schema()).filter(|(_, unknown)| !unknown.is_empty());
    // Where nothing is left out, an error has its line and column.
    let Some((known, unknown)) = stripped else { return Ok((strictly(text, path)?, Vec::new())) };
    let read: Result<Project, _> =
        serde_path_to_error::deserialize(&mut serde_json::Deserializer::from_str(&known));
    let project = read.map_err(|error| {
        let field = field::at_fault(&known, &error);
        // Line and column are those of the shortened text.
        Error::format(path, &field, what(error.inner(), &field))
    })?;
    project.check().map_err(|error| in_file(error, path))?;
    Ok((project, unknown))
}

/// What a file that a later program wrote says of its version.
#[derive(serde::Deserialize)]
struct Newer {
    lightloom: u64,
    minimum_reader: Option<u64>,
}

impl Newer {
    fn of(text: &str) -> Option<Self> {
        serde_json::from_str::<Self>(text).ok().filter(|newer| newer.lightloom > VERSION.into())
    }

    /// Refuses a file that asks for a later reader.
    fn check_readable(&self, path: &Path) -> Result<()> {
        match self.minimum_reader {
            Some(reader) if reader > VERSION.into() => Err(self.refused(path, reader)),
            _ => Ok(()),
        }
    }

    /// Refuses a file that does not say itself that what this program knows is enough: a picture of it may be wrong.
    fn check_sufficient(&self, path: &Path) -> Result<()> {
        match self.minimum_reader.unwrap_or(self.lightloom) {
            reader if reader > VERSION.into() => Err(self.refused(path, reader)),
            _ => Ok(()),
        }
    }

    fn refused(&self, path: &Path, reader: u64) -> Error {
        let look = if self.minimum_reader.is_none() { "; the editor opens it read-only" } else { "" };
        let what = format!(
            "the file is of version {} and needs a program that reads version {reader}, this one reads up to {VERSION}; use a \
             newer Lightloom{look}",
            self.lightloom
        );
        Error::format(path, "lightloom", what)
    }

    /// See [`known_part`]; what is no longer as this program knows it is told to be newer.
    fn known_part(&self, text: &str, path: &Path) -> Result<(Project, Vec<String>)> {
        known_part(text, path).map_err(|error| match error {
            Error::Format { path, place, what } => {
                let version = self.lightloom;
                let what =
                    format!("{what}; the file is of version {version}, later than this program's {VERSION}");
                Error::Format { path, place, what }
            }
            other => other,
        })
    }
}

/// The bytes as UTF-8 text without byte order mark.
fn text<'a>(bytes: &'a [u8], path: &Path) -> Result<&'a str> {
    if matches!(bytes, [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [_, 0, _, 0, ..] | [0, _, 0, _, ..]) {
        return Err(Error::format(path, "", "is written in UTF-16; save it as UTF-8"));
    }
    let text = std::str::from_utf8(bytes).map_err(|e| {
        Error::format(path, format!("byte {}", e.valid_up_to()), "is not UTF-8 text; save it as UTF-8")
    })?;
    let text = text.trim_start_matches('\u{feff}');
    if text.trim().is_empty() {
        return Err(Error::format(
            path,
            "",
            "is an empty project; `lightloom schema` shows what it may hold",
        ));
    }
    Ok(text)
}

/// "line 3, column 7, flow.gamma"
fn place(error: &serde_json::Error, field: &str) -> String {
    let position = format!("line {}, column {}", error.line(), error.column());
    if field == "." { position } else { format!("{position}, {field}") }
}

/// The parser's reason without its position, with the description of the field.
fn what(error: &serde_json::Error, field: &str) -> String {
    let full = error.to_string();
    let reason = full.rsplit_once(" at line ").map_or(full.as_str(), |(reason, _)| reason);
    match (error.is_eof(), schema_docs::description(&Project::json_schema(), field)) {
        (true, _) => format!("the file ends too early ({reason}); is it cut off?"),
        (false, Some(meaning)) => format!("{reason}. This is: {meaning}"),
        (false, None) => reason.to_owned(),
    }
}

/// Adds the file to a value error.
fn in_file(error: Error, path: &Path) -> Error {
    match error {
        Error::Value { place, what } => Error::Format { path: path.to_owned(), place, what },
        Error::Limit { place, what } => {
            Error::Limit { place: format!("'{}', {place}", path.display()), what }
        }
        other => other,
    }
}
