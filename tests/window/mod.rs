//! The editor under test: [`Editor`] is the editor without its window, [`window`] the whole window without a screen.
#![allow(clippy::unwrap_used, dead_code, unreachable_pub)]

use std::fs;
use std::ops::{Deref, DerefMut};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui_kittest::Harness;
use lightloom::editor::action::Action;
use lightloom::editor::context::EditorContext;
use lightloom::editor::dialogs::{PickResult, Scripted};
use lightloom::editor::document::Document;
use lightloom::editor::engine::SharedEngine;
use lightloom::editor::state::EditorState;
use lightloom::editor::store::{Fingerprint, Folders, Preferences};
use lightloom::editor::{App, Gpu, Setup, theme};
use lightloom_core::project::{Project, ProjectFile};
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
    window_with(folder, name, answers, preferences())
}

/// The same with other preferences.
pub fn window_with(
    folder: &TempDir,
    name: &str,
    answers: Vec<PickResult>,
    preferences: Preferences,
) -> Harness<'static, App> {
    let path = project(folder, name);
    let setup = Setup {
        document: document(&path),
        message: None,
        folders: Some(folders(folder.path())),
        preferences,
        keeps_preferences: true,
        dialogs: Arc::new(Scripted::new(answers)),
        gpu: Gpu::None,
        graphics: "none".to_owned(),
        device: Arc::default(),
    };
    let mut setup = Some(setup);
    Harness::builder()
        .with_size(SIZE)
        .with_pixels_per_point(1.0)
        .with_max_steps(8)
        .build_eframe(|cc| App::new(&cc.egui_ctx, setup.take().unwrap()))
}

/// The preferences of a user who has seen the tour.
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

/// The editor without its window: shows one part of it, and applies the actions that the part asks for.
pub struct Editor {
    state: EditorState,
    /// All actions that were asked for, in order.
    pub asked: Vec<Action>,
    /// Whether actions are applied; they are always noted.
    pub applies: bool,
    themed: bool,
}

impl Editor {
    /// The editor with an open document.
    pub fn new(document: Document) -> Self {
        Self {
            state: EditorState::new(document, SharedEngine::default(), || ()),
            asked: Vec::new(),
            applies: true,
            themed: false,
        }
    }

    /// The editor with a project that has no file.
    pub fn with_project(project: Project) -> Self {
        project.check().unwrap();
        Self::new(Document::new(project, None))
    }

    /// The editor with the project of this text.
    pub fn with_text(text: &str) -> Self {
        Self::with_project(Project::parse(text.as_bytes(), Path::new("test.json")).unwrap())
    }

    /// One frame: shows a part, then applies the actions it asks for.
    pub fn frame<R>(&mut self, ctx: &egui::Context, show: impl FnOnce(&mut EditorContext) -> R) -> R {
        if !std::mem::replace(&mut self.themed, true) {
            theme::apply(ctx);
        }
        let mut actions = Vec::new();
        let shown = show(&mut self.state.context(&mut actions));
        for action in actions {
            self.apply(action);
        }
        shown
    }

    /// Applies an action as the window does; a refused edit fails the test. Returns an action that needs the window.
    pub fn apply(&mut self, action: Action) -> Option<Action> {
        self.asked.push(action.clone());
        if let Action::Edit(edit) = &action {
            self.state.document.clone().edit(edit.clone()).unwrap();
        }
        if self.applies { self.state.apply(action) } else { None }
    }

    /// Frames of the keys.
    pub fn key_frames(&self) -> Vec<i32> {
        self.document.project().keys.iter().map(|key| key.frame).collect()
    }
}

impl Deref for Editor {
    type Target = EditorState;

    fn deref(&self) -> &EditorState {
        &self.state
    }
}

impl DerefMut for Editor {
    fn deref_mut(&mut self) -> &mut EditorState {
        &mut self.state
    }
}
