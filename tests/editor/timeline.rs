//! The time line in a window without a screen: retiming, adding, scrubbing, spans.

use crate::window::Editor;
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lightloom::editor::action::Action;
use lightloom::editor::command::Command;
use lightloom::editor::selection::Selection;
use lightloom::editor::timeline::Timeline;
use lightloom_core::constraint::Constraint;

const PROJECT: &str = r#"{ "lightloom": 1, "name": "Time",
    "keys": [ { "frame": 1, "shows": { "image": { "file": "../assets/targets/letter_c.png" } } },
              { "frame": 21, "shows": { "image": { "file": "../assets/targets/star.png" } }, "ease": "in" },
              { "frame": 61, "shows": { "image": { "file": "../assets/targets/letter_s.png" } } } ],
    "constraints": [
        { "type": "directed_line", "points": [[0.1, 0.1], [0.4, 0.4]], "span": { "from": 10, "to": 30, "fade": 4 } },
        { "type": "wall", "points": [[0.5, 0.1], [0.5, 0.4]] },
        { "type": "wall", "points": [[0.6, 0.1], [0.6, 0.4]], "span": { "from": 25, "to": 55 } } ] }"#;

struct Window {
    editor: Editor,
    timeline: Timeline,
}

fn window() -> Harness<'static, Window> {
    let state = Window { editor: Editor::with_text(PROJECT), timeline: Timeline::default() };
    let mut harness =
        Harness::builder().with_size([1000.0, 280.0]).with_step_dt(0.02).with_max_steps(16).build_ui_state(
            |ui, window: &mut Window| {
                let ctx = ui.ctx().clone();
                let Window { editor, timeline } = window;
                egui::CentralPanel::default()
                    .show(ui, |ui| editor.frame(&ctx, |editor| timeline.show(ui, editor)));
            },
            state,
        );
    harness.run_ok();
    harness
}

fn centre(harness: &Harness<Window>, label: &str) -> Pos2 {
    harness.get_by_label_contains(label).rect().center()
}

/// Presses, moves in steps of a frame of the window, and lets go unless `hold`.
fn drag(harness: &mut Harness<Window>, from: Pos2, by: Vec2, hold: bool) {
    harness.hover_at(from);
    harness.step();
    harness.drag_at(from);
    harness.step();
    for i in 1..=8 {
        harness.hover_at(from + by * (i as f32 / 8.0));
        harness.step();
    }
    if !hold {
        harness.drop_at(from + by);
        harness.step();
    }
}

/// Points per frame, measured between two keys.
fn per_frame(harness: &Harness<Window>) -> f32 {
    (centre(harness, "Key frame at 61").x - centre(harness, "Key frame at 1,").x) / 60.0
}

#[test]
fn dragging_a_key_retimes_it_in_one_undo_step() {
    let mut harness = window();
    let (at, step) = (centre(&harness, "Key frame at 21"), per_frame(&harness));
    drag(&mut harness, at, Vec2::new(10.0 * step, 0.0), false);
    let editor = &mut harness.state_mut().editor;
    assert_eq!(editor.key_frames(), [1, 31, 61]);
    editor.document.undo();
    assert_eq!(editor.key_frames(), [1, 21, 61]);
    assert_eq!(editor.document.history().undoes(), None, "one step alone");
}

#[test]
fn a_key_cannot_pass_its_neighbours() {
    let mut harness = window();
    let at = centre(&harness, "Key frame at 21");
    drag(&mut harness, at, Vec2::new(900.0, 0.0), false);
    assert_eq!(harness.state().editor.key_frames(), [1, 60, 61]);
    let at = centre(&harness, "Key frame at 60");
    drag(&mut harness, at, Vec2::new(-900.0, 0.0), false);
    assert_eq!(harness.state().editor.key_frames(), [1, 2, 61]);
}

#[test]
fn escape_breaks_a_drag_off_and_leaves_nothing() {
    let mut harness = window();
    let at = centre(&harness, "Key frame at 21");
    drag(&mut harness, at, Vec2::new(90.0, 0.0), true);
    assert_ne!(harness.state().editor.key_frames(), [1, 21, 61]);
    harness.key_press(Key::Escape);
    harness.step();
    harness.hover_at(at + Vec2::new(200.0, 0.0));
    harness.step();
    harness.drop_at(at + Vec2::new(200.0, 0.0));
    harness.step();
    let editor = &harness.state().editor;
    assert_eq!(editor.key_frames(), [1, 21, 61]);
    assert_eq!(editor.document.history().undoes(), None);
}

#[test]
fn scrubbing_the_ruler_moves_the_playhead_and_changes_nothing() {
    let mut harness = window();
    let (from, step) = (centre(&harness, "Key frame at 1,"), per_frame(&harness));
    let ruler = harness.get_by_label("Time ruler").rect();
    drag(&mut harness, Pos2::new(from.x, ruler.center().y), Vec2::new(39.0 * step, 0.0), false);
    assert_eq!(harness.state().editor.session.playhead, 40);
    assert!(!harness.state().editor.document.is_unsaved());
}

