//! Errors, by cause. Every message names the place, what is wrong, and what to do.

use std::path::{Path, PathBuf};

use crate::Note;

/// The result type of the core.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// The errors of the core, by cause; the command line maps each to an exit code.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The operating system refused: no such file, no permission, disk full.
    #[error("cannot {action} '{}': {source}", path.display())]
    Io {
        /// The failed action, as a verb: "read", "write", "create".
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The content of a file is malformed.
    #[error("'{}'{}: {what}", path.display(), if place.is_empty() { String::new() } else { format!(", {place}") })]
    Format {
        /// The file.
        path: PathBuf,
        /// The place in it, such as "line 3, column 7" or "face on line 12"; may be empty.
        place: String,
        /// What is wrong, and what to do.
        what: String,
    },
    /// A value of the project is out of range or contradicts another.
    #[error("{place}: {what}")]
    Value {
        /// The value's path in the project, such as `flow.gamma`.
        place: String,
        /// What is wrong, and what to do.
        what: String,
    },
    /// A limit is exceeded; refused before any memory is allocated.
    #[error("{place}: {what}")]
    Limit {
        /// The place of the request.
        place: String,
        /// The need, the limit, and what to do.
        what: String,
    },
    /// A solver or an integration failed; there is no result.
    #[error("{stage}: {what}")]
    Numeric {
        /// The stage that failed.
        stage: &'static str,
        /// The observation, such as a residual.
        what: String,
    },
    /// An error, with what was noted before it: often its cause.
    #[error("{error}{}", notes.iter().map(|note| format!("\n  note: {note}")).collect::<String>())]
    Noted {
        /// The error itself.
        error: Box<Error>,
        /// Notes for the artist.
        notes: Vec<Note>,
    },
    /// The user asked to stop.
    #[error("cancelled")]
    Cancelled,
}

impl Error {
    /// An input/output error at `path`, for `map_err`.
    pub fn io(action: &'static str, path: impl AsRef<Path>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.as_ref().to_owned();
        move |source| Self::Io { action, path, source }
    }

    /// Malformed content of a file.
    pub fn format(path: impl AsRef<Path>, place: impl Into<String>, what: impl Into<String>) -> Self {
        Self::Format { path: path.as_ref().to_owned(), place: place.into(), what: what.into() }
    }

    /// An invalid value of a project.
    pub fn value(place: impl Into<String>, what: impl Into<String>) -> Self {
        Self::Value { place: place.into(), what: what.into() }
    }

    /// The same error; one of a value tells `whose` it is, besides its place: `wall "upper hollow"`.
    pub fn of(self, whose: &str) -> Self {
        match self {
            Self::Value { place, what } => Self::Value { place, what: format!("{what} ({whose})") },
            error => error,
        }
    }

    /// The same error with notes, unless there are none, or nothing is wrong.
    pub fn with_notes(self, more: &[Note]) -> Self {
        match self {
            Self::Cancelled => self,
            _ if more.is_empty() => self,
            Self::Noted { error, notes } => {
                let all = more.iter().chain(notes.iter().filter(|note| !more.contains(note)));
                Self::Noted { notes: all.cloned().collect(), error }
            }
            error => Self::Noted { error: Box::new(error), notes: more.to_vec() },
        }
    }
}
