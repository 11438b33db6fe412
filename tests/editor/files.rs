//! Files of the whole window: from elsewhere, saved elsewhere, open twice, changed by others, of a later version.

use std::fs;
use std::path::{Path, PathBuf};

use crate::window::{examples, folders, project, until, window};
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use lightloom::editor::App;
use lightloom::editor::action::Action;
use lightloom::editor::asset::{AssetUse, TargetSlot};
use lightloom::editor::command::Command;
use lightloom::editor::dialogs::PickResult;
use lightloom::editor::store::trusted;
use lightloom_core::project::{AssetFolder, Project};

/// Lets the window run until a widget of this label is there.
fn until_seen(harness: &mut Harness<App>, label: &str) {
    for _ in 0..20_000 {
        if harness.query_all_by_label_contains(label).next().is_some() {
            return;
        }
        harness.step();
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    panic!("waited in vain: {label}");
}

fn click(harness: &mut Harness<App>, label: &str) {
    until_seen(harness, label);
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::Button, label).click();
    harness.run_steps(3);
}

/// A picture in a folder of its own.
fn logo() -> (tempfile::TempDir, PathBuf) {
    let far = tempfile::tempdir().unwrap();
    let path = far.path().canonicalize().unwrap().join("logo.png");
    fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/targets/star.png"), &path).unwrap();
    (far, path)
}

fn pick_picture(harness: &mut Harness<App>) {
    let slot = TargetSlot { key: 1, caustic: None };
    harness.run_steps(3);
    harness.state_mut().ask(Action::PickFile(AssetUse::Picture(slot)));
}

fn save_as(harness: &mut Harness<App>) {
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
}

#[test]
fn a_picture_from_elsewhere_is_asked_about_once_and_copied_beside_the_saved_project() {
    let folder = examples();
    let (_far, logo) = logo();
    let picked = PickResult::Picked(logo.clone());
    let mut harness = window(&folder, "letters_free", vec![picked.clone(), picked]);
    pick_picture(&mut harness);
    click(&mut harness, "Copy beside the project");
    until(&mut harness, "the picture", |app| app.document().is_unsaved());
    until(&mut harness, "its light", |app| app.preview().is_current());
    assert_eq!(harness.state().preview().problem(), None);
    // The second time nobody asks.
    pick_picture(&mut harness);
    harness.run_steps(20);
    assert!(harness.query_by_label("Copy beside the project").is_none());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    until(&mut harness, "the save", |app| !app.document().is_unsaved());
    let path = project(&folder, "letters_free");
    let saved = Project::load(&path).unwrap();
    assert_eq!(saved.files()[1], "assets/logo.png");
    assert_eq!(saved, **harness.state().document().project());
    let copy = AssetFolder::new(&path, false).unwrap().resolve(saved.files()[1], "x").unwrap();
    assert_eq!(fs::read(copy).unwrap(), fs::read(logo).unwrap());
}

#[test]
fn a_trusted_picture_stays_where_it_is_and_is_read_ever_after() {
    let folder = examples();
    let (_far, logo) = logo();
    let mut harness = window(&folder, "letters_free", vec![PickResult::Picked(logo.clone())]);
    pick_picture(&mut harness);
    click(&mut harness, "Trust for good");
    until(&mut harness, "the picture", |app| app.document().is_unsaved());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    until(&mut harness, "the save", |app| !app.document().is_unsaved());
    drop(harness);
    let path = project(&folder, "letters_free");
    let list = trusted(Some(&folders(folder.path())));
    let assets = AssetFolder::new(&path, false).unwrap().admitting(list);
    let found = assets.resolve(Project::load(&path).unwrap().files()[1], "x").unwrap();
    assert_eq!(found, logo);
    // Opened again nobody asks, and nothing is wrong.
    let mut harness = window(&folder, "letters_free", Vec::new());
    until(&mut harness, "the light", |app| app.preview().is_current());
    assert!(harness.query_by_label("Trust for good").is_none());
}