#[test]
fn a_double_click_adds_a_key_and_the_menu_deletes_it() {
    let mut harness = window();
    let key = centre(&harness, "Key frame at 21");
    let place = key + Vec2::new(20.0 * per_frame(&harness), 0.0);
    for _ in 0..2 {
        for pressed in [true, false] {
            harness.event(Event::PointerMoved(place));
            harness.event(Event::PointerButton {
                pos: place,
                button: PointerButton::Primary,
                pressed,
                modifiers: Modifiers::NONE,
            });
        }
    }
    harness.run_ok();
    assert_eq!(harness.state().editor.key_frames(), [1, 21, 41, 61]);
    harness.get_by_label_contains("Key frame at 41").click_secondary();
    harness.run_ok();
    harness.get_by_role_and_label(Role::Button, "Delete").click();
    harness.run_ok();
    assert_eq!(harness.state().editor.key_frames(), [1, 21, 61]);
    harness.state_mut().editor.document.undo();
    assert_eq!(harness.state().editor.key_frames(), [1, 21, 41, 61]);
}

#[test]
fn the_menu_sets_the_easing() {
    let mut harness = window();
    harness.get_by_label_contains("Key frame at 1,").click_secondary();
    harness.run_ok();
    harness.get_by_label("Linear").click();
    harness.run_ok();
    let project = harness.state().editor.document.project().clone();
    assert_eq!(project.keys[0].ease, lightloom_core::project::Ease::Linear);
}

#[test]
fn the_ends_of_a_bar_retime_its_constraint_and_undo_takes_it_back() {
    let mut harness = window();
    let at = centre(&harness, "Line 1, last frame 30");
    let step = per_frame(&harness);
    drag(&mut harness, at, Vec2::new(10.0 * step, 0.0), false);
    let span = |harness: &Harness<Window>, i: usize| {
        harness.state().editor.document.project().constraints[i].span().copied()
    };
    let after = span(&harness, 0).unwrap();
    assert_eq!((after.from, after.to, after.fade), (10, 40, 4));
    harness.state_mut().editor.document.undo();
    assert_eq!(span(&harness, 0).unwrap().to, 30);
}

#[test]
fn a_selected_constraint_without_span_has_a_bar_that_gives_it_one() {
    let mut harness = window();
    assert!(harness.query_by_label_contains("Wall 2, always active").is_none());
    harness.state_mut().editor.session.selection = Selection::one(1);
    harness.run_ok();
    let at = centre(&harness, "Wall 2, first frame");
    let by = Vec2::new(9.0 * per_frame(&harness), 0.0);
    drag(&mut harness, at, by, false);
    let project = harness.state().editor.document.project().clone();
    let Constraint::Wall(wall) = &project.constraints[1] else { panic!("a wall") };
    let span = wall.span.unwrap();
    assert_eq!((span.from, span.to), (10, 61));
}

#[test]
fn every_transport_button_does_its_command() {
    let mut harness = window();
    for (name, frame) in [
        ("Last frame", 61),
        ("First frame", 1),
        ("Next frame", 2),
        ("Previous frame", 1),
        ("Next key frame", 21),
        ("Next key frame", 61),
        ("Previous key frame", 21),
    ] {
        harness.get_by_role_and_label(Role::Button, name).click();
        harness.run_ok();
        assert_eq!(harness.state().editor.session.playhead, frame, "{name}");
    }
    harness.get_by_role_and_label(Role::Button, "Loop").click();
    harness.run_ok();
    assert!(!harness.state().editor.session.looping);
    harness.get_by_role_and_label(Role::Button, "Play or pause").click();
    harness.run_ok();
    assert!(harness.state().editor.session.playing);
}

#[test]
fn marks_bound_what_is_played_and_never_cross() {
    let mut harness = window();
    let run = |harness: &mut Harness<Window>, frame: i32, command: Command| {
        let ctx = harness.ctx.clone();
        let editor = &mut harness.state_mut().editor;
        editor.session.playhead = frame;
        editor.frame(&ctx, |editor| editor.ask(Action::Command(command)));
    };
    run(&mut harness, 10, Command::MarkIn);
    run(&mut harness, 30, Command::MarkOut);
    assert_eq!(harness.state().editor.session.marks, [Some(10), Some(30)]);
    run(&mut harness, 40, Command::MarkIn);
    assert_eq!(harness.state().editor.session.marks, [Some(40), None]);
    run(&mut harness, 20, Command::ClearMarks);
    assert_eq!(harness.state().editor.session.marks, [None, None]);
}

#[test]
fn the_wheel_zooms_about_the_pointer() {
    let mut harness = window();
    let at = centre(&harness, "Key frame at 21");
    let before = per_frame(&harness);
    // Over the ruler, so that the tooltip of the key does not name it once more.
    harness.hover_at(Pos2::new(at.x, harness.get_by_label("Time ruler").rect().center().y));
    harness.step();
    harness.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: Vec2::new(0.0, 120.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    harness.run_ok();
    // The lane is wide enough that the key under the pointer is seen after zooming; the points are f32.
    assert!((centre(&harness, "Key frame at 21").x - at.x).abs() < 0.5);
    assert!(
        harness
            .query_by_label_contains("Key frame at 61")
            .is_none_or(|key| key.rect().center().x > at.x + 40.0 * before)
    );
}
