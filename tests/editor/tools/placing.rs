//! Placing the target's picture.

use super::*;

/// Centre, width and turn of the picture of the second key.
fn placed(harness: &ToolHarness) -> (Vec2, f32, f32) {
    let Shows::Image(image) = &harness.document.project().keys[1].shows else { panic!() };
    let placement = &image.placement;
    (placement.centre.unwrap().into(), placement.width.unwrap(), placement.rotate)
}

fn harness() -> ToolHarness {
    let mut harness = ToolHarness::new("Place target", Vec::new());
    harness.session.playhead = 20;
    harness.session.snapping = false;
    harness
}

#[test]
fn the_picture_of_the_next_key_moves_with_the_pointer_in_one_step() {
    let mut harness = harness();
    harness.drag(&path(vec2(0.5, 0.5), vec2(0.6, 0.4), 9));
    let (centre, width, rotate) = placed(&harness);
    // By default a picture of two to one fills 0.9 of the width.
    assert!(centre.distance(vec2(0.6, 0.4)) < 1e-5 && (width - 0.9).abs() < 1e-5 && rotate == 0.0);
    assert_eq!(harness.steps(), 1);
    let Shows::Image(first) = &harness.document.project().keys[0].shows else { panic!() };
    assert_eq!(first.placement.centre, None);
}

#[test]
fn a_corner_scales_about_the_opposite_one_and_with_alt_about_the_middle() {
    let mut harness = harness();
    harness.drag(&path(vec2(0.95, 0.725), vec2(0.5, 0.5), 9));
    let (centre, width, _) = placed(&harness);
    assert!((width - 0.45).abs() < 1e-5 && (centre - vec2(0.275, 0.3875)).length() < 1e-5, "{centre}");
    harness.held.alt = true;
    harness.drag(&path(vec2(0.5, 0.5), vec2(0.725, 0.6125), 9));
    let (same, width, _) = placed(&harness);
    assert!(same.distance(centre) < 1e-5 && (width - 0.9).abs() < 1e-5);
}

#[test]
fn the_knob_turns_and_shift_keeps_to_fifteen_degrees() {
    let mut harness = harness();
    let knob = vec2(0.5, 0.5 + 0.225 + 28.0 * PER_POINT);
    harness.held.shift = true;
    harness.drag(&path(knob, vec2(0.2, 0.52), 9));
    let (centre, width, rotate) = placed(&harness);
    assert!((rotate - 90.0).abs() < 1e-3, "{rotate}");
    assert!(centre.distance(vec2(0.5, 0.5)) < 1e-5 && (width - 0.9).abs() < 1e-4);
}

#[test]
fn escape_brings_the_picture_back_and_a_double_click_fits_it() {
    let mut harness = harness();
    let before = harness.document.project().clone();
    harness.press_and_drag(&path(vec2(0.5, 0.5), vec2(0.6, 0.4), 9));
    harness.key(Key::Escape);
    harness.gesture(Gesture::Release(vec2(0.6, 0.4)));
    assert_eq!(before, *harness.document.project());
    harness.drag(&path(vec2(0.5, 0.5), vec2(0.6, 0.4), 9));
    harness.double_click(vec2(0.6, 0.4));
    assert_eq!(*before, **harness.document.project());
}

#[test]
fn the_caustic_in_focus_places_its_own_picture() {
    let text = r#"{ "lightloom": 1, "scene": {}, "caustics": [ { "name": "left" } ], "keys": [ { "frame": 1,
        "shows": { "image": { "file": "a.png" } },
        "caustics": { "left": { "shows": { "image": { "file": "b.png" } } } } } ] }"#;
    let mut harness = harness();
    harness.document = lightloom::editor::document::Document::new(serde_json::from_str(text).unwrap(), None);
    harness.session.focus.caustic = Some(0);
    harness.drag(&path(vec2(0.5, 0.5), vec2(0.6, 0.4), 9));
    let key = &harness.document.project().keys[0];
    let centre = |shows: &Shows| match shows {
        Shows::Image(image) => image.placement.centre,
        _ => panic!(),
    };
    assert_eq!(centre(&key.shows), None);
    assert!(centre(key.shown_by(Some("left"))).is_some());
}

#[test]
fn where_no_picture_is_shown_the_tool_says_so() {
    let mut harness = harness();
    let text =
        r#"{ "lightloom": 1, "keys": [ { "frame": 1, "shows": { "points": { "file": "a.csv" } } } ] }"#;
    harness.document = lightloom::editor::document::Document::new(serde_json::from_str(text).unwrap(), None);
    harness.drag(&path(vec2(0.5, 0.5), vec2(0.6, 0.4), 9));
    assert_eq!((harness.said(), harness.steps()), (1, 0));
}
