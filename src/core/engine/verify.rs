//! What lies in an output folder, looked at without the project.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::Serialize;

use super::bake::Bake;
use super::frame_sequence::sequences;
use crate::export::inspect;
use crate::{Error, Result};

/// The state of the frames in a folder.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Verification {
    /// Number of frames by sequence, such as `shot.#.exr`.
    pub frames: BTreeMap<String, usize>,
    /// Numbers of missing frames by sequence.
    pub missing: BTreeMap<String, Vec<i32>>,
    /// Frames that are cut off, damaged or of other programs, each with the reason.
    pub damaged: Vec<String>,
    /// Frames of fewer passes than planned.
    pub unfinished: Vec<PathBuf>,
    /// Number of frames by the fingerprint of what they are made from.
    pub fingerprints: BTreeMap<String, usize>,
    /// The fingerprint that all should have, where it is known.
    pub expected: Option<String>,
}

/// Looks whether the frames in `folder` are whole, finished, made from the same, and without gaps; all of `frames` must be
/// there, where they are given, and their fingerprint be that of the folder `bake`.
///
/// # Errors
/// A folder that cannot be read; no frames in it.
pub fn verify(folder: &Path, frames: Option<&[i32]>, bake: Option<&Path>) -> Result<Verification> {
    let mut found =
        Verification { expected: bake.map(Bake::fingerprint_of).transpose()?, ..Verification::default() };
    let sequences = sequences(folder)?;
    if sequences.is_empty() {
        let what = format!("there are no frames in '{}', such as shot.0001.exr", folder.display());
        return Err(Error::value("DIR", what));
    }
    for (name, files) in sequences {
        found.frames.insert(name.clone(), files.len());
        let wanted: BTreeSet<i32> = match (frames, files.keys().next(), files.keys().next_back()) {
            (Some(frames), ..) => frames.iter().copied().collect(),
            (None, Some(first), Some(last)) => (*first..=*last).collect(),
            _ => BTreeSet::new(),
        };
        let missing: Vec<i32> = wanted.into_iter().filter(|frame| !files.contains_key(frame)).collect();
        if !missing.is_empty() {
            found.missing.insert(name, missing);
        }
        let looked: Vec<_> = files.par_iter().map(|(_, path)| (path, inspect(path))).collect();
        for (path, file) in looked {
            match file {
                Err(error) => found.damaged.push(error.to_string()),
                Ok(file) => {
                    let print = file.fingerprint().unwrap_or("none").to_owned();
                    *found.fingerprints.entry(print).or_default() += 1;
                    if file.passes().is_some() && !file.is_finished() {
                        found.unfinished.push(path.clone());
                    }
                }
            }
        }
    }
    Ok(found)
}

impl Verification {
    /// Whether nothing is wrong.
    pub fn is_good(&self) -> bool {
        let expected = |print: &String| self.expected.as_ref().is_none_or(|expected| expected == print);
        self.missing.is_empty()
            && self.damaged.is_empty()
            && self.unfinished.is_empty()
            && self.fingerprints.len() == 1
            && self.fingerprints.keys().all(expected)
    }

    /// As indented JSON.
    pub fn to_json(&self) -> String {
        // Plain strings and numbers: serialisation has nothing to fail on.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// As lines for people.
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        for (name, count) in &self.frames {
            let _ = writeln!(text, "{name}: {count} frames");
        }
        for (name, frames) in &self.missing {
            let _ = writeln!(text, "  missing of {name}: {}", spans(frames));
        }
        for error in &self.damaged {
            let _ = writeln!(text, "  damaged: {error}");
        }
        for path in &self.unfinished {
            let _ = writeln!(text, "  unfinished: {}", path.display());
        }
        for (print, count) in &self.fingerprints {
            let _ = writeln!(text, "  made from {print}: {count} files");
        }
        if let Some(expected) = &self.expected {
            let _ = writeln!(text, "  expected {expected}");
        }
        let verdict = if self.is_good() {
            "whole, finished and made from the same"
        } else if self.fingerprints.len() > 1 {
            "NOT good: made from different things"
        } else {
            "NOT good"
        };
        text + verdict
    }
}

/// Rising numbers as a frame list: 1-4,7.
fn spans(frames: &[i32]) -> String {
    let mut spans: Vec<[i32; 2]> = Vec::new();
    for &frame in frames {
        match spans.last_mut() {
            Some([_, last]) if i64::from(*last) + 1 == i64::from(frame) => *last = frame,
            _ => spans.push([frame; 2]),
        }
    }
    let span = |[first, last]: &[i32; 2]| {
        if first == last { first.to_string() } else { format!("{first}-{last}") }
    };
    spans.iter().map(span).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_frames_are_told_as_a_list() {
        assert_eq!(spans(&[-2, -1, 0, 5, 7, 8]), "-2-0,5,7-8");
    }
}
