//! The examples as the program carries them, for a program without its folder.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use lightloom_core::{Error, Result, files};

/// A file of the examples.
struct Embedded {
    /// Its path below the folder of the examples.
    path: &'static str,
    bytes: &'static [u8],
}

macro_rules! embedded {
    ($($path:literal),* $(,)?) => {
        &[$(Embedded { path: $path, bytes: include_bytes!(concat!("../../../", $path)) }),*]
    };
}

const FILES: &[Embedded] = embedded![
    "projects/bottles.json",
    "projects/dark_glass.json",
    "projects/letters.json",
    "projects/letters_free.json",
    "projects/loop.json",
    "projects/rabbit.json",
    "assets/meshes/bottle_round.mtl",
    "assets/meshes/bottle_round.obj",
    "assets/meshes/bottle_square.mtl",
    "assets/meshes/bottle_square.obj",
    "assets/meshes/bottle_tall.mtl",
    "assets/meshes/bottle_tall.obj",
    "assets/meshes/goblet.mtl",
    "assets/meshes/goblet.obj",
    "assets/meshes/rabbit.mtl",
    "assets/meshes/rabbit.obj",
    "assets/meshes/water_round.mtl",
    "assets/meshes/water_round.obj",
    "assets/meshes/water_square.mtl",
    "assets/meshes/water_square.obj",
    "assets/meshes/water_tall.mtl",
    "assets/meshes/water_tall.obj",
    "assets/targets/flower.png",
    "assets/targets/letter_c.png",
    "assets/targets/letter_s.png",
    "assets/targets/spiral.png",
    "assets/targets/star.png",
];

/// Writes the examples below `folder`, where they are not there yet, and returns the folder of their projects.
///
/// # Errors
/// `Io` with the file that cannot be written.
pub(super) fn unpack(folder: &Path) -> Result<PathBuf> {
    for Embedded { path, bytes } in FILES {
        let path = folder.join(path);
        if fs::metadata(&path).is_ok_and(|file| file.len() == bytes.len() as u64) {
            continue;
        }
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(Error::io("create", folder))?;
        }
        files::write_atomic(&path, |file| file.write_all(bytes))?;
    }
    Ok(folder.join("projects"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use lightloom_core::engine::Engine;
    use lightloom_core::project::{AssetFolder, Project};

    use super::*;
    use crate::editor::templates::TEMPLATES;

    #[test]
    fn unpacked_examples_have_all_files_that_they_name() {
        let folder = tempfile::tempdir().unwrap();
        let projects = unpack(folder.path()).unwrap();
        for template in TEMPLATES {
            let path = projects.join(template.file);
            let project = Project::load(&path).unwrap();
            Engine::new(AssetFolder::new(&path, false).unwrap()).check(&project).unwrap();
        }
        // A second start writes nothing.
        let seen = |path: &Path| fs::metadata(path).unwrap().modified().unwrap();
        let file = projects.join(TEMPLATES[0].file);
        let before = seen(&file);
        unpack(folder.path()).unwrap();
        assert_eq!(before, seen(&file));
    }
}
