//! Selecting, moving, setting and removing points.

use super::*;

fn two() -> Vec<Constraint> {
    vec![line(&[[0.1, 0.2], [0.5, 0.2], [0.9, 0.2]]), wall(&[[0.1, 0.8], [0.9, 0.8]])]
}

#[test]
fn clicks_select_shift_adds_alt_takes_out_and_the_ground_clears() {
    let mut studio = Studio::new("Select", two());
    studio.click(vec2(0.3, 0.202));
    assert_eq!(studio.session.selection, Selection::one(0));
    studio.held.shift = true;
    studio.click(vec2(0.3, 0.795));
    assert_eq!(studio.session.selection, Selection::all([0, 1]));
    studio.held = HeldKeys { alt: true, ..HeldKeys::default() };
    studio.click(vec2(0.3, 0.2));
    assert_eq!(studio.session.selection, Selection::one(1));
    studio.held = HeldKeys::default();
    studio.click(vec2(0.5, 0.5));
    assert!(studio.session.selection.is_empty());
    assert_eq!(studio.steps(), 0);
}

#[test]
fn a_box_selects_wholes_and_points() {
    let mut studio = Studio::new("Select", two());
    studio.drag(&way(vec2(0.4, 0.1), vec2(0.95, 0.9), 4));
    let mut expected = Selection::some(0, [1, 2]);
    expected.extend(&Selection::point(1, 1));
    assert_eq!(studio.session.selection, expected);
    studio.held.shift = true;
    studio.drag(&way(vec2(0.02, 0.1), vec2(0.95, 0.3), 4));
    assert!(studio.session.selection.is_whole(0) && !studio.session.selection.is_whole(1));
    studio.held = HeldKeys { alt: true, ..HeldKeys::default() };
    studio.drag(&way(vec2(0.02, 0.1), vec2(0.3, 0.3), 4));
    assert_eq!(studio.session.selection.points(0).collect::<Vec<_>>(), [1, 2]);
}

#[test]
fn dragging_moves_the_whole_in_one_step_and_escape_takes_it_back() {
    let mut studio = Studio::new("Select", two());
    let before = studio.points(0);
    studio.drag(&way(vec2(0.3, 0.2), vec2(0.35, 0.33), 12));
    let moved: Vec<Vec2> = before.iter().map(|p| *p + vec2(0.05, 0.13)).collect();
    // Sums of f32 below 1.
    assert!(studio.points(0).iter().zip(&moved).all(|(a, b)| a.distance(*b) < 1e-6));
    assert_eq!(studio.steps(), 1);
    studio.press_and_drag(&way(vec2(0.35, 0.33), vec2(0.6, 0.6), 12));
    studio.key(Key::Escape);
    studio.gesture(Gesture::Release(vec2(0.6, 0.6)));
    assert!(studio.points(0).iter().zip(&moved).all(|(a, b)| a.distance(*b) < 1e-6));
    assert_eq!(studio.steps(), 1);
}

#[test]
fn a_point_of_what_is_selected_moves_alone_and_snaps() {
    let mut studio = Studio::new("Select", two());
    studio.click(vec2(0.3, 0.2));
    studio.drag(&way(vec2(0.501, 0.201), vec2(0.102, 0.797), 12));
    let expected = [vec2(0.1, 0.2), vec2(0.1, 0.8), vec2(0.9, 0.2)];
    // Sums of f32 below 1.
    assert!(studio.points(0).iter().zip(expected).all(|(a, b)| a.distance(b) < 1e-6));
    assert_eq!(studio.session.selection, Selection::point(0, 1));
}

#[test]
fn a_double_click_sets_a_point_and_delete_removes_it() {
    let mut studio = Studio::new("Select", two());
    studio.double_click(vec2(0.7, 0.203));
    assert_eq!(studio.points(0).len(), 4);
    assert!(studio.points(0)[2].distance(vec2(0.7, 0.2)) < 1e-6);
    assert_eq!(studio.session.selection, Selection::point(0, 2));
    studio.key(Key::Delete);
    assert_eq!(studio.points(0), [vec2(0.1, 0.2), vec2(0.5, 0.2), vec2(0.9, 0.2)]);
    studio.session.selection = Selection::point(1, 0);
    studio.key(Key::Delete);
    assert_eq!(studio.constraints().len(), 1, "one point is no wall");
}

#[test]
fn arrows_nudge_by_a_point_of_the_screen_and_with_shift_by_ten() {
    let mut studio = Studio::new("Select", two());
    studio.session.selection = Selection::point(0, 0);
    studio.key(Key::ArrowUp);
    studio.held.shift = true;
    studio.key(Key::ArrowLeft);
    let expected = vec2(0.1 - 10.0 * PER_POINT, 0.2 + PER_POINT);
    assert!(studio.points(0)[0].distance(expected) < 1e-6);
    assert_eq!(studio.points(0)[1], vec2(0.5, 0.2));
    assert_eq!(studio.steps(), 2);
}

#[test]
fn nothing_moves_off_the_drawing() {
    let mut studio = Studio::new("Select", vec![line(&[[9.0, 0.0], [9.9, 0.5]])]);
    studio.session.selection = Selection::one(0);
    studio.arrange(|project, selection| arrange::nudge(project, selection, vec2(5.0, 1.0)));
    assert!(studio.points(0)[1].distance(vec2(10.0, 1.5)) < 1e-5);
    // Its shape is as it was.
    assert!((studio.points(0)[1] - studio.points(0)[0]).distance(vec2(0.9, 0.5)) < 1e-5);
}

#[test]
fn escape_clears_the_selection() {
    let mut studio = Studio::new("Select", two());
    studio.click(vec2(0.3, 0.2));
    studio.key(Key::Escape);
    assert!(studio.session.selection.is_empty());
}

#[test]
fn hidden_drawings_are_not_hit() {
    let mut studio = Studio::new("Select", two());
    studio.session.overlays.drawn = false;
    studio.click(vec2(0.3, 0.2));
    assert!(studio.session.selection.is_empty());
}
