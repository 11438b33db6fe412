//! `lightloom render --claim`: several processes, on one machine or many, make the frames of one folder, a chunk at a time.
//!
//! Who works at a chunk holds the lock of a hidden file beside its frames. Others pass that chunk over, and what the dead
//! left is taken over. Such a file is no frame: frames come into the folder whole, in one step.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use lightloom_core::engine::{Engine, Output, Summary};
use lightloom_core::project::Project;
use lightloom_core::{Error, Result};
use serde_json::{Value, json};

use super::farm::list;
use super::job::Outcome;
use crate::file_lock::{FileLock, Locked};

/// How often it is looked whether the owner of a claim must show that it lives.
const LOOKS: Duration = Duration::from_secs(20);

/// What a process made of the frames that several share.
pub(super) struct Claimed {
    /// The chunks it worked at, in their order.
    pub(super) chunks: Vec<Summary>,
    /// The chunks that others work at, as lists of frames.
    left: Vec<String>,
    /// Number of all frames.
    frames: usize,
}

impl Claimed {
    /// The frames that were made here.
    fn made(&self) -> usize {
        self.chunks.iter().map(|chunk| chunk.frames).sum()
    }

    /// Whether it was stopped before its passes were done.
    pub(super) fn is_stopped(&self) -> bool {
        self.chunks.iter().any(Summary::is_stopped)
    }
}

impl Outcome for Claimed {
    const FILE: &'static str = "summary.json";

    /// The file would be about a part of the frames.
    fn is_reported(&self) -> bool {
        false
    }
    fn to_json(&self) -> String {
        let chunks =
            self.chunks.iter().filter_map(|chunk| serde_json::from_str::<Value>(&chunk.to_json()).ok());
        let chunks = chunks.collect::<Vec<_>>();
        format!("{:#}", json!({ "frames": self.made(), "claimed": chunks, "left": self.left }))
    }
    fn to_text(&self) -> String {
        let made = self.made();
        let also = match self.left.as_slice() {
            [] => "all are there".to_owned(),
            left => format!("others work at {}", left.join(", ")),
        };
        format!("{made} of {} frames were made here; {also}", self.frames)
    }
}

/// Claims chunks of `size` frames one after the other and makes them, until none is left that nobody works at.
///
/// # Errors
/// As of a render; a folder in which nothing can be locked.
pub(super) fn run(engine: &Engine, project: &Project, output: &Output, size: usize) -> Result<Claimed> {
    let frames = project.frames()?;
    let mut open: Vec<&[i32]> = frames.chunks(size.max(1)).collect();
    let mut claimed = Claimed { chunks: Vec::new(), left: Vec::new(), frames: frames.len() };
    loop {
        let before = open.len();
        let mut left = Vec::new();
        for chunk in open {
            let lock = match FileLock::take(&claim(output.folder, project, chunk)) {
                Locked::Here(lock, _) => lock,
                Locked::Elsewhere(_) => {
                    left.push(chunk);
                    continue;
                }
                Locked::Impossible => {
                    let what = format!("no file can be locked in '{}'", output.folder.display());
                    return Err(Error::value("--claim", what));
                }
            };
            let mut part = project.clone();
            part.output.frames = Some(list(chunk));
            let summary = held(lock, || engine.render_to(&part, output))?;
            claimed.chunks.push(summary);
            if claimed.is_stopped() {
                return Ok(claimed);
            }
        }
        // Meanwhile others have ended, well or not: what they claimed is looked at once more.
        if left.len() == before || left.is_empty() {
            claimed.left = left.into_iter().map(list).collect();
            return Ok(claimed);
        }
        open = left;
    }
}

/// The file that a claim stands for; its lock is beside it.
fn claim(folder: &Path, project: &Project, chunk: &[i32]) -> PathBuf {
    let name = project.output.name.replace(|c: char| !(c.is_alphanumeric() || c == '-'), "_");
    let [first, last] = [chunk.first(), chunk.last()].map(|frame| frame.copied().unwrap_or_default());
    folder.join(format!("{name}.{first}-{last}.claim"))
}

/// Works while the lock is held, and shown to be.
fn held<R>(mut lock: FileLock, work: impl FnOnce() -> R) -> R {
    let (ends, ended) = channel::<()>();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            while ended.recv_timeout(LOOKS) == Err(RecvTimeoutError::Timeout) {
                lock.beat();
            }
        });
        // Gone with the work, even where that panics.
        let _ends = ends;
        work()
    })
}
