//! What the editor remembers of its user from one start to the next.

use std::path::{Path, PathBuf};

use lightloom_core::{Error, Result, files};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::disk;

/// Most recent files.
pub const MOST_RECENT: usize = 20;
/// Size of the window's texts and controls, as a factor.
pub const UI_SCALES: std::ops::RangeInclusive<f32> = 0.5..=3.0;
/// Larger files are no preferences.
const MOST_BYTES: u64 = 1 << 20;

/// What the editor remembers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Files that were open, the newest first, at most [`MOST_RECENT`]; also such as are missing now: a disk may come back.
    pub recent: Vec<PathBuf>,
    /// Colours of the window.
    pub theme: Theme,
    /// Size of texts and controls, a factor in [`UI_SCALES`].
    pub ui_scale: f32,
    /// Whether the three steps of the first start were seen.
    pub first_start_seen: bool,
    /// What draws the photons of the preview.
    pub photon_renderer: PhotonRenderer,
    /// Whether points snap to others as they are drawn.
    pub snapping: bool,
    /// What a later version remembers.
    #[serde(flatten)]
    other: Map<String, Value>,
}

/// Colours of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Theme {
    /// Light on dark: the caustic is judged best so.
    #[default]
    Dark,
    /// Dark on light.
    Light,
    /// As the system has it.
    System,
}

/// What draws the photons of the preview.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PhotonRenderer {
    /// The graphics card where there is one.
    #[default]
    Auto,
    /// The graphics card.
    Gpu,
    /// The processor.
    Cpu,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            recent: Vec::new(),
            theme: Theme::default(),
            ui_scale: 1.0,
            first_start_seen: false,
            photon_renderer: PhotonRenderer::default(),
            snapping: true,
            other: Map::new(),
        }
    }
}

impl Preferences {
    /// The preferences in the folder `config`, or the defaults; a note says why where a file is there and cannot be used.
    pub fn load(config: &Path) -> (Self, Option<String>) {
        let path = file_in(config);
        let read = files::read_regular_file(&path, MOST_BYTES).and_then(|bytes| {
            serde_json::from_slice(&bytes).map_err(|e| Error::format(&path, "", e.to_string()))
        });
        match read {
            Ok(Self { ui_scale, .. }) if !UI_SCALES.contains(&ui_scale) => {
                let note = format!("'{}', ui_scale: {ui_scale} is not within 0.5 to 3", path.display());
                (Self::default(), Some(format!("{note}; all preferences are the defaults")))
            }
            Ok(mut preferences) => {
                preferences.recent.truncate(MOST_RECENT);
                (preferences, None)
            }
            Err(Error::Io { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => {
                (Self::default(), None)
            }
            Err(error) => (Self::default(), Some(format!("{error}; all preferences are the defaults"))),
        }
    }

    /// Writes them into the folder `config`, in one step.
    ///
    /// # Errors
    /// Names the file and the system's reason; the old file is left as it was.
    pub fn save(&self, config: &Path) -> Result<()> {
        let path = file_in(config);
        let text = serde_json::to_string_pretty(self)
            .map_err(|e| Error::value("preferences", format!("cannot be written as JSON: {e}")))?;
        disk::write(&path, (text + "\n").as_bytes())
    }

    /// Puts a file at the head of the recent ones. A path that is not UTF-8 is not remembered: JSON cannot hold it.
    pub fn add_recent(&mut self, path: &Path) {
        let Ok(path) = std::path::absolute(path) else { return };
        if path.to_str().is_none() {
            return;
        }
        self.recent.retain(|other| *other != path);
        self.recent.insert(0, path);
        self.recent.truncate(MOST_RECENT);
    }
}

fn file_in(config: &Path) -> PathBuf {
    config.join("preferences.json")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn what_is_remembered_comes_back_also_what_a_later_version_remembers() {
        let folder = tempfile::tempdir().unwrap();
        let config = folder.path().join("not/yet/there");
        assert_eq!(Preferences::load(&config), (Preferences::default(), None));
        let mut preferences = Preferences { theme: Theme::Light, snapping: false, ..Preferences::default() };
        preferences.other.insert("later".into(), 1.into());
        (0..30).for_each(|i| preferences.add_recent(Path::new(&format!("{}.json", i % 25))));
        preferences.save(&config).unwrap();
        let (read, note) = Preferences::load(&config);
        assert_eq!((&read, note), (&preferences, None));
        assert_eq!(read.recent.len(), MOST_RECENT);
        assert!(read.recent[0].is_absolute() && read.recent[0].ends_with("4.json"));
    }

    #[test]
    fn broken_preferences_are_the_defaults_and_said_to_be_broken() {
        let folder = tempfile::tempdir().unwrap();
        for text in ["", "{", "[]", r#"{"theme": "pink"}"#, r#"{"ui_scale": 0}"#, r#"{"ui_scale": 1e99}"#] {
            std::fs::write(file_in(folder.path()), text).unwrap();
            let (read, note) = Preferences::load(folder.path());
            assert_eq!(read, Preferences::default(), "{text}");
            assert!(note.is_some_and(|note| note.contains("preferences.json")), "{text}");
        }
    }
}
