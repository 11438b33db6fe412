//! The plane view with its tools, driven like the window drives them, without a window.

use crate::window::Editor;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lightloom::editor::action::Action;
use lightloom::editor::canvas::{self, Backdrop};
use lightloom::editor::document::Edit;
use lightloom::editor::tools::{Toolbox, toolbar};
use lightloom_core::constraint::Constraint;

/// A window with nothing but the plane and its tools.
struct Window {
    editor: Editor,
    toolbox: Toolbox,
}

fn window() -> Harness<'static, Window> {
    let text = r#"{ "lightloom": 1, "keys": [ { "frame": 1, "shows": { "image": { "file": "a.png" } } },
        { "frame": 60, "shows": { "image": { "file": "b.png" } } } ] }"#;
    let window = Window { editor: Editor::with_text(text), toolbox: Toolbox::default() };
    let show = |ui: &mut egui::Ui, Window { editor, toolbox }: &mut Window| {
        let ctx = ui.ctx().clone();
        editor.frame(&ctx, |editor| {
            egui::Panel::left("bar").exact_size(toolbar::WIDTH).resizable(false).show(ui, |ui| {
                toolbar::show(ui, editor, toolbox);
            });
            egui::CentralPanel::no_frame().show(ui, |ui| {
                canvas::show(ui, editor, toolbox, &Backdrop::default());
            });
        });
    };
    let mut harness = Harness::builder().with_size(vec2(800.0, 600.0)).build_ui_state(show, window);
    harness.run();
    harness
}

/// A place of the plane view, as shares of its width and height from its upper left corner.
fn at(harness: &Harness<Window>, x: f32, y: f32) -> Pos2 {
    let rect = harness.get_by_label("Plane").rect();
    pos2(rect.left() + x * rect.width(), rect.top() + y * rect.height())
}

fn button(harness: &Harness<Window>, pos: Pos2, button: PointerButton, pressed: bool) {
    harness.event(Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE });
}

fn drag(harness: &mut Harness<Window>, with: PointerButton, from: Pos2, to: Pos2) {
    harness.event(Event::PointerMoved(from));
    button(harness, from, with, true);
    for i in 1..=20 {
        harness.event(Event::PointerMoved(from.lerp(to, i as f32 / 20.0)));
    }
    button(harness, to, with, false);
    harness.run_steps(2);
}

fn take(harness: &mut Harness<Window>, name: &str) {
    harness.get_by_label(name).click();
    harness.run();
}

fn constraints<'a>(harness: &'a Harness<Window>) -> &'a [Constraint] {
    &harness.state().editor.document.project().constraints
}

#[test]
fn a_drag_over_the_plane_with_the_wall_tool_draws_a_wall() {
    let mut harness = window();
    take(&mut harness, "Wall");
    let (from, to) = (at(&harness, 0.4, 0.3), at(&harness, 0.6, 0.7));
    drag(&mut harness, PointerButton::Primary, from, to);
    let added = |action: &Action| matches!(action, Action::Edit(Edit::Add(walls)) if walls.len() == 1);
    assert!(harness.state().editor.asked.iter().any(added), "{:?}", harness.state().editor.asked);
    let [Constraint::Wall(wall)] = constraints(&harness) else { panic!("{:?}", constraints(&harness)) };
    assert_eq!(wall.points.len(), 2);
    assert!(harness.state().editor.session.selection.is_whole(0));
}

#[test]
fn clicks_and_enter_draw_a_line_point_by_point() {
    let mut harness = window();
    take(&mut harness, "Directed line");
    for (x, y) in [(0.4, 0.4), (0.5, 0.6), (0.6, 0.4)] {
        let pos = at(&harness, x, y);
        drag(&mut harness, PointerButton::Primary, pos, pos);
        harness.run_steps(3);
    }
    assert!(constraints(&harness).is_empty());
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    assert_eq!(constraints(&harness)[0].points().len(), 3);
}

#[test]
fn escape_and_another_tool_leave_nothing_of_a_line_begun() {
    let mut harness = window();
    for escapes in [true, false] {
        take(&mut harness, "Directed line");
        let pos = at(&harness, 0.4, 0.4);
        drag(&mut harness, PointerButton::Primary, pos, pos);
        assert!(harness.state().toolbox.tool().is_busy());
        if escapes {
            harness.key_press(Key::Escape);
            harness.run_steps(2);
        } else {
            take(&mut harness, "Select");
        }
        harness.key_press(Key::Enter);
        harness.run_steps(2);
        assert!(constraints(&harness).is_empty() && !harness.state().toolbox.tool().is_busy());
    }
}

#[test]
fn middle_button_pan_tool_and_space_move_the_view_and_draw_nothing() {
    let mut harness = window();
    let (from, to) = (at(&harness, 0.5, 0.5), at(&harness, 0.6, 0.5));
    let centre = |harness: &Harness<Window>| harness.state().editor.session.plane.centre.unwrap_or_default();
    take(&mut harness, "Wall");
    drag(&mut harness, PointerButton::Middle, from, to);
    let first = centre(&harness);
    assert!(first.x < 0.5 && (first.y - 0.5).abs() < 1e-5, "{first}");
    harness.key_down(Key::Space);
    drag(&mut harness, PointerButton::Primary, from, to);
    harness.key_up(Key::Space);
    harness.run_steps(1);
    let second = centre(&harness);
    take(&mut harness, "Pan");
    drag(&mut harness, PointerButton::Primary, from, to);
    let third = centre(&harness);
    // Equal drags move the view by equal ways: f32 on a screen of a thousand points.
    assert!((second.x - third.x - (first.x - second.x)).abs() < 1e-4 && second.x < first.x);
    assert!(constraints(&harness).is_empty());
}

#[test]
fn the_wheel_zooms_about_the_pointer() {
    let mut harness = window();
    let pos = at(&harness, 0.7, 0.4);
    harness.event(Event::PointerMoved(pos));
    harness.run_steps(1);
    harness.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: vec2(0.0, 3.0),
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
        source: egui::MouseWheelSource::Wheel,
    });
    harness.run_steps(12);
    assert!(harness.state().editor.session.plane.zoom > 1.1, "{:?}", harness.state().editor.session.plane);
}

#[test]
fn every_tool_stands_in_the_bar() {
    let mut harness = window();
    let tools: Vec<_> = harness.state().toolbox.tools().map(|tool| tool.info().name.to_owned()).collect();
    assert_eq!(tools.len(), 8);
    for (i, name) in tools.iter().enumerate() {
        take(&mut harness, name);
        assert_eq!(harness.state().editor.session.tool, i, "{name}");
    }
}
