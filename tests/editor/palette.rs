//! Menus, keys, the palette and the sheet of shortcuts: each knows every command.

use std::path::Path;

use crate::window::Editor;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use lightloom::editor::action::Action;
use lightloom::editor::command::{COMMANDS, Command, CommandInfo, KeyPlace, Menu};
use lightloom::editor::document::Edit;
use lightloom::editor::look::object::SceneObject;
use lightloom::editor::menu::Recent;
use lightloom::editor::palette::{Palette, items};
use lightloom::editor::selection::Selection;
use lightloom::editor::shortcuts::{self, ShortcutSheet};
use lightloom::editor::templates::TEMPLATES;
use lightloom::editor::tour::{Anchors, Tour};
use lightloom::editor::welcome::Welcome;
use lightloom::editor::{keyboard, menu, tools};
use lightloom_core::constraint::Constraint;
use lightloom_core::project::Project;
use lightloom_core::scene::CameraDesc;

fn tool_keys() -> Vec<(&'static str, Key)> {
    tools::all().iter().map(|tool| (tool.info().name, tool.info().key)).collect()
}

/// An editor in which every command would do something.
fn busy_editor() -> Editor {
    let project =
        Project::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("projects/bottles.json")).unwrap();
    let mut editor = Editor::with_project(project);
    for name in ["one", "two"] {
        editor.document.edit(Edit::Name(name.into())).unwrap();
        editor.document.settle();
    }
    editor.document.undo();
    editor.session.selection = Selection::one(0);
    editor.session.marks = [Some(3), None];
    editor.session.focus.object = Some(SceneObject::Light(0));
    editor.session.free_camera = Some(CameraDesc::default());
    editor
}

#[test]
fn the_palette_finds_the_theme() {
    let mut editor = busy_editor();
    let mut actions = Vec::new();
    let all = items(&editor.context(&mut actions), &tool_keys(), &[]);
    for (words, command) in [
        ("Dark theme", Command::DarkTheme),
        ("Light theme", Command::LightTheme),
        ("Preferences: Theme", Command::Preferences),
        ("Preferences: Preview memory", Command::Preferences),
    ] {
        let found = all.iter().find(|item| item.name == words).map(|item| &item.action);
        assert_eq!(found, Some(&Action::Command(command)), "{words}");
    }
}

fn harness<S: 'static>(state: S, show: impl FnMut(&mut egui::Ui, &mut S) + 'static) -> Harness<'static, S> {
    let builder = Harness::builder().with_size([1000.0, 900.0]).with_step_dt(0.02).with_max_steps(32);
    let mut harness = builder.build_ui_state(show, state);
    harness.run_ok();
    harness
}

#[test]
fn the_palette_finds_and_runs_every_command() {
    type State = (Editor, Palette, Option<Action>);
    let state: State = (busy_editor(), Palette::default(), None);
    let mut harness = harness(state, |ui, (editor, palette, chosen): &mut State| {
        let ctx = ui.ctx().clone();
        let tools = tool_keys();
        if let Some(action) = editor.frame(&ctx, |editor| palette.show(&ctx, || items(editor, &tools, &[]))) {
            *chosen = Some(action);
        }
    });
    for CommandInfo { command, name, .. } in COMMANDS {
        harness.state_mut().1.open();
        harness.run_ok();
        harness.get_by_label("Find a command").type_text(name);
        harness.run_ok();
        harness.key_press(Key::Enter);
        harness.run_ok();
        assert_eq!(harness.state_mut().2.take(), Some(Action::Command(*command)), "{name}");
        assert!(!harness.state().1.is_open());
    }
    // Tools, panels and examples are found by some of their letters; arrows choose.
    harness.state_mut().1.open();
    harness.run_ok();
    harness.get_by_label("Find a command").type_text("dkgls");
    harness.run_ok();
    harness.key_press(Key::Enter);
    harness.run_ok();
    let glass = TEMPLATES.iter().position(|template| template.name == "Dark glass").unwrap();
    assert_eq!(harness.state_mut().2.take(), Some(Action::New(glass)));
    harness.state_mut().1.open();
    harness.run_ok();
    harness.key_press(Key::ArrowDown);
    harness.run_ok();
    harness.key_press(Key::Enter);
    harness.run_ok();
    assert_eq!(harness.state_mut().2.take(), Some(Action::Command(COMMANDS[1].command)));
    harness.state_mut().1.open();
    harness.run_ok();
    harness.key_press(Key::Escape);
    harness.run_ok();
    assert!(!harness.state().1.is_open() && harness.state().2.is_none());
}

#[test]
fn every_command_is_in_its_menu_and_can_be_called_there() {
    let recent = [Recent { path: "/tmp/one.json".into(), is_there: false }];
    for CommandInfo { command, menu, name, .. } in COMMANDS {
        let recent = recent.clone();
        let mut harness = harness(busy_editor(), move |ui, editor: &mut Editor| {
            let ctx = ui.ctx().clone();
            editor.frame(&ctx, |editor| menu::show(ui, editor, &recent, &[]));
        });
        harness.get_by_role_and_label(Role::Button, shortcuts::group(*menu)).click();
        harness.run_ok();
        // Undo and redo say more than their name; an item's label ends with its key.
        let item = harness.get_all_by_label_contains(name).find(|item| {
            let label = item.accesskit_node().label().unwrap_or_default();
            label.starts_with(name) && (*menu != Menu::File || !label.contains("as…") || name.contains("as…"))
        });
        item.unwrap_or_else(|| panic!("{name} is in its menu")).click();
        harness.run_ok();
        assert_eq!(harness.state().asked.last(), Some(&Action::Command(*command)), "{name}");
    }
}

