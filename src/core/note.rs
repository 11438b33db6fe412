//! Notes for the artist: what was cleaned up or guessed, and what looks wrong, each with the part of the project that it is
//! about.

use std::fmt;

use serde::Serialize;

/// The part of a project that a note is about.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum About {
    /// The whole of it, or the files of a run.
    Project,
    /// A mesh, by its index in the scene.
    Mesh(usize),
    /// A lamp, by its index in the scene.
    Light(usize),
    /// The camera.
    Camera,
    /// A key frame, by its index.
    Key(usize),
    /// A caustic, by its name.
    Caustic(String),
    /// A wall or directed line, by its index.
    Constraint(usize),
    /// A setting, or a list of them, by its place ([`crate::setting::Setting::place`]).
    Setting(&'static str),
}

/// A note.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(into = "Told")]
pub struct Note {
    /// The part of the project that it is about.
    pub about: About,
    /// What it says, and what to do.
    pub text: String,
}

/// A note as programs read it.
#[derive(Serialize)]
struct Told {
    kind: &'static str,
    object: String,
    text: String,
}

impl About {
    /// The kind of the part: "mesh", "light", "setting".
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Project => "project",
            Self::Mesh(_) => "mesh",
            Self::Light(_) => "light",
            Self::Camera => "camera",
            Self::Key(_) => "key",
            Self::Caustic(_) => "caustic",
            Self::Constraint(_) => "constraint",
            Self::Setting(_) => "setting",
        }
    }

    /// Its place in the project, such as `scene.meshes[0]`; empty for the whole of it. A caustic is named by its name.
    pub fn place(&self) -> String {
        match self {
            Self::Project => String::new(),
            Self::Mesh(index) => format!("scene.meshes[{index}]"),
            Self::Light(index) => format!("scene.lights[{index}]"),
            Self::Camera => "scene.camera".to_owned(),
            Self::Key(index) => format!("keys[{index}]"),
            Self::Caustic(name) => format!("caustics.{name}"),
            Self::Constraint(index) => format!("constraints[{index}]"),
            Self::Setting(place) => (*place).to_owned(),
        }
    }

    /// A note about it.
    pub fn note(self, text: impl Into<String>) -> Note {
        Note { about: self, text: text.into() }
    }

    /// Several notes about it.
    pub fn notes(self, texts: impl IntoIterator<Item = String>) -> impl Iterator<Item = Note> {
        texts.into_iter().map(move |text| self.clone().note(text))
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl From<Note> for Told {
    fn from(note: Note) -> Self {
        Self { kind: note.about.kind(), object: note.about.place(), text: note.text }
    }
}
