//! A window without a screen, on a project of its own.
#![allow(clippy::unwrap_used, dead_code, unreachable_pub)]

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui_kittest::Harness;
use lightloom::editor::dialogs::{PickResult, Scripted};
use lightloom::editor::document::Document;
use lightloom::editor::store::{Fingerprint, Folders, Preferences};
use lightloom::editor::{App, Gpu, Setup};
use lightloom_core::project::ProjectFile;
use tempfile::TempDir;

/// Size of the window, points: as the program opens it.
pub const SIZE: [f32; 2] = [1440.0, 900.0];

/// A folder with copies of the examples, their targets and meshes.
pub fn examples() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for part in ["projects", "assets/targets", "assets/meshes"] {
        let to = folder.path().join(part);
        fs::create_dir_all(&to).unwrap();
        for entry in fs::read_dir(root.join(part)).unwrap() {
            let entry = entry.unwrap();
            fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
        }
    }
    folder
}

/// Where a test keeps what a user would have in the home folder.
pub fn folders(in_folder: &Path) -> Folders {
    Folders { state: in_folder.join("state"), config: in_folder.join("config") }
}

/// The document of a project file.
pub fn document(path: &Path) -> Document {
    let bytes = fs::read(path).unwrap();
    let (file, _) = ProjectFile::parse(&bytes, path).unwrap();
    Document::opened(Arc::new(file), Some((path.to_owned(), Fingerprint::of(&bytes))))
}

/// A window on the project `name` of a folder of examples. Dialogs give `answers`.
pub fn window(folder: &TempDir, name: &str, answers: Vec<PickResult>) -> Harness<'static, App> {
    let path = project(folder, name);
    let setup = Setup {
        document: document(&path),
        message: None,
        folders: Some(folders(folder.path())),
        preferences: preferences(),
        dialogs: Arc::new(Scripted::new(answers)),
        gpu: Gpu::None,
    };
    let mut setup = Some(setup);
    Harness::builder()
        .with_size(SIZE)
        .with_pixels_per_point(1.0)
        .with_max_steps(8)
        .build_eframe(|cc| App::new(&cc.egui_ctx, setup.take().unwrap()))
}

/// Those of a user who has seen the first steps.
pub fn preferences() -> Preferences {
    let mut preferences = Preferences::default();
    preferences.first_start_seen = true;
    preferences
}

/// The file of the project `name` in a folder of examples.
pub fn project(folder: &TempDir, name: &str) -> PathBuf {
    folder.path().join("projects").join(format!("{name}.json"))
}

/// Lets the window run until something holds; the workers need their time.
pub fn until(harness: &mut Harness<App>, what: &str, holds: impl Fn(&App) -> bool) {
    let begun = Instant::now();
    while !holds(harness.state()) {
        // Minutes, for a busy machine: what never comes fails all the same.
        assert!(begun.elapsed() < Duration::from_secs(240), "waited in vain: {what}");
        harness.step();
        std::thread::sleep(Duration::from_millis(2));
    }
}
