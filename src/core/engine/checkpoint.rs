//! The folder that keeps the unfinished light of a render beside its frames, for a run that goes on with it.
//!
//! It is there while a render works, and goes when all its frames are finished. What is left by one that was killed or
//! stopped is taken up by the next of the same fingerprint; what was left by another is removed.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::files::{read_regular_file, try_hold, write_atomic};
use crate::note::About;
use crate::project::Project;
use crate::{Error, Note, Result};

/// Begin of the names of the folders.
const PREFIX: &str = "unfinished-";
/// The file that says what is in one.
const MANIFEST: &str = "manifest.json";
/// The file that is locked while a process works with it.
const LOCK: &str = "lock";
/// Largest manifest.
const MAX_BYTES: u64 = 16 << 20;

/// The unfinished light of a render, held by this process.
#[derive(Debug)]
pub(super) struct Checkpoint {
    folder: PathBuf,
    frames: Vec<i32>,
    /// Whether the light may not have reached the disk.
    pub(super) checked: bool,
    /// Locked as long as it is open.
    _lock: File,
}

/// What is in such a folder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Manifest {
    fingerprint: String,
    /// Name of the project.
    project: String,
    /// The pattern of the files.
    files: String,
    /// All frames whose light is kept.
    frames: Vec<i32>,
    /// The run of the computer in which the light was written last: what one wrote, the next may not see.
    boot: String,
}

impl Checkpoint {
    /// The light that is kept in `out` for the `wanted` frames of a project, or none yet. No checkpoint where another process
    /// makes the same. `notes` are told what was found.
    ///
    /// # Errors
    /// The system refuses.
    pub(super) fn open(
        out: &Path,
        (project, fingerprint): (&Project, &str),
        wanted: &[i32],
        notes: &mut Vec<Note>,
    ) -> Result<Option<Self>> {
        let boot = boot();
        for (folder, mut manifest) in folders_in(out) {
            let same = manifest.fingerprint == fingerprint;
            let other = !same && manifest.files == project.output.name;
            let holds = same && has_all(&manifest.frames, wanted);
            if !other && !holds {
                continue;
            }
            let Some(lock) = lock(&folder)? else {
                if holds {
                    let text = "another process renders the same; this one keeps no unfinished light";
                    notes.push(About::Project.note(text));
                    return Ok(None);
                }
                continue;
            };
            if other {
                remove(&folder)?;
                notes.push(About::Project.note(format!(
                    "the unfinished light of a render with other settings was removed: '{}'",
                    folder.display()
                )));
                continue;
            }
            let checked = manifest.boot != boot || boot.is_empty();
            manifest.boot = boot;
            manifest.write(&folder)?;
            return Ok(Some(Self { folder, frames: manifest.frames, checked, _lock: lock }));
        }
        let [first, last] =
            [wanted.iter().min(), wanted.iter().max()].map(|frame| frame.copied().unwrap_or(0));
        let name = format!("{PREFIX}{}-{first}-{last}-{}", &fingerprint[..8], wanted.len());
        let folder = out.join(name);
        fs::create_dir_all(&folder).map_err(Error::io("create the folder", &folder))?;
        let Some(lock) = lock(&folder)? else { return Ok(None) };
        // Light of other frames, or of nobody knows which.
        let left = fs::read_dir(&folder).into_iter().flatten().flatten().map(|entry| entry.path());
        for path in left.filter(|path| !path.ends_with(LOCK)) {
            fs::remove_file(&path).map_err(Error::io("remove", &path))?;
        }
        let manifest = Manifest {
            fingerprint: fingerprint.into(),
            project: project.name.clone(),
            files: project.output.name.clone(),
            frames: wanted.to_vec(),
            boot,
        };
        manifest.write(&folder)?;
        Ok(Some(Self { folder, frames: wanted.to_vec(), checked: false, _lock: lock }))
    }

    /// The folder.
    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }

    /// All frames whose light it keeps.
    pub(super) fn frames(&self) -> &[i32] {
        &self.frames
    }

    /// Removes it, if all its frames are among the `finished`, and others of the same fingerprint.
    ///
    /// # Errors
    /// The system refuses.
    pub(super) fn finish(self, out: &Path, fingerprint: &str, finished: &[i32]) -> Result<()> {
        // Its own lock goes first.
        drop(self);
        remove_finished(out, fingerprint, finished)
    }
}

/// Removes the unfinished light of this fingerprint that nobody works with, where all its frames are among the `finished`.
///
/// # Errors
/// The system refuses.
pub(super) fn remove_finished(out: &Path, fingerprint: &str, finished: &[i32]) -> Result<()> {
    for (folder, manifest) in folders_in(out) {
        let done = manifest.fingerprint == fingerprint && has_all(finished, &manifest.frames);
        if done && lock(&folder)?.is_some() {
            remove(&folder)?;
        }
    }
    Ok(())
}

impl Manifest {
    fn write(&self, folder: &Path) -> Result<()> {
        // Plain strings and numbers: serialisation has nothing to fail on.
        let text = serde_json::to_string(self).unwrap_or_default();
        write_atomic(&folder.join(MANIFEST), |file| writeln!(file, "{text}"))
    }
}

/// Bytes on disk of the unfinished light that is kept in `out` for a run with this fingerprint.
pub(super) fn bytes_kept(out: &Path, fingerprint: &str) -> u64 {
    let files = |folder: PathBuf| fs::read_dir(folder).into_iter().flatten().flatten();
    let size = |file: fs::DirEntry| file.metadata().map_or(0, |file| file.len());
    let same = folders_in(out).into_iter().filter(|(_, manifest)| manifest.fingerprint == fingerprint);
    same.flat_map(|(folder, _)| files(folder)).map(size).sum()
}

/// The folders with unfinished light in `out`.
fn folders_in(out: &Path) -> Vec<(PathBuf, Manifest)> {
    let entries = fs::read_dir(out).into_iter().flatten().flatten().map(|entry| entry.path());
    let ours = |path: &PathBuf| {
        path.is_dir() && path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(PREFIX))
    };
    let mut folders: Vec<PathBuf> = entries.filter(ours).collect();
    folders.sort();
    let read = |folder: PathBuf| {
        let text = read_regular_file(&folder.join(MANIFEST), MAX_BYTES).ok()?;
        Some((folder, serde_json::from_slice(&text).ok()?))
    };
    folders.into_iter().filter_map(read).collect()
}

fn has_all(frames: &[i32], wanted: &[i32]) -> bool {
    let frames: BTreeSet<_> = frames.iter().collect();
    wanted.iter().all(|frame| frames.contains(frame))
}

/// The lock of a folder; none where another process has it.
fn lock(folder: &Path) -> Result<Option<File>> {
    let path = folder.join(LOCK);
    let mut options = File::options();
    let file = options.write(true).create(true).truncate(false).open(&path);
    let file = file.map_err(Error::io("write", &path))?;
    Ok(try_hold(&file).then_some(file))
}

fn remove(folder: &Path) -> Result<()> {
    fs::remove_dir_all(folder).map_err(Error::io("remove", folder))
}

/// The current run of the computer; empty where the system does not tell, which equals no other.
fn boot() -> String {
    fs::read_to_string("/proc/sys/kernel/random/boot_id").map_or(String::new(), |id| id.trim().into())
}
