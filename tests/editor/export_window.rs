//! Exports from the window: the same bytes as the command line, and they can be paused, stopped and broken off.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::Duration;

use crate::window::Editor;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lightloom::editor::access::Access;
use lightloom::editor::dialogs::{Picker, Scripted};
use lightloom::editor::document::Document;
use lightloom::editor::engine::SharedEngine;
use lightloom::editor::export::{ExportJob, ExportSettings, ExportWindow, Exports, Status};
use lightloom_core::engine::Existing;
use lightloom_core::project::Project;

/// A folder with the project `letters_free` made tiny, its pictures, and room for frames.
struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn new(passes: u32, photons: u64) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let place = Self { folder };
        for part in ["projects", "assets/targets"] {
            std::fs::create_dir_all(place.path(part)).unwrap();
        }
        for picture in ["letter_c.png", "letter_s.png"] {
            let name = format!("assets/targets/{picture}");
            std::fs::copy(root.join(&name), place.path(&name)).unwrap();
        }
        let mut project = Project::load(&root.join("projects/letters_free.json")).unwrap();
        project.render.passes = passes;
        project.render.photons = photons;
        (project.render.width, project.render.height) = (32, 32);
        project.flow.steps = 4;
        project.flow.grid = lightloom_core::flow::GridSize::Longer(16);
        project.output.frames = Some("1,30".into());
        project.save(&place.file()).unwrap();
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn file(&self) -> PathBuf {
        self.path("projects/it's tiny.json")
    }

    fn settings(&self) -> ExportSettings {
        ExportSettings {
            project: Arc::new(Project::load(&self.file()).unwrap()),
            file: self.file(),
            access: Access::default(),
            folder: self.path("frames"),
            film: None,
            limit: None,
            shown: 30,
            existing: Existing::Refuse,
        }
    }
}

/// Waits until something holds; a machine that never gets there fails.
fn wait_until(what: &str, mut holds: impl FnMut() -> bool) {
    for _ in 0..6000 {
        if holds() {
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("never: {what}");
}

/// The files of a folder by name, with their content.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        // Unfinished light is in a folder.
        .filter(|path| path.is_file())
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(path).unwrap()))
        .collect();
    files.sort();
    files
}

fn exports() -> Exports {
    Exports::new(SharedEngine::default(), || ())
}

/// Begins an export that would take for ever, and waits for its first pass.
fn endless(place: &Place, exports: &mut Exports) -> Arc<ExportJob> {
    let job = exports.add(place.settings());
    wait_until("a first pass", || job.passes() > 0);
    job
}

struct State {
    editor: Editor,
    window: ExportWindow,
    exports: Exports,
    picker: Picker,
}

/// The export window over a project in a file.
fn opened(project: Project, file: PathBuf) -> Harness<'static, State> {
    let mut window = ExportWindow::default();
    window.open = true;
    let state = State {
        editor: Editor::new(Document::new(project, Some(file))),
        window,
        exports: exports(),
        picker: Picker::new(Arc::new(Scripted::default())),
    };
    let builder = Harness::builder().with_size([1000.0, 700.0]).with_max_steps(16);
    let mut harness = builder.build_ui_state(
        |ui, state: &mut State| {
            let ctx = ui.ctx().clone();
            let State { editor, window, exports, picker } = state;
            editor.frame(&ctx, |editor| window.show(&ctx, editor, exports, picker));
        },
        state,
    );
    harness.run_ok();
    harness
}

#[test]
fn a_long_folder_shows_its_end_and_the_whole_to_who_edits_it() {
    let place = Place::new(1, 1000);
    let folders = "a folder with a long name/one more of a length that no field has room for";
    let mut harness = opened(Project::load(&place.file()).unwrap(), place.path(folders).join("shot.json"));
    let folder =
        |harness: &Harness<State>| harness.get_by_role_and_label(Role::TextInput, "Folder").value().unwrap();
    let shown = folder(&harness);
    assert!(shown.starts_with('…') && shown.chars().count() < 40, "{shown}");
    harness.get_by_role_and_label(Role::TextInput, "Folder").focus();
    harness.run_ok();
    let whole = folder(&harness);
    assert!(whole.contains(folders) && whole.ends_with(shown.trim_start_matches('…')), "{whole}");
    harness.get_by_role_and_label(Role::TextInput, "Folder").type_text("/day two");
    harness.run_ok();
    let line = harness.get_by_label("Command line").value().unwrap();
    assert!(line.contains(&format!("{whole}/day two")), "{line}");
}

