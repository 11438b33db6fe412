//! Selecting, moving, setting and removing points.

use super::*;

fn two() -> Vec<Constraint> {
    vec![line(&[[0.1, 0.2], [0.5, 0.2], [0.9, 0.2]]), wall(&[[0.1, 0.8], [0.9, 0.8]])]
}

#[test]
fn clicks_select_shift_adds_alt_takes_out_and_the_ground_clears() {
    let mut harness = ToolHarness::new("Select", two());
    harness.click(vec2(0.3, 0.202));
    assert_eq!(harness.session.selection, Selection::one(0));
    harness.held.shift = true;
    harness.click(vec2(0.3, 0.795));
    assert_eq!(harness.session.selection, Selection::all([0, 1]));
    harness.held = HeldKeys { alt: true, ..HeldKeys::default() };
    harness.click(vec2(0.3, 0.2));
    assert_eq!(harness.session.selection, Selection::one(1));
    harness.held = HeldKeys::default();
    harness.click(vec2(0.5, 0.5));
    assert!(harness.session.selection.is_empty());
    assert_eq!(harness.steps(), 0);
}

#[test]
fn a_box_selects_wholes_and_points() {
    let mut harness = ToolHarness::new("Select", two());
    harness.drag(&path(vec2(0.4, 0.1), vec2(0.95, 0.9), 4));
    let mut expected = Selection::some(0, [1, 2]);
    expected.extend(&Selection::point(1, 1));
    assert_eq!(harness.session.selection, expected);
    harness.held.shift = true;
    harness.drag(&path(vec2(0.02, 0.1), vec2(0.95, 0.3), 4));
    assert!(harness.session.selection.is_whole(0) && !harness.session.selection.is_whole(1));
    harness.held = HeldKeys { alt: true, ..HeldKeys::default() };
    harness.drag(&path(vec2(0.02, 0.1), vec2(0.3, 0.3), 4));
    assert_eq!(harness.session.selection.points(0).collect::<Vec<_>>(), [1, 2]);
}

#[test]
fn dragging_moves_the_whole_in_one_step_and_escape_takes_it_back() {
    let mut harness = ToolHarness::new("Select", two());
    let before = harness.points(0);
    harness.drag(&path(vec2(0.3, 0.2), vec2(0.35, 0.33), 12));
    let moved: Vec<Vec2> = before.iter().map(|p| *p + vec2(0.05, 0.13)).collect();
    // Sums of f32 below 1.
    assert!(harness.points(0).iter().zip(&moved).all(|(a, b)| a.distance(*b) < 1e-6));
    assert_eq!(harness.steps(), 1);
    harness.press_and_drag(&path(vec2(0.35, 0.33), vec2(0.6, 0.6), 12));
    harness.key(Key::Escape);
    harness.gesture(Gesture::Release(vec2(0.6, 0.6)));
    assert!(harness.points(0).iter().zip(&moved).all(|(a, b)| a.distance(*b) < 1e-6));
    assert_eq!(harness.steps(), 1);
}

#[test]
fn a_point_of_what_is_selected_moves_alone_and_snaps() {
    let mut harness = ToolHarness::new("Select", two());
    harness.click(vec2(0.3, 0.2));
    harness.drag(&path(vec2(0.501, 0.201), vec2(0.102, 0.797), 12));
    let expected = [vec2(0.1, 0.2), vec2(0.1, 0.8), vec2(0.9, 0.2)];
    // Sums of f32 below 1.
    assert!(harness.points(0).iter().zip(expected).all(|(a, b)| a.distance(b) < 1e-6));
    assert_eq!(harness.session.selection, Selection::point(0, 1));
}

#[test]
fn a_double_click_sets_a_point_and_delete_removes_it() {
    let mut harness = ToolHarness::new("Select", two());
    harness.double_click(vec2(0.7, 0.203));
    assert_eq!(harness.points(0).len(), 4);
    assert!(harness.points(0)[2].distance(vec2(0.7, 0.2)) < 1e-6);
    assert_eq!(harness.session.selection, Selection::point(0, 2));
    harness.key(Key::Delete);
    assert_eq!(harness.points(0), [vec2(0.1, 0.2), vec2(0.5, 0.2), vec2(0.9, 0.2)]);
    harness.session.selection = Selection::point(1, 0);
    harness.key(Key::Delete);
    assert_eq!(harness.constraints().len(), 1, "one point is no wall");
}

#[test]
fn arrows_nudge_by_a_point_of_the_screen_and_with_shift_by_ten() {
    let mut harness = ToolHarness::new("Select", two());
    harness.session.selection = Selection::point(0, 0);
    harness.key(Key::ArrowUp);
    harness.held.shift = true;
    harness.key(Key::ArrowLeft);
    let expected = vec2(0.1 - 10.0 * PER_POINT, 0.2 + PER_POINT);
    assert!(harness.points(0)[0].distance(expected) < 1e-6);
    assert_eq!(harness.points(0)[1], vec2(0.5, 0.2));
    assert_eq!(harness.steps(), 2);
}

#[test]
fn nothing_moves_off_the_drawing() {
    let mut harness = ToolHarness::new("Select", vec![line(&[[9.0, 0.0], [9.9, 0.5]])]);
    harness.session.selection = Selection::one(0);
    harness.arrange(|project, selection| arrange::nudge(project, selection, vec2(5.0, 1.0)));
    assert!(harness.points(0)[1].distance(vec2(10.0, 1.5)) < 1e-5);
    // Its shape is as it was.
    assert!((harness.points(0)[1] - harness.points(0)[0]).distance(vec2(0.9, 0.5)) < 1e-5);
}

#[test]
fn escape_clears_the_selection() {
    let mut harness = ToolHarness::new("Select", two());
    harness.click(vec2(0.3, 0.2));
    harness.key(Key::Escape);
    assert!(harness.session.selection.is_empty());
}

#[test]
fn hidden_drawings_are_not_hit() {
    let mut harness = ToolHarness::new("Select", two());
    harness.session.overlays.drawn = false;
    harness.click(vec2(0.3, 0.2));
    assert!(harness.session.selection.is_empty());
}
