//! The content of a journal's file.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::Fingerprint;

/// An unsaved document as its journal holds it, in JSON.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Record {
    pub(super) path: Option<PathBuf>,
    pub(super) title: String,
    /// When the change was made, seconds since 1970.
    pub(super) time: u64,
    pub(super) seen: Option<Fingerprint>,
    /// The file, existing or not, that its paths are relative to; none in journals of earlier versions.
    #[serde(default)]
    pub(super) base: Option<PathBuf>,
    /// Files outside of its folder that the user let it read.
    #[serde(default)]
    pub(super) admitted: Vec<PathBuf>,
    /// The project file as it would have been saved.
    pub(super) text: String,
}
