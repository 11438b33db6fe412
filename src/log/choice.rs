//! What `--log` asks for.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use tracing::level_filters::LevelFilter;

/// A level, or a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum LogChoice {
    /// Messages of this level and above, into the state folder.
    Level(LevelFilter),
    /// Messages up to level debug, into this file.
    File(PathBuf),
}

impl Default for LogChoice {
    fn default() -> Self {
        Self::Level(LevelFilter::INFO)
    }
}

impl FromStr for LogChoice {
    type Err = String;

    /// The file is overwritten: the ending keeps a project from being taken for one.
    fn from_str(text: &str) -> Result<Self, String> {
        Ok(match text {
            "error" => Self::Level(LevelFilter::ERROR),
            "warn" => Self::Level(LevelFilter::WARN),
            "info" => Self::Level(LevelFilter::INFO),
            "debug" => Self::Level(LevelFilter::DEBUG),
            "trace" => Self::Level(LevelFilter::TRACE),
            path if Path::new(path).extension().is_some_and(|ending| ending == "log") => {
                Self::File(path.into())
            }
            _ => {
                return Err(
                    "is neither a level (error, warn, info, debug, trace) nor a file that ends in .log"
                        .into(),
                );
            }
        })
    }
}

impl LogChoice {
    pub(super) fn level(&self) -> LevelFilter {
        match self {
            Self::Level(level) => *level,
            Self::File(_) => LevelFilter::DEBUG,
        }
    }

    pub(super) fn file(&self) -> Option<&Path> {
        match self {
            Self::Level(_) => None,
            Self::File(path) => Some(path),
        }
    }
}