#[test]
fn work_that_was_cut_off_reads_the_picked_files_again_without_a_question() {
    let folder = examples();
    let (_far, logo) = logo();
    let mut harness = window(&folder, "letters_free", vec![PickResult::Picked(logo)]);
    pick_picture(&mut harness);
    click(&mut harness, "Copy beside the project");
    until(&mut harness, "the picture", |app| app.document().is_unsaved());
    harness.run_steps(3);
    let work = harness.state().document().project().clone();
    // What ends without saving leaves its journal, as what is killed does.
    drop(harness);
    let mut harness = window(&folder, "dark_glass", Vec::new());
    click(&mut harness, "Recover");
    until(&mut harness, "the work", |app| *app.document().project() == work);
    until(&mut harness, "its light", |app| {
        assert_eq!(app.preview().problem(), None);
        app.preview().is_current()
    });
    harness.run_steps(20);
    assert!(harness.query_by_label("Copy beside the project").is_none());
    // Saved, it takes the picture along.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    until(&mut harness, "the save", |app| !app.document().is_unsaved());
    assert!(folder.path().join("projects/assets/logo.png").is_file());
}

#[test]
fn work_whose_owner_is_still_dying_when_the_window_opens_is_offered_once_it_is_gone() {
    let folder = examples();
    let (_far, logo) = logo();
    let mut dying = window(&folder, "letters_free", vec![PickResult::Picked(logo)]);
    pick_picture(&mut dying);
    click(&mut dying, "Copy beside the project");
    until(&mut dying, "the picture", |app| app.document().is_unsaved());
    dying.run_steps(3);
    let mut harness = window(&folder, "dark_glass", Vec::new());
    // The first look finds nothing.
    until(&mut harness, "the light", |app| app.preview().is_current());
    assert!(harness.query_by_label("Recover").is_none());
    drop(dying);
    until_seen(&mut harness, "Recover");
}

#[test]
fn a_project_that_names_files_elsewhere_asks_when_it_is_opened() {
    let folder = examples();
    let (_far, logo) = logo();
    let path = project(&folder, "letters_free");
    let text =
        fs::read_to_string(&path).unwrap().replace("../assets/targets/letter_s.png", logo.to_str().unwrap());
    fs::write(&path, text).unwrap();
    let mut harness = window(&folder, "letters_free", Vec::new());
    click(&mut harness, "Copy beside the project");
    until(&mut harness, "the light", |app| app.preview().is_current());
    assert!(harness.state().document().is_unsaved());
}

#[test]
fn an_example_takes_its_files_along_and_its_frames_are_called_as_its_file() {
    let folder = examples();
    let there = folder.path().join("home/me");
    fs::create_dir_all(&there).unwrap();
    let path = there.join("vase.json");
    let mut harness = window(&folder, "bottles", vec![PickResult::Picked(path.clone())]);
    harness.run_steps(3);
    save_as(&mut harness);
    until(&mut harness, "the save", |app| app.document().path() == Some(&path));
    let saved = Project::load(&path).unwrap();
    assert_eq!(saved.output.name, "vase.####");
    let assets = AssetFolder::new(&path, false).unwrap();
    for file in saved.files() {
        assert!(assets.resolve(file, "x").unwrap().starts_with(there.canonicalize().unwrap()), "{file}");
    }
    assert!(there.join("assets/meshes/bottle_round.mtl").is_file());
    assert!(!harness.state().document().is_unsaved());
}

#[test]
fn the_menu_collects_the_project_with_all_its_files() {
    let folder = examples();
    let into = folder.path().join("handed on");
    let mut harness = window(&folder, "dark_glass", vec![PickResult::Picked(into.clone())]);
    harness.run_steps(3);
    harness.state_mut().ask(Action::Command(Command::Collect));
    let path = into.join("dark_glass.json");
    until(&mut harness, "the collection", |_| path.is_file());
    assert!(into.join("assets/meshes/goblet.mtl").is_file());
    let project = Project::load(&path).unwrap();
    let assets = AssetFolder::new(&path, false).unwrap();
    project.files().iter().for_each(|file| assert!(assets.resolve(file, "x").is_ok(), "{file}"));
}

