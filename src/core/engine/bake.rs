//! Results of stages in files, so that another process need not make them again: before the first pass of a render nothing
//! else takes time.

use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::files::{read_regular_file, write_atomic};
use crate::{Error, Result};

/// First line of the files.
const MAGIC: &[u8] = b"Lightloom bake\n";
/// Ending of the files.
const ENDING: &str = "bake";
/// The file that says what a folder was baked from.
const MANIFEST: &str = "bake.json";
/// Largest file.
const MAX_BYTES: u64 = 64 << 30;

/// A folder of baked results.
#[derive(Debug)]
pub(super) struct Bake {
    folder: PathBuf,
    fingerprint: String,
    /// Whether results are added to it.
    grows: bool,
}

/// What a folder was baked from.
#[derive(Serialize, Deserialize)]
struct Manifest {
    software: String,
    project: String,
    fingerprint: String,
}

impl Manifest {
    fn read(folder: &Path) -> Result<Self> {
        let path = folder.join(MANIFEST);
        let text = read_regular_file(&path, MAX_BYTES)?;
        serde_json::from_slice(&text)
            .map_err(|error| Error::format(&path, "", format!("is not what a bake leaves: {error}")))
    }
}

impl Bake {
    /// The fingerprint of the frames that are made from the results in `folder`.
    ///
    /// # Errors
    /// No results are there.
    pub(super) fn fingerprint_of(folder: &Path) -> Result<String> {
        Manifest::read(folder).map(|manifest| manifest.fingerprint)
    }

    /// The results of a run with this fingerprint, which are kept in `folder`.
    pub(super) fn growing(folder: &Path, fingerprint: &str) -> Self {
        Self { folder: folder.to_owned(), fingerprint: fingerprint.to_owned(), grows: true }
    }

    /// The complete results in `folder`, for a run with this fingerprint.
    ///
    /// # Errors
    /// No results are there, or those of another run.
    pub(super) fn of_folder(folder: &Path, fingerprint: &str) -> Result<Self> {
        let manifest = Manifest::read(folder)?;
        if manifest.fingerprint == fingerprint {
            return Ok(Self { grows: false, ..Self::growing(folder, fingerprint) });
        }
        let what = format!(
            "'{}' was baked from '{}' by {} with another content, size, quality or seed; give the same options as to the bake, or bake again",
            folder.display(),
            manifest.project,
            manifest.software
        );
        Err(Error::value("--bake", what))
    }

    /// Says that all results are there.
    ///
    /// # Errors
    /// The system refuses.
    pub(super) fn complete(&self, project: &str) -> Result<PathBuf> {
        let manifest = Manifest {
            software: concat!("Lightloom ", env!("CARGO_PKG_VERSION")).into(),
            project: project.into(),
            fingerprint: self.fingerprint.clone(),
        };
        let path = self.folder.join(MANIFEST);
        // Plain strings: serialisation has nothing to fail on.
        let text = serde_json::to_string_pretty(&manifest).unwrap_or_default();
        write_atomic(&path, |file| writeln!(file, "{text}"))?;
        Ok(path)
    }

    /// The result called `name`; none where it was not baked.
    ///
    /// # Errors
    /// A file that cannot be read, or is damaged.
    pub(super) fn read<T: DeserializeOwned>(&self, name: &str) -> Result<Option<T>> {
        let path = self.path(name);
        if !path.exists() {
            return Ok(None);
        }
        let bytes = read_regular_file(&path, MAX_BYTES)?;
        let damaged = || Error::format(&path, "", "is damaged, or baked by another version; bake again");
        let content =
            bytes.strip_prefix(MAGIC).and_then(|rest| rest.strip_prefix(self.fingerprint.as_bytes()));
        let (content, sum) = content.and_then(<[u8]>::split_last_chunk::<4>).ok_or_else(damaged)?;
        if crc32fast::hash(content) != u32::from_le_bytes(*sum) {
            return Err(damaged());
        }
        postcard::from_bytes(content).map(Some).map_err(|_| damaged())
    }

    /// Keeps a result, unless it is kept already, or nothing is added.
    ///
    /// # Errors
    /// The system refuses.
    pub(super) fn keep<T: Serialize>(&self, name: &str, result: &T) -> Result<()> {
        if !self.grows || self.path(name).exists() {
            return Ok(());
        }
        self.replace(name, result)
    }

    /// Keeps a result in place of an earlier one.
    ///
    /// # Errors
    /// The system refuses.
    pub(super) fn replace<T: Serialize>(&self, name: &str, result: &T) -> Result<()> {
        let path = self.path(name);
        let content = postcard::to_stdvec(result)
            .map_err(|error| Error::format(&path, "", format!("cannot be made: {error}")))?;
        write_atomic(&path, |file| {
            file.write_all(MAGIC)?;
            file.write_all(self.fingerprint.as_bytes())?;
            file.write_all(&content)?;
            file.write_all(&crc32fast::hash(&content).to_le_bytes())
        })
    }

    /// Removes a result, where there is one.
    ///
    /// # Errors
    /// The system refuses.
    pub(super) fn remove(&self, name: &str) -> Result<()> {
        let path = self.path(name);
        match std::fs::remove_file(&path) {
            Err(error) if error.kind() != ErrorKind::NotFound => Err(Error::io("remove", &path)(error)),
            _ => Ok(()),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name).with_extension(ENDING)
    }
}

/// The result called `name` of a bake, where there is one and it has it; otherwise that of `make`, which the bake keeps.
///
/// # Errors
/// Those of `make`; a file that is damaged or cannot be written.
pub(super) fn baked<T: Serialize + DeserializeOwned>(
    bake: Option<&Bake>,
    name: &str,
    make: impl FnOnce() -> Result<T>,
) -> Result<T> {
    let Some(bake) = bake else { return make() };
    if let Some(result) = bake.read(name)? {
        return Ok(result);
    }
    let result = make()?;
    bake.keep(name, &result)?;
    Ok(result)
}
