//! The eraser.

use super::*;

#[test]
fn a_stroke_splits_what_it_crosses_in_one_step() {
    let mut harness =
        ToolHarness::new("Erase", vec![line(&[[0.1, 0.5], [0.9, 0.5]]), wall(&[[0.1, 0.9], [0.9, 0.9]])]);
    harness.drag(&path(vec2(0.4, 0.4), vec2(0.4, 0.6), 8));
    assert_eq!(harness.constraints().len(), 3);
    assert!(harness.points(0).iter().chain(&harness.points(1)).all(|p| (p.x - 0.4).abs() > 0.008));
    assert_eq!(harness.points(2), [vec2(0.1, 0.9), vec2(0.9, 0.9)]);
    assert_eq!(harness.steps(), 1);
}

#[test]
fn nothing_between_two_moves_of_the_pointer_is_passed_over() {
    let mut harness = ToolHarness::new("Erase", vec![line(&[[0.1, 0.5], [0.9, 0.5]])]);
    harness.drag(&[vec2(0.3, 0.505), vec2(0.7, 0.505)]);
    let left: f32 = (0..2).map(|i| stroke::length(&harness.points(i))).sum();
    // The eraser reaches 9 points around the path of 0.4.
    assert!((0.38..0.4).contains(&left), "{left}");
}

#[test]
fn escape_brings_back_what_the_stroke_took() {
    let mut harness = ToolHarness::new("Erase", vec![line(&[[0.1, 0.5], [0.9, 0.5]])]);
    let before = harness.document.project().clone();
    harness.press_and_drag(&path(vec2(0.2, 0.5), vec2(0.6, 0.5), 8));
    assert_ne!(before, *harness.document.project());
    harness.key(Key::Escape);
    harness.gesture(Gesture::Release(vec2(0.6, 0.5)));
    assert_eq!(before, *harness.document.project());
    assert_eq!(harness.steps(), 0);
}

#[test]
fn the_way_over_bare_ground_is_no_step() {
    let mut harness = ToolHarness::new("Erase", vec![line(&[[0.1, 0.5], [0.9, 0.5]])]);
    harness.drag(&path(vec2(0.2, 0.1), vec2(0.6, 0.2), 8));
    assert_eq!(harness.steps(), 0);
}
