//! The example projects that serve as templates.

mod embedded;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use lightloom_core::Result;
use lightloom_core::project::Project;

use super::document::Document;
use super::store::Folders;

/// A template.
#[derive(Clone, Copy, Debug)]
pub struct Template {
    /// Its name.
    pub name: &'static str,
    /// Its description.
    pub line: &'static str,
    /// Its file in the folder of templates.
    pub file: &'static str,
    /// Its thumbnail, PNG, 240 x 150 pixels.
    pub picture: &'static [u8],
}

macro_rules! picture {
    ($name:literal) => {
        include_bytes!(concat!("../../../assets/templates/", $name, ".png"))
    };
}

/// All templates; a first start shows the first one.
pub const TEMPLATES: [Template; 6] = [
    Template {
        name: "Dark glass",
        line: "The caustic of a glass of wine turns into a flower.",
        file: "dark_glass.json",
        picture: picture!("dark_glass"),
    },
    Template {
        name: "Letters, free",
        line: "One letter becomes another on a bare plane: the fastest example.",
        file: "letters_free.json",
        picture: picture!("letters_free"),
    },
    Template {
        name: "Letters",
        line: "The same with drawn lines and walls.",
        file: "letters.json",
        picture: picture!("letters"),
    },
    Template {
        name: "Bottles",
        line: "Three bottles; walls and lines lead their light around each other.",
        file: "bottles.json",
        picture: picture!("bottles"),
    },
    Template {
        name: "Rabbit",
        line: "The light of a glass rabbit becomes a star through turbulence.",
        file: "rabbit.json",
        picture: picture!("rabbit"),
    },
    Template {
        name: "Loop",
        line: "Ends with the light it starts with, and loops.",
        file: "loop.json",
        picture: picture!("loop"),
    },
];

/// Why there is no [`folder`].
pub const MISSING: &str = "the examples are not beside the program, and cannot be written into your folder";

/// The folder of the templates: beside the program, in the current folder, or unpacked from the program into the user's own.
/// Their meshes and pictures are in the sibling folder `assets`. None where there is none and none can be written.
pub fn folder() -> Option<&'static Path> {
    static FOLDER: OnceLock<Option<PathBuf>> = OnceLock::new();
    let find = || {
        let program = std::env::current_exe().ok();
        let beside = program.as_deref().and_then(Path::parent);
        let installed = beside.map(|bin| bin.join("../share/lightloom/projects"));
        [beside.map(|bin| bin.join("projects")), installed, Some(PathBuf::from("projects"))]
            .into_iter()
            .flatten()
            .find(|folder| folder.join(TEMPLATES[0].file).is_file())
            .or_else(|| embedded::unpack(&Folders::of_user()?.examples()).ok())
            .and_then(|folder| folder.canonicalize().ok())
    };
    FOLDER.get_or_init(find).as_deref()
}

/// Loads a template. Reads a file: not for the window's thread.
///
/// # Errors
/// The templates are not installed, or the file is invalid.
pub fn load(template: &Template) -> Result<Project> {
    let Some(folder) = folder() else {
        return Err(lightloom_core::Error::value(template.name, MISSING));
    };
    Project::load(&folder.join(template.file))
}

/// The file that a document's paths are relative to: its own, or an untitled one among the templates.
pub fn file_of(document: &Document) -> PathBuf {
    let new = || folder().unwrap_or(Path::new(".")).join("untitled.json");
    document.path().map_or_else(new, Path::to_owned)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn every_example_can_be_read_and_has_a_picture_that_can_be_shown() {
        for template in TEMPLATES {
            load(&template).unwrap();
            let picture = image::load_from_memory(template.picture).unwrap();
            assert_eq!((picture.width(), picture.height()), (240, 150), "{}", template.name);
        }
    }
}
