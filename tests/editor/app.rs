//! The whole window without a screen: real keys and pointers in, documents and files out.

use std::fs;
use std::time::{Duration, SystemTime};

use crate::window::{self, SIZE, examples, project, until, window, window_with};
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use lightloom::editor::App;
use lightloom::editor::action::Action;
use lightloom::editor::command::Command;
use lightloom::editor::dialogs::PickResult;
use lightloom::editor::document::Edit;
use lightloom::editor::store::Theme;
use lightloom_core::constraint::Constraint;
use lightloom_core::project::{Project, Shows};

/// Drags over the plane view, from and to shares of its width and height.
fn drag(harness: &mut Harness<App>, from: [f32; 2], to: [f32; 2]) {
    let plane = harness.get_by_label("Plane").rect();
    let at = |share: [f32; 2]| -> Pos2 {
        pos2(plane.left() + plane.width() * share[0], plane.top() + plane.height() * share[1])
    };
    let button = |pos, pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    harness.event(Event::PointerMoved(at(from)));
    harness.event(button(at(from), true));
    for i in 1..=20 {
        let share = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * i as f32 / 20.0);
        harness.event(Event::PointerMoved(at(share)));
    }
    harness.event(button(at(to), false));
    harness.run_steps(30);
}

#[test]
fn a_wall_is_drawn_seen_undone_saved_and_opened_again() {
    let folder = examples();
    let path = project(&folder, "letters_free");
    let before = fs::read(&path).unwrap();
    let mut harness = window(&folder, "letters_free", Vec::new());
    until(&mut harness, "the first light", |app| app.preview().preview().is_some());
    // Saving what was not changed writes the same bytes. An old date shows when the file was written.
    let old = SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000_000);
    fs::File::options().write(true).open(&path).unwrap().set_modified(old).unwrap();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    until(&mut harness, "the first save", |_| fs::metadata(&path).unwrap().modified().unwrap() != old);
    assert_eq!(fs::read(&path).unwrap(), before);

    harness.key_press(Key::W);
    harness.run_steps(3);
    drag(&mut harness, [0.5, 0.3], [0.5, 0.7]);
    let drawn = |app: &App| app.document().project().constraints.len();
    assert_eq!(drawn(harness.state()), 1);
    assert!(matches!(harness.state().document().project().constraints[0], Constraint::Wall(_)));
    assert!(harness.state().document().is_unsaved());
    until(&mut harness, "the light around the wall", |app| app.preview().is_current());

    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    assert_eq!(drawn(harness.state()), 0);
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    harness.run_steps(3);
    assert_eq!(drawn(harness.state()), 1);

    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    until(&mut harness, "the save", |app| !app.document().is_unsaved());
    let saved = Project::load(&path).unwrap();
    assert_eq!(saved, **harness.state().document().project());
    assert_eq!(saved.constraints.len(), 1);
}

#[test]
fn the_gamma_slider_changes_the_flow_in_one_step() {
    let folder = examples();
    let mut harness = window(&folder, "letters_free", Vec::new());
    harness.run_steps(4);
    harness.get_by_role_and_label(Role::Slider, "Gamma").set_value_accesskit(0.75);
    harness.run_steps(4);
    let gamma = |app: &App| app.document().project().flow.gamma;
    assert_eq!(gamma(harness.state()), 0.75);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(4);
    assert_eq!(gamma(harness.state()), 0.25);
    assert!(!harness.state().document().is_unsaved());
}

#[test]
fn saved_elsewhere_the_project_still_finds_its_files() {
    let folder = examples();
    let there = folder.path().join("shots/a");
    fs::create_dir_all(&there).unwrap();
    fs::create_dir_all(folder.path().join("shots/assets")).unwrap();
    let path = there.join("mine.json");
    let mut harness = window(&folder, "letters_free", vec![PickResult::Picked(path.clone())]);
    harness.run_steps(3);
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    until(&mut harness, "the save", |app| app.document().path() == Some(&path));
    for file in Project::load(&path).unwrap().files() {
        assert!(there.join(file).is_file(), "{file}");
    }
}

#[test]
fn a_wrong_value_of_the_project_is_told_and_the_light_stays() {
    let folder = examples();
    let mut harness = window(&folder, "letters_free", Vec::new());
    until(&mut harness, "the first light", |app| app.preview().is_current());
    let mut keys = harness.state().document().project().keys.clone();
    if let Shows::Image(image) = &mut keys[1].shows {
        image.file = "../assets/targets/not_there.png".into();
    }
    harness.state_mut().ask(Action::Edit(Edit::Keys(keys)));
    until(&mut harness, "the problem", |app| app.preview().problem().is_some());
    let problem = harness.state().preview().problem().unwrap();
    assert!(problem.contains("keys[1].shows.image.file") && problem.contains("not_there.png"), "{problem}");
    assert!(harness.state().preview().preview().is_some());
    harness.run_steps(3);
}

