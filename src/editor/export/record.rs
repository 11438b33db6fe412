//! Exports at work, in files: one that was cut off is offered at the next start.

use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use lightloom_core::engine::Existing;
use lightloom_core::files::{read_regular_file, try_hold, write_atomic};
use lightloom_core::project::{Admitted, Project};
use lightloom_core::{Error, Result};
use serde::{Deserialize, Serialize};

use super::job::ExportSettings;
use crate::editor::access::Access;

/// Ending of the files.
const ENDING: &str = "export.json";
/// Largest file.
const MAX_BYTES: u64 = 256 << 20;

/// The file of an export at work, locked by the program that does it.
#[derive(Debug)]
pub struct ExportRecord {
    path: PathBuf,
    _lock: File,
}

/// An export as it is written.
#[derive(Serialize, Deserialize)]
struct Written {
    project: Project,
    file: PathBuf,
    /// Files outside of the project's folder that it may read.
    admitted: Vec<PathBuf>,
    folder: PathBuf,
    film: Option<PathBuf>,
    limit_seconds: Option<f64>,
    shown: i32,
    overwrites: bool,
    skips: bool,
}

/// An export that was cut off.
#[derive(Debug)]
pub struct InterruptedExport {
    /// What was exported, as it was when it began.
    pub settings: ExportSettings,
    record: ExportRecord,
}

impl ExportRecord {
    /// Notes an export in a file of its own in `folder`, which is made if it is not there.
    ///
    /// # Errors
    /// The system refuses.
    pub(super) fn write(folder: &Path, settings: &ExportSettings) -> Result<Self> {
        std::fs::create_dir_all(folder).map_err(Error::io("create the folder", folder))?;
        let ExportSettings { project, file, access, folder: out, film, limit, shown, existing } = settings;
        let written = Written {
            project: (**project).clone(),
            file: file.clone(),
            admitted: access.admitted().files(),
            folder: out.clone(),
            film: film.clone(),
            limit_seconds: limit.map(|limit| limit.as_secs_f64()),
            shown: *shown,
            overwrites: *existing == Existing::Overwrite,
            skips: *existing == Existing::Skip,
        };
        let text = serde_json::to_string(&written)
            .map_err(|error| Error::value("project", format!("cannot be written as JSON: {error}")))?;
        let numbers = (0..).map(|number| format!("{}-{number}.{ENDING}", std::process::id()));
        let path = numbers.map(|name| folder.join(name)).find(|path| !path.exists());
        let path = path.unwrap_or_else(|| folder.join(ENDING));
        write_atomic(&path, |file| writeln!(file, "{text}"))?;
        Self::open(&path)?.ok_or_else(|| Error::value("export", "another program works at it"))
    }

    /// Takes over a file; none where another program works at its export.
    fn open(path: &Path) -> Result<Option<Self>> {
        let file = File::open(path).map_err(Error::io("read", path))?;
        Ok(try_hold(&file).then(|| Self { path: path.to_owned(), _lock: file }))
    }

    /// Removes the file: the export is not offered again.
    pub(super) fn forget(self) {
        // What cannot be removed is offered once more.
        let _ = std::fs::remove_file(&self.path);
    }
}

impl InterruptedExport {
    /// Removes its record: it is not offered again.
    pub fn forget(self) {
        self.record.forget();
    }
}

/// The exports that earlier runs left in the folder of their records.
pub fn interrupted(folder: &Path) -> Vec<InterruptedExport> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let ours = |path: &PathBuf| path.to_string_lossy().ends_with(ENDING);
    entries.filter(ours).filter_map(|path| read(&path).ok().flatten()).collect()
}

fn read(path: &Path) -> Result<Option<InterruptedExport>> {
    let Some(record) = ExportRecord::open(path)? else { return Ok(None) };
    let text = read_regular_file(path, MAX_BYTES)?;
    let written: Written =
        serde_json::from_slice(&text).map_err(|error| Error::format(path, "", error.to_string()))?;
    let existing = match (written.overwrites, written.skips) {
        (true, _) => Existing::Overwrite,
        (_, true) => Existing::Skip,
        _ => Existing::Refuse,
    };
    let settings = ExportSettings {
        project: Arc::new(written.project),
        file: written.file,
        access: Access::of(&Admitted::new(written.admitted)),
        folder: written.folder,
        film: written.film,
        limit: written.limit_seconds.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok()),
        shown: written.shown,
        existing,
    };
    Ok(Some(InterruptedExport { settings, record }))
}