#[cfg(unix)]
#[test]
fn the_window_exports_the_same_bytes_as_the_command_line_that_it_shows() {
    let place = Place::new(2, 2000);
    let mut harness = opened(Project::load(&place.file()).unwrap(), place.file());
    let line = harness.get_by_label("Command line").value().unwrap();
    harness.get_by_role_and_label(Role::Button, "Export 2 frames").click();
    harness.run_ok();
    let job = harness.state().exports.jobs()[0].clone();
    wait_until("done", || !job.is_open());
    assert!(matches!(job.status(), Status::Done(_)), "{:?}", job.status());
    harness.run_ok();
    assert!(harness.query_by_label_contains("2 frames exported").is_some());
    let folder = job.settings().folder.clone();
    let window = files(&folder);
    std::fs::remove_dir_all(&folder).unwrap();

    let program = Path::new(env!("CARGO_BIN_EXE_lightloom"));
    let path = format!("{}:{}", program.parent().unwrap().display(), std::env::var("PATH").unwrap());
    let ran = Command::new("sh").args(["-c", &line]).env("PATH", path).output().unwrap();
    assert!(ran.status.success(), "{line}: {}", String::from_utf8_lossy(&ran.stderr));
    let shell = files(&folder);
    let names = |files: &[(String, Vec<u8>)]| files.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&window), names(&shell));
    assert_eq!(window.len(), 6, "{:?}", names(&window));
    for ((name, a), (_, b)) in window.iter().zip(&shell) {
        // The summary tells the seconds that it took.
        assert!(a == b || name == "summary.json", "{name} differs");
    }
}

#[test]
fn breaking_off_leaves_no_file_at_all() {
    let (place, mut exports) = (Place::new(100_000, 20_000), exports());
    let job = endless(&place, &mut exports);
    job.cancel();
    wait_until("cancelled", || !job.is_open());
    assert_eq!(job.status(), Status::Cancelled);
    assert_eq!(place.path("frames").read_dir().unwrap().count(), 0);
}

#[test]
fn a_paused_export_does_no_pass_until_it_goes_on() {
    let (place, mut exports) = (Place::new(100_000, 1000), exports());
    let job = endless(&place, &mut exports);
    job.pause();
    // The pass under way may still come to its end; then nothing may happen in a time in which many would.
    std::thread::sleep(Duration::from_millis(300));
    let at = job.passes();
    std::thread::sleep(Duration::from_millis(500));
    assert_eq!(job.passes(), at);
    assert!(job.is_paused() && job.is_open());
    job.resume();
    wait_until("more passes", || job.passes() > at + 1);
    // Also what rests can be broken off.
    job.pause();
    job.cancel();
    wait_until("cancelled", || !job.is_open());
}

#[test]
fn stopping_writes_all_frames_with_the_passes_that_are_complete() {
    let (place, mut exports) = (Place::new(100_000, 1000), exports());
    let job = endless(&place, &mut exports);
    job.stop();
    wait_until("stopped", || !job.is_open());
    let Status::Done(outcome) = job.status() else { panic!("{:?}", job.status()) };
    assert!(outcome.passes >= 1 && outcome.passes < outcome.planned);
    assert_eq!(files(&place.path("frames")).len(), 6);
    assert!(job.picture().is_some());
}

#[test]
fn a_time_limit_ends_with_at_least_one_pass() {
    let (place, mut exports) = (Place::new(100_000, 1000), exports());
    let job = exports.add(ExportSettings { limit: Some(Duration::ZERO), ..place.settings() });
    wait_until("over", || !job.is_open());
    let Status::Done(outcome) = job.status() else { panic!("{:?}", job.status()) };
    assert!(outcome.passes >= 1 && outcome.passes < outcome.planned);
}

#[test]
fn exports_queue_and_one_that_fails_says_why_and_stops_no_other() {
    let (place, mut exports) = (Place::new(1, 1000), exports());
    let bad = exports.add(ExportSettings { folder: place.file(), ..place.settings() });
    let good = exports.add(place.settings());
    wait_until("both", || !exports.is_busy());
    let Status::Failed(why) = bad.status() else { panic!("{:?}", bad.status()) };
    assert!(why.contains("is a file"), "{why}");
    assert!(matches!(good.status(), Status::Done(_)), "{:?}", good.status());
    exports.clear();
    assert!(exports.jobs().is_empty());
}

#[test]
fn an_export_does_not_overwrite_what_the_project_is_made_from() {
    let (place, mut exports) = (Place::new(1, 1000), exports());
    let mut project = Project::load(&place.file()).unwrap();
    project.output.name = "letter_c".into();
    let settings = ExportSettings { folder: place.path("assets/targets"), ..place.settings() };
    let before = files(&settings.folder);
    project.output.name = "####".into();
    std::fs::write(place.path("assets/targets/0001.png"), &before[0].1).unwrap();
    let lightloom_core::project::Shows::Image(image) = &mut project.keys[0].shows else {
        panic!("a picture")
    };
    image.file = "../assets/targets/0001.png".into();
    let job = exports.add(ExportSettings { project: Arc::new(project), ..settings });
    wait_until("refused", || !job.is_open());
    let Status::Failed(why) = job.status() else { panic!("{:?}", job.status()) };
    assert!(why.contains("0001.png"), "{why}");
}

#[test]
fn closing_the_program_breaks_an_export_off() {
    let (place, mut exports) = (Place::new(100_000, 20_000), exports());
    let job = endless(&place, &mut exports);
    drop(exports);
    assert_eq!(job.status(), Status::Cancelled);
}