#[test]
fn a_second_window_is_read_only_and_saves_under_another_name() {
    let folder = examples();
    let other = folder.path().join("projects/mine.json");
    let path = project(&folder, "letters_free");
    let before = fs::read(&path).unwrap();
    let mut first = window(&folder, "letters_free", Vec::new());
    until(&mut first, "the lock", |_| path.with_file_name(".letters_free.json.lock").is_file());
    let mut second = window(&folder, "letters_free", vec![PickResult::Picked(other.clone())]);
    until(&mut second, "the notice", |app| app.document().read_only().is_some());
    click(&mut second, "Close");
    second.key_press_modifiers(Modifiers::COMMAND, Key::S);
    until(&mut second, "the save", |app| app.document().path() == Some(&other));
    assert!(second.state().document().read_only().is_none());
    assert_eq!(fs::read(&path).unwrap(), before);
}

#[test]
fn what_another_program_changes_is_reloaded_or_kept() {
    for reload in [true, false] {
        let folder = examples();
        let path = project(&folder, "letters_free");
        let mut harness = window(&folder, "letters_free", Vec::new());
        until(&mut harness, "the lock", |_| path.with_file_name(".letters_free.json.lock").is_file());
        harness.run_steps(5);
        let mut changed = Project::load(&path).unwrap();
        changed.seed = 77;
        changed.save(&path).unwrap();
        click(&mut harness, if reload { "Reload" } else { "Keep open version" });
        if reload {
            until(&mut harness, "the other's work", |app| app.document().project().seed == 77);
        } else {
            assert!(harness.state().document().is_unsaved());
            harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
            until(&mut harness, "the save", |app| !app.document().is_unsaved());
            assert_ne!(Project::load(&path).unwrap().seed, 77);
        }
    }
}

#[test]
fn a_picture_that_is_gone_and_comes_back_is_noticed_without_an_edit() {
    let folder = examples();
    let mut harness = window(&folder, "letters_free", Vec::new());
    until(&mut harness, "the light", |app| app.preview().is_current());
    harness.run_steps(3);
    let file = folder.path().join("assets/targets/letter_s.png");
    let bytes = fs::read(&file).unwrap();
    fs::remove_file(&file).unwrap();
    until(&mut harness, "the problem", |app| app.preview().problem().is_some());
    fs::write(&file, bytes).unwrap();
    until(&mut harness, "its end", |app| app.preview().problem().is_none() && app.preview().is_current());
    assert!(!harness.state().document().is_unsaved());
    // On demand all is read at once, and nothing else changes.
    harness.state_mut().ask(Command::ReloadAssets.into());
    harness.run_steps(1);
    assert!(!harness.state().preview().is_current());
    until(&mut harness, "the light", |app| app.preview().is_current());
    assert!(!harness.state().document().is_unsaved());
}

#[test]
fn a_new_project_without_name_is_called_as_its_file() {
    let folder = examples();
    let path = folder.path().join("my shot.json");
    let mut harness = window(&folder, "letters_free", vec![PickResult::Picked(path.clone())]);
    harness.run_steps(3);
    harness.state_mut().ask(Command::NewEmpty.into());
    until(&mut harness, "the empty project", |app| app.document().path().is_none());
    harness.run_steps(2);
    assert_eq!(harness.state().document().project().name, "");
    save_as(&mut harness);
    until(&mut harness, "the save", |app| app.document().path() == Some(&path));
    assert_eq!(Project::load(&path).unwrap().name, "my shot");
    let document = harness.state().document();
    assert!(!document.is_unsaved() && document.project().name == "my shot");
}