#[test]
fn closing_the_window_stops_the_workers() {
    let folder = examples();
    let mut harness = window(&folder, "dark_glass", Vec::new());
    harness.run_steps(3);
    // They have just begun to load the scene and to look through its camera.
    let begun = std::time::Instant::now();
    drop(harness);
    // A second is asked for; ten for a machine where others build.
    assert!(begun.elapsed().as_secs() < 10, "{:?}", begun.elapsed());
}

/// The labels of all views.
const VIEWS: [&str; 3] = ["Plane", "Shot", "Orbit view"];

fn examples_are_shown_in(theme: Theme) {
    let folder = examples();
    for name in ["letters", "bottles", "dark_glass", "rabbit", "loop"] {
        let mut preferences = window::preferences();
        preferences.theme = theme;
        let mut harness = window_with(&folder, name, Vec::new(), preferences);
        harness.run_steps(2);
        assert_eq!(harness.ctx.global_style().visuals.dark_mode, theme == Theme::Dark, "{name}");
        for size in [[720.0, 480.0], SIZE, [3000.0, 1600.0]] {
            harness.set_size(size.into());
            let layouts = [(Key::Num4, &VIEWS[2..]), (Key::Num3, &VIEWS[1..2]), (Key::Num2, &VIEWS[..1])];
            for (key, shown) in layouts.into_iter().chain([(Key::Num1, &VIEWS[..2])]) {
                harness.key_press(key);
                harness.run_steps(2);
                let window = Rect::from_min_size(Pos2::ZERO, size.into());
                for view in VIEWS {
                    let rect = harness.query_by_label(view).map(|view| view.rect());
                    assert_eq!(rect.is_some(), shown.contains(&view), "{name}, {size:?}, {key:?}: {view}");
                    assert!(
                        rect.is_none_or(|rect| rect.is_positive() && window.contains_rect(rect)),
                        "{rect:?}"
                    );
                }
                let play = harness.get_by_role_and_label(Role::Button, "Play or pause").rect();
                assert!(window.contains_rect(play), "{name}, {size:?}: {play:?}");
            }
        }
        for key in [Key::F, Key::G, Key::C] {
            harness.key_press(key);
            harness.run_steps(2);
        }
        let app = harness.state();
        assert!(
            app.session().overlays.arrows && app.session().overlays.grid && app.session().compare.is_some()
        );
        assert_eq!(app.preview().problem(), None, "{name}");
    }
}

#[test]
fn every_example_is_shown_in_every_view_and_size_in_the_dark_theme() {
    examples_are_shown_in(Theme::Dark);
}

#[test]
fn every_example_is_shown_in_every_view_and_size_in_the_light_theme() {
    examples_are_shown_in(Theme::Light);
}

#[test]
fn escape_closes_one_window_after_the_other_and_then_is_that_of_the_tools() {
    let folder = examples();
    let mut harness = window(&folder, "letters_free", Vec::new());
    // A word that only this window has.
    let words = ["Equivalent command line", "Reset all"];
    for command in [Command::Export, Command::Preferences] {
        harness.state_mut().ask(Action::Command(command));
        harness.run_steps(4);
    }
    let open = |harness: &Harness<App>| words.map(|word| harness.query_by_label(word).is_some());
    for expected in [[true, true], [true, false], [false, false]] {
        assert_eq!(open(&harness), expected);
        harness.key_press(Key::Escape);
        harness.run_steps(4);
    }
}

#[test]
fn the_space_bar_is_that_of_the_player_while_it_is_on_top() {
    let folder = examples();
    for number in 1..=3 {
        image::RgbImage::new(8, 6).save(folder.path().join(format!("shot.{number:04}.png"))).unwrap();
    }
    let mut harness = window(&folder, "letters_free", Vec::new());
    harness.run_steps(4);
    harness.state_mut().ask(Action::PlayFrames(folder.path().to_owned()));
    harness.run_steps(6);
    let plays = |harness: &Harness<App>| harness.state().session().playing;
    assert!(!plays(&harness));
    harness.key_press(Key::Space);
    harness.run_steps(4);
    assert!(!plays(&harness), "the time line plays behind the player");
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    assert!(harness.query_by_label("Player").is_none());
    harness.key_press(Key::Space);
    harness.run_steps(4);
    assert!(plays(&harness));
}