#[test]
fn the_sheet_names_every_shortcut_and_can_be_searched() {
    let mut harness = harness(
        {
            let mut s = ShortcutSheet::default();
            s.open = true;
            s
        },
        |ui, sheet: &mut ShortcutSheet| {
            sheet.show(ui.ctx(), &tool_keys());
        },
    );
    let lines = shortcuts::lines(&tool_keys());
    for entry in COMMANDS {
        let Some(shortcut) = &entry.shortcut else { continue };
        let key = shortcuts::words(shortcut);
        assert!(lines.iter().any(|line| line.name == entry.name && line.key == key), "{}", entry.name);
        assert!(harness.query_all_by_label(entry.name).next().is_some(), "{} is on the sheet", entry.name);
    }
    for (name, _) in tool_keys() {
        assert!(harness.query_all_by_label(name).next().is_some(), "{name} is on the sheet");
    }
    harness.get_by_label("Search shortcuts").focus();
    harness.run_ok();
    harness.get_by_label("Search shortcuts").type_text("play or");
    harness.run_ok();
    assert!(harness.query_by_label("Play or pause").is_some() && harness.query_by_label("Undo").is_none());
}

#[test]
fn space_plays_and_pauses_but_not_while_text_is_typed() {
    type State = (Editor, String);
    let mut harness = harness((busy_editor(), String::new()), |ui, (editor, text): &mut State| {
        let ctx = ui.ctx().clone();
        let pressed = keyboard::pressed(&ctx, &tool_keys(), (false, false), KeyPlace::Everywhere);
        editor.frame(&ctx, |editor| editor.actions.extend(pressed));
        ui.text_edit_singleline(text).accessible_name("Text");
    });
    for playing in [true, false] {
        harness.key_press(Key::Space);
        harness.run_ok();
        assert_eq!(harness.state().0.session.playing, playing);
    }
    harness.get_by_label("Text").focus();
    harness.run_ok();
    harness.key_press(Key::Space);
    harness.key_press(Key::W);
    harness.run_ok();
    assert!(!harness.state().0.session.playing);
    assert!(!harness.state().0.asked.iter().any(|action| matches!(action, Action::Tool(_))));
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_ok();
    assert!(harness.state().0.asked.contains(&Action::Command(Command::Save)));
}

#[test]
fn no_tool_takes_the_key_of_a_command() {
    for (name, key) in tool_keys() {
        let taken = COMMANDS.iter().filter(|entry| entry.keys == KeyPlace::Everywhere).find(|entry| {
            entry.shortcut.is_some_and(|shortcut| shortcut.logical_key == key && shortcut.modifiers.is_none())
        });
        assert!(taken.is_none(), "{name} has the key of {}", taken.unwrap().name);
    }
}

#[test]
fn the_first_steps_end_for_good_when_they_were_done() {
    type State = (Editor, Tour, bool);
    let mut editor = busy_editor();
    let mut tour = Tour::default();
    tour.begin(editor.document.project());
    editor.session.playing = false;
    let square = |x: f32, y: f32| egui::Rect::from_center_size(egui::pos2(x, y), egui::vec2(28.0, 28.0));
    let anchors = Anchors {
        line: square(20.0, 100.0),
        wall: square(20.0, 140.0),
        play: square(200.0, 700.0),
        plane: egui::Rect::from_min_max(egui::pos2(50.0, 30.0), egui::pos2(900.0, 600.0)),
    };
    let mut harness = harness((editor, tour, false), move |ui, (editor, tour, ended): &mut State| {
        *ended |= tour.show(ui.ctx(), &anchors, &editor.document.project().clone(), &editor.session);
    });
    let draw = |harness: &mut Harness<State>, wanted: fn(&Constraint) -> bool| {
        let document = &mut harness.state_mut().0.document;
        let more = document.project().constraints.iter().find(|c| wanted(c)).unwrap().clone();
        document.edit(Edit::Add(vec![more])).unwrap();
        harness.run_ok();
    };
    assert!(harness.query_by_label("Draw a line").is_some());
    draw(&mut harness, |c| matches!(c, Constraint::Wall(_)));
    assert!(harness.query_by_label("Draw a line").is_some(), "a wall is no line");
    draw(&mut harness, |c| matches!(c, Constraint::DirectedLine(_)));
    assert!(harness.query_by_label("Draw a wall").is_some());
    harness.get_by_label("Next").click();
    harness.run_ok();
    assert!(harness.query_by_label("Press play").is_some() && !harness.state().2);
    harness.state_mut().0.session.playing = true;
    harness.run_ok();
    assert!(harness.state().2 && !harness.state().1.is_open());
}

#[test]
fn an_example_is_chosen_by_its_picture() {
    type State = (Welcome, Option<Action>);
    let state: State = (Welcome::default(), None);
    let mut harness = harness(state, |ui, (welcome, chosen): &mut State| {
        if let Some(action) = welcome.show(ui.ctx(), &[]) {
            *chosen = Some(action);
        }
    });
    harness.state_mut().0.open = true;
    harness.run_ok();
    harness.get_by_role_and_label(Role::Button, "Rabbit").click();
    harness.run_ok();
    assert_eq!(harness.state().1, Some(Action::New(4)));
    assert!(!harness.state().0.open);
}