#[test]
fn a_backup_is_opened_and_saved_as_the_file_again() {
    let folder = examples();
    let path = project(&folder, "letters_free");
    let mut harness = window(&folder, "letters_free", Vec::new());
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Slider, "Gamma").set_value_accesskit(0.75);
    harness.run_steps(4);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    until(&mut harness, "the save", |app| !app.document().is_unsaved());
    assert_eq!(Project::load(&path).unwrap().flow.gamma, 0.75);
    let backups: Vec<_> =
        fs::read_dir(folders(folder.path()).backups()).unwrap().map(|e| e.unwrap().path()).collect();
    let [backup] = &backups[..] else { panic!("{backups:?}") };
    harness.state_mut().ask(Action::OpenBackup(backup.clone()));
    until(&mut harness, "the backup", |app| app.document().project().flow.gamma == 0.25);
    assert_eq!(harness.state().document().path(), Some(&*path));
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    until(&mut harness, "the save", |app| !app.document().is_unsaved());
    assert_eq!(Project::load(&path).unwrap().flow.gamma, 0.25);
}

#[test]
fn a_file_of_a_later_version_is_read_only_and_saved_whole_under_another_name() {
    let folder = examples();
    let path = project(&folder, "letters_free");
    let text = fs::read_to_string(&path).unwrap();
    let later = text.replacen("\"lightloom\": 1,", "\"lightloom\": 9, \"aurora\": [1, 2],", 1);
    assert_ne!(text, later);
    fs::write(&path, &later).unwrap();
    let other = folder.path().join("projects/mine.json");
    let mut harness = window(&folder, "letters_free", vec![PickResult::Picked(other.clone())]);
    click(&mut harness, "Close");
    assert!(harness.state().document().read_only().is_some());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    until(&mut harness, "the save", |app| app.document().path() == Some(&other));
    let saved = fs::read_to_string(&other).unwrap();
    assert!(saved.contains("\"aurora\": [1, 2]") && saved.contains("\"lightloom\": 9"), "{saved}");
    assert_eq!(fs::read_to_string(&path).unwrap(), later);
}

#[test]
fn what_is_typed_while_a_dialog_opens_is_its_name_and_no_tool() {
    let folder = examples();
    // The system has no dialog: the list of answers is empty.
    let mut harness = window(&folder, "letters_free", Vec::new());
    harness.run_steps(3);
    let tool = harness.state().session().tool;
    let key =
        |key, modifiers| Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
    // All in one frame, and more in the next ones.
    harness.event(key(Key::O, Modifiers::COMMAND));
    for letter in ["w", "d", "e", "k"] {
        harness.event(key(Key::from_name(&letter.to_uppercase()).unwrap(), Modifiers::NONE));
        harness.event(Event::Text(letter.to_owned()));
    }
    harness.run_steps(1);
    for letter in ["w", "e", "b", "k"] {
        harness.event(key(Key::from_name(&letter.to_uppercase()).unwrap(), Modifiers::NONE));
        harness.event(Event::Text(letter.to_owned()));
        harness.run_steps(1);
    }
    until_seen(&mut harness, "Open a project");
    harness.run_steps(10);
    assert_eq!(harness.state().session().tool, tool);
    assert_eq!(harness.state().document().project().keys.len(), 2, "K adds a key frame");
    let typed = harness.get_by_label("Path").value().unwrap_or_default();
    assert!(typed.ends_with("wdekwebk"), "{typed}");
}

#[test]
fn keys_of_one_frame_go_through_windows_that_they_open_and_close() {
    let folder = examples();
    let other = project(&folder, "bottles");
    // The system has no dialog: the list of answers is empty.
    let mut harness = window(&folder, "letters_free", Vec::new());
    harness.run_steps(3);
    let press = |harness: &mut Harness<App>, key, modifiers| {
        for pressed in [true, false] {
            harness.event(Event::Key { key, physical_key: None, pressed, repeat: false, modifiers });
        }
    };
    press(&mut harness, Key::N, Modifiers::COMMAND);
    press(&mut harness, Key::Escape, Modifiers::NONE);
    press(&mut harness, Key::O, Modifiers::COMMAND);
    harness.event(Event::Text(other.to_string_lossy().into_owned()));
    press(&mut harness, Key::Enter, Modifiers::NONE);
    until(&mut harness, "the other project", |app| app.document().path() == Some(&other));
}
