//! A real window: the program itself under Xvfb, moved by xdotool as by a hand. Where Xvfb, xdotool or something that
//! draws is missing, there is no window to test, and the test says so.
//!
//! The same window without a screen tells where everything stands.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};
use std::time::{Duration, Instant};

use egui::Rect;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;
use lightloom::editor::action::Action;
use lightloom::editor::command::Command as EditorCommand;
use lightloom::editor::export::ExportOptions;
use lightloom_core::constraint::Constraint;
use lightloom_core::project::Project;

use crate::small::make_small;
use crate::window;

/// Xvfb and the program on it; both end with it.
struct Screen {
    display: String,
    server: Child,
    program: Option<Child>,
    folder: PathBuf,
}

impl Drop for Screen {
    fn drop(&mut self) {
        for child in self.program.iter_mut().chain([&mut self.server]) {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

impl Screen {
    /// A screen of its own number; none where there is no Xvfb.
    fn start(folder: &Path) -> Option<Self> {
        static SCREENS: AtomicU32 = AtomicU32::new(0);
        let display = format!(":{}", 200 + (4 * std::process::id() + SCREENS.fetch_add(1, Relaxed)) % 2800);
        let mut server = Command::new("Xvfb");
        // Without `-noreset` the server starts over whenever its last client goes, and takes along a program that comes at that moment.
        server.args([&display, "-screen", "0", "1440x900x24", "-nolisten", "tcp", "-noreset"]);
        let server = server.stdout(Stdio::null()).stderr(Stdio::null()).spawn().ok()?;
        let screen = Self { display, server, program: None, folder: folder.to_owned() };
        std::thread::sleep(Duration::from_secs(1));
        Command::new("xdotool").arg("version").output().ok()?;
        Some(screen)
    }

    /// Opens the program on a project and waits for its window; none where it cannot draw.
    fn open(&mut self, project: &Path) -> Option<()> {
        let mut program = Command::new(env!("CARGO_BIN_EXE_lightloom"));
        program.arg(project).env("DISPLAY", &self.display).env_remove("WAYLAND_DISPLAY");
        program.env("XDG_RUNTIME_DIR", &self.folder);
        program.env("LIGHTLOOM_STATE_DIR", self.folder.join("state"));
        program.env("LIGHTLOOM_CONFIG_DIR", self.folder.join("config"));
        self.program = Some(program.stderr(Stdio::null()).spawn().unwrap());
        let begun = Instant::now();
        while begun.elapsed() < Duration::from_secs(60) {
            if !self.tool(&["search", "--onlyvisible", "--name", "Lightloom"]).is_empty() {
                std::thread::sleep(Duration::from_secs(3));
                // What was found first may be the window of a program that was killed, on its way.
                let id = self.tool(&["search", "--onlyvisible", "--name", "Lightloom"]);
                if let Some(id) = id.lines().next() {
                    self.tool(&["windowfocus", id]);
                    return Some(());
                }
            }
            if self.program.as_mut()?.try_wait().unwrap().is_some() {
                return None;
            }
            std::thread::sleep(Duration::from_millis(200));
        }
        None
    }

    fn tool(&self, args: &[&str]) -> String {
        let output = Command::new("xdotool").args(args).env("DISPLAY", &self.display).output().unwrap();
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    fn key(&self, keys: &str) {
        self.tool(&["key", keys]);
        std::thread::sleep(Duration::from_millis(400));
    }

    fn drag(&self, from: [f32; 2], to: [f32; 2]) {
        let at = |p: [f32; 2]| p.map(|n| format!("{n:.0}"));
        let go = |p: [f32; 2]| {
            let [x, y] = at(p);
            self.tool(&["mousemove", &x, &y]);
            std::thread::sleep(Duration::from_millis(30));
        };
        go(from);
        self.tool(&["mousedown", "1"]);
        for i in 1..=16 {
            go([0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * i as f32 / 16.0));
        }
        self.tool(&["mouseup", "1"]);
        std::thread::sleep(Duration::from_millis(400));
    }

    fn click(&self, at: [f32; 2]) {
        let [x, y] = at.map(|n| format!("{n:.0}"));
        self.tool(&["mousemove", &x, &y]);
        self.tool(&["click", "1"]);
        std::thread::sleep(Duration::from_millis(400));
    }

    /// The pixels of the screen, by what `xwd` says: a file without compression.
    fn pixels(&self) -> Vec<u8> {
        let seen = Command::new("xwd").args(["-root", "-silent", "-display", &self.display]).output();
        seen.map(|output| output.stdout).unwrap_or_default()
    }

    fn until(&self, what: &str, holds: impl Fn() -> bool) {
        let begun = Instant::now();
        while !holds() {
            // For a busy machine without a graphics card.
            assert!(begun.elapsed() < Duration::from_secs(120), "waited in vain: {what}");
            std::thread::sleep(Duration::from_millis(200));
        }
    }
}

/// Where things stand in the window.
struct Places {
    plane: Rect,
    gamma: Rect,
    frames: Rect,
    export: Rect,
}

fn places(folder: &tempfile::TempDir) -> Places {
    let mut harness = window::window(folder, "letters_free", Vec::new());
    harness.run_steps(6);
    let plane = harness.get_by_label("Plane").rect();
    let gamma = harness.get_by_role_and_label(Role::Slider, "Gamma").rect();
    harness.state_mut().ask(Action::Command(EditorCommand::Export));
    harness.run_steps(6);
    let frames = harness.get_by_role_and_label(Role::TextInput, "Frames").rect();
    Places { plane, gamma, frames, export: harness.get_by_label("Export 60 frames").rect() }
}

/// Exports frames 1 to 5 by hand.
fn export_five_frames(screen: &Screen, Places { frames, export, .. }: &Places) {
    screen.key("ctrl+e");
    // A busy machine shows the window late; a click before would go to what lies beneath.
    std::thread::sleep(Duration::from_millis(1500));
    let middle = |place: Rect| [place.center().x, place.center().y];
    screen.click(middle(*frames));
    screen.key("ctrl+a");
    screen.tool(&["type", "1-5"]);
    screen.key("Tab");
    screen.click(middle(*export));
}

#[test]
fn a_hand_draws_a_wall_tunes_undoes_saves_and_exports() {
    let folder = window::examples();
    let Some(mut screen) = Screen::start(folder.path()) else {
        eprintln!("no Xvfb or no xdotool: no window is tested");
        return;
    };
    let path = window::project(&folder, "letters_free");
    make_small(&path, 1);
    let original = fs::read(&path).unwrap();
    let places = places(&folder);
    let (plane, gamma) = (places.plane, places.gamma);
    fs::create_dir_all(folder.path().join("config")).unwrap();
    window::preferences().save(&folder.path().join("config")).unwrap();
    let Some(()) = screen.open(&path) else {
        eprintln!("nothing draws on a screen here: no window is tested");
        return;
    };
    let saved = || Project::load(&path).unwrap();
    let before = screen.pixels();

    screen.key("w");
    let at = |x: f32, y: f32| [plane.left() + plane.width() * x, plane.top() + plane.height() * y];
    screen.drag(at(0.45, 0.35), at(0.55, 0.65));
    screen.key("ctrl+s");
    screen.until("the wall in the file", || saved().constraints.len() == 1);
    assert!(matches!(saved().constraints[0], Constraint::Wall(_)));
    if !before.is_empty() {
        assert!(screen.pixels() != before, "the screen shows no wall");
    }

    let knob = gamma.left() + gamma.width() * 0.25;
    screen.drag([knob, gamma.center().y], [gamma.left() + gamma.width() * 0.6, gamma.center().y]);
    screen.key("ctrl+s");
    screen.until("another gamma in the file", || saved().flow.gamma != 0.25);
    screen.key("ctrl+z");
    screen.key("ctrl+z");
    screen.key("ctrl+s");
    screen.until("both undone in the file", || saved().constraints.is_empty() && saved().flow.gamma == 0.25);
    assert_eq!(fs::read(&path).unwrap(), original);

    export_five_frames(&screen, &places);
    let folder = ExportOptions::of(&saved(), Some(&path)).folder;
    screen.until("the export", || folder.join("summary.json").is_file());
    let pictures =
        fs::read_dir(&folder).unwrap().filter_map(|entry| entry.unwrap().file_name().into_string().ok());
    assert_eq!(
        pictures.filter(|name| name.starts_with("letters_free.") && name.ends_with(".png")).count(),
        5
    );
    screen.key("ctrl+q");
    let program = screen.program.as_mut().unwrap();
    let begun = Instant::now();
    while program.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < Duration::from_secs(60), "the window does not close");
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn an_export_that_was_killed_is_offered_and_ends_with_the_bytes_of_the_command_line() {
    let folder = window::examples();
    let Some(mut screen) = Screen::start(folder.path()) else {
        eprintln!("no Xvfb or no xdotool: no window is tested");
        return;
    };
    let path = window::project(&folder, "letters_free");
    make_small(&path, 100);
    let places = places(&folder);
    fs::create_dir_all(folder.path().join("config")).unwrap();
    window::preferences().save(&folder.path().join("config")).unwrap();
    let Some(()) = screen.open(&path) else {
        eprintln!("nothing draws on a screen here: no window is tested");
        return;
    };
    export_five_frames(&screen, &places);
    let out = ExportOptions::of(&Project::load(&path).unwrap(), Some(&path)).folder;
    let passes_kept = || {
        let entries = fs::read_dir(&out).into_iter().flatten().flatten();
        entries
            .filter_map(|entry| fs::metadata(entry.path().join("journal")).ok())
            .any(|file| file.len() > 200)
    };
    screen.until("light that is kept", passes_kept);
    let program = screen.program.as_mut().unwrap();
    program.kill().unwrap();
    program.wait().unwrap();
    assert!(!out.join("summary.json").exists(), "the export was over too soon");

    screen.open(&path).unwrap();
    // The export is offered; yes.
    screen.key("Return");
    screen.until("the export", || out.join("summary.json").is_file());
    let text = fs::read_to_string(out.join("summary.json")).unwrap();
    assert!(text.contains("passes of an earlier run"), "{text}");
    let alone = folder.path().join("alone");
    let mut command = Command::new(env!("CARGO_BIN_EXE_lightloom"));
    command.args(["render", path.to_str().unwrap(), "--frames", "1-5", "--out", alone.to_str().unwrap()]);
    assert!(command.output().unwrap().status.success());
    for entry in fs::read_dir(&alone).unwrap().map(|entry| entry.unwrap().file_name()) {
        let same = fs::read(alone.join(&entry)).unwrap() == fs::read(out.join(&entry)).unwrap();
        assert!(same || entry == "summary.json", "{entry:?} has other bytes");
    }
}
