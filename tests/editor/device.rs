//! A window whose graphics device is lost: everything is on the disk, and the program starts anew or says why it does not.
//!
//! The test starts itself again as the victim: [`victim_loses_its_device`] does nothing unless a folder is named to it.

use std::process::{Command, Output};
use std::sync::Arc;

use crate::window::{document, examples, folders, preferences, project, until};
use egui_kittest::Harness;
use lightloom::editor::action::Action;
use lightloom::editor::device::Device;
use lightloom::editor::dialogs::Scripted;
use lightloom::editor::document::Edit;
use lightloom::editor::store::recoverable;
use lightloom::editor::{App, Gpu, Setup};

const FOLDER: &str = "LIGHTLOOM_TEST_DEVICE_FOLDER";
/// Tells how many programs before lost their device.
const LOST: &str = "LIGHTLOOM_DEVICES_LOST";

/// Changes the project, and goes on without a device: the process ends, or is another program then.
#[test]
fn victim_loses_its_device() {
    let Some(folder) = std::env::var_os(FOLDER).map(std::path::PathBuf::from) else { return };
    let device = Arc::new(Device::default());
    let setup = Setup {
        document: document(&folder.join("projects/letters_free.json")),
        message: None,
        folders: Some(folders(&folder)),
        preferences: preferences(),
        keeps_preferences: true,
        dialogs: Arc::new(Scripted::new(Vec::new())),
        gpu: Gpu::None,
        graphics: "none".to_owned(),
        device: device.clone(),
    };
    let mut setup = Some(setup);
    let mut harness = Harness::builder().build_eframe(|cc| App::new(&cc.egui_ctx, setup.take().unwrap()));
    harness.state_mut().ask(Action::Edit(Edit::Seed(77)));
    until(&mut harness, "the change", |app| app.document().is_unsaved());
    device.lose();
    harness.step();
    panic!("the window went on");
}

/// Lets a victim lose its device after this many before it; what it said, and the seed that is offered for recovery.
fn victim(lost_before: &str) -> (Output, u64) {
    let folder = examples();
    let victim = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "device::victim_loses_its_device", "--nocapture"])
        .env(FOLDER, folder.path())
        .env(LOST, lost_before)
        .output()
        .unwrap();
    let lock = project(&folder, "letters_free").with_file_name(".letters_free.json.lock");
    assert!(!lock.exists(), "the project is still locked");
    let offered = recoverable(&folders(folder.path()).recovery());
    let [recovery] = &offered[..] else { panic!("{offered:?}, {victim:?}") };
    (victim, recovery.work.as_ref().unwrap().project().seed)
}

#[test]
fn a_window_without_its_device_keeps_the_work_and_starts_anew_or_says_why_not() {
    // The program that takes its place is the test again, which finds no test of the project's name.
    let (victim, seed) = victim("0");
    let said = String::from_utf8_lossy(&victim.stdout);
    assert!(victim.status.success() && said.contains("running 0 tests"), "{victim:?}");
    assert_eq!(seed, 77);
    let (victim, seed) = self::victim("3");
    let said = String::from_utf8_lossy(&victim.stderr);
    assert_eq!(victim.status.code(), Some(75), "{victim:?}");
    assert!(said.contains("the graphics device was lost (again and again)"), "{said}");
    assert!(said.contains("offered at the next start"), "{said}");
    assert_eq!(seed, 77);
}
