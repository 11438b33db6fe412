//! User preferences, kept between runs.

use std::path::{Path, PathBuf};

use lightloom_core::{Error, Result, files};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::disk;

/// Maximum number of recent files.
pub const MOST_RECENT: usize = 20;
/// Range of the interface scale.
pub const UI_SCALES: std::ops::RangeInclusive<f32> = 0.5..=3.0;
/// Range of the memory of a preview, MB.
pub const PREVIEW_MEGABYTES: std::ops::RangeInclusive<u32> = 8..=8000;
/// Maximum size of the preferences file.
const MOST_BYTES: u64 = 1 << 20;

/// The user's preferences.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Recent files, newest first, at most [`MOST_RECENT`]; missing ones stay: a disk may come back.
    pub recent: Vec<PathBuf>,
    /// Colours of the window.
    pub theme: Theme,
    /// Interface scale, within [`UI_SCALES`].
    pub ui_scale: f32,
    /// Whether the tour of the first start was seen.
    pub first_start_seen: bool,
    /// What draws the photons of the preview.
    pub photon_renderer: PhotonRenderer,
    /// Whether drawing snaps.
    pub snapping: bool,
    /// What the photons of all frames of a preview may take, MB, within [`PREVIEW_MEGABYTES`].
    pub preview_megabytes: u32,
    /// Fields of later versions.
    #[serde(flatten)]
    other: Map<String, Value>,
}

/// Colours of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Theme {
    /// Light on dark, best for judging caustics.
    #[default]
    Dark,
    /// Dark on light.
    Light,
    /// The system's theme.
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
            preview_megabytes: 160,
            other: Map::new(),
        }
    }
}

impl Preferences {
    /// The preferences as JSON, without the names of recent files.
    pub fn without_files(&self) -> String {
        let told = Self { recent: Vec::new(), ..self.clone() };
        // Plain values: serialisation has nothing to fail on.
        serde_json::to_string_pretty(&told).unwrap_or_default()
    }

    /// The preferences in the folder `config`, or the defaults; with a note if the file exists but cannot be used.
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
                let [least, most] = [*PREVIEW_MEGABYTES.start(), *PREVIEW_MEGABYTES.end()];
                preferences.preview_megabytes = preferences.preview_megabytes.clamp(least, most);
                (preferences, None)
            }
            Err(Error::Io { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => {
                (Self::default(), None)
            }
            Err(error) => (Self::default(), Some(format!("{error}; all preferences are the defaults"))),
        }
    }

    /// Writes them to the folder `config`, atomically.
    ///
    /// # Errors
    /// The file and the system's reason; the old file is unchanged.
    pub fn save(&self, config: &Path) -> Result<()> {
        let path = file_in(config);
        let text = serde_json::to_string_pretty(self)
            .map_err(|e| Error::value("preferences", format!("cannot be written as JSON: {e}")))?;
        disk::write(&path, (text + "\n").as_bytes())
    }

    /// Adds a file to the front of the recent files. A path that is not UTF-8 is skipped: JSON cannot hold it.
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
