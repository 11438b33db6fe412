//! Numbered pictures in a folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use lightloom_core::export::film;

/// Kinds of pictures that can be played.
const ENDINGS: [&str; 3] = ["png", "jpg", "jpeg"];
/// Frames per second of pictures that came without `summary.json`.
const RATE: [u32; 2] = [24, 1];

/// A sequence of pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Sequence {
    /// Numbers and files, in rising order.
    pub frames: Vec<(i32, PathBuf)>,
    /// Frames per second as a fraction.
    pub frames_per_second: [u32; 2],
}

/// What the names of a sequence have in common: before and after the number.
type Name = (String, String);

impl Sequence {
    /// The largest sequence in a folder, or the one that a picture belongs to. Its rate is that of the render which left its
    /// `summary.json` beside it.
    ///
    /// # Errors
    /// There is none, and what to do.
    pub fn find(path: &Path) -> Result<Self, String> {
        let folder = if path.is_dir() { path } else { path.parent().unwrap_or(Path::new(".")) };
        let entries = std::fs::read_dir(folder)
            .map_err(|error| format!("'{}' cannot be read: {error}", folder.display()))?;
        let mut found: BTreeMap<Name, Vec<(i32, PathBuf)>> = BTreeMap::new();
        for file in entries.filter_map(|entry| Some(entry.ok()?.path())) {
            if let Some((name, number)) = parted(&file) {
                found.entry(name).or_default().push((number, file));
            }
        }
        let wanted = parted(path).filter(|_| !path.is_dir());
        let frames = match wanted {
            Some((name, _)) => found.remove(&name),
            None => found.into_values().max_by_key(Vec::len),
        };
        let Some(mut frames) = frames else {
            return Err(format!(
                "'{}' has no numbered PNG or JPEG pictures; export frames with PNG among the formats",
                path.display()
            ));
        };
        frames.sort();
        Ok(Self { frames, frames_per_second: rate(folder).unwrap_or(RATE) })
    }

    /// For how many frames each picture is shown: until the number of the next.
    pub fn holds(&self) -> Vec<u32> {
        film::holds(&self.frames.iter().map(|(number, _)| *number).collect::<Vec<_>>())
    }
}

/// The parts of a picture's name before and after its number, and the number: the last of the name, with a minus after a dot.
fn parted(file: &Path) -> Option<(Name, i32)> {
    let ending = file.extension()?.to_str()?;
    if !ENDINGS.contains(&ending.to_lowercase().as_str()) {
        return None;
    }
    let stem = file.file_stem()?.to_str()?;
    let after = stem.trim_end_matches(|c: char| !c.is_ascii_digit());
    let before = after.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = &after[before.len()..];
    let minus = before.ends_with(".-");
    let number = digits.parse::<i32>().ok()?;
    let before = if minus { &before[..before.len() - 1] } else { before };
    let name = (before.to_owned(), format!("{}.{ending}", &stem[after.len()..]));
    Some((name, if minus { -number } else { number }))
}

/// The rate in a render's summary.
fn rate(folder: &Path) -> Option<[u32; 2]> {
    let text = std::fs::read_to_string(folder.join("summary.json")).ok()?;
    let summary: serde_json::Value = serde_json::from_str(&text).ok()?;
    let rate: [u32; 2] = serde_json::from_value(summary.get("frames_per_second")?.clone()).ok()?;
    (rate[0] > 0 && rate[1] > 0).then_some(rate)
}
