//! Directed lines and walls, freehand and point by point.

use super::*;

#[test]
fn a_freehand_line_keeps_few_points_near_the_hand() {
    let mut harness = ToolHarness::new("Directed line", Vec::new());
    let hand: Vec<Vec2> = (0..400)
        .map(|i| {
            let x = 0.1 + 0.002 * i as f32;
            vec2(x, 0.5 + 0.2 * (8.0 * x).sin() + 0.0004 * (i as f32 * 1.7).sin())
        })
        .collect();
    harness.drag(&hand);
    let drawn = harness.points(0);
    assert!(matches!(harness.constraints(), [Constraint::DirectedLine(_)]));
    assert!((4..45).contains(&drawn.len()), "{} points", drawn.len());
    // Two points of the screen: what the fit promises.
    assert!(stray(&hand, &drawn) <= 2.0 * PER_POINT);
    assert!(drawn[0].distance(hand[0]) < 1e-6 && drawn[drawn.len() - 1].distance(hand[399]) < 1e-6);
    assert_eq!(harness.steps(), 1);
    assert_eq!(harness.session.selection, Selection::one(0));
}

#[test]
fn a_freehand_wall_closes_where_it_comes_back() {
    let mut harness = ToolHarness::new("Wall", Vec::new());
    let circle: Vec<Vec2> =
        (0..=100).map(|i| vec2(0.5, 0.5) + Vec2::from_angle(0.0626 * i as f32) * 0.2).collect();
    harness.drag(&circle);
    let points = harness.points(0);
    assert_eq!(points[0], points[points.len() - 1]);
    assert!(points.len() > 8);
}

#[test]
fn clicks_set_points_backspace_takes_the_last_back_and_enter_ends() {
    let mut harness = ToolHarness::new("Directed line", Vec::new());
    for p in [vec2(0.2, 0.2), vec2(0.4, 0.3), vec2(0.9, 0.9)] {
        harness.click(p);
    }
    harness.key(Key::Backspace);
    harness.click(vec2(0.6, 0.27));
    assert!(harness.constraints().is_empty());
    harness.key(Key::Enter);
    assert_eq!(harness.points(0), [vec2(0.2, 0.2), vec2(0.4, 0.3), vec2(0.6, 0.27)]);
}

#[test]
fn a_double_click_ends_and_sets_one_point() {
    let mut harness = ToolHarness::new("Wall", Vec::new());
    harness.click(vec2(0.2, 0.2));
    harness.double_click(vec2(0.5, 0.6));
    assert_eq!(harness.points(0), [vec2(0.2, 0.2), vec2(0.5, 0.6)]);
}

#[test]
fn a_click_on_the_first_point_closes_a_wall_and_not_a_line() {
    for (tool, loops) in [("Wall", true), ("Directed line", false)] {
        let mut harness = ToolHarness::new(tool, Vec::new());
        for p in [vec2(0.2, 0.2), vec2(0.6, 0.2), vec2(0.4, 0.6), vec2(0.203, 0.202)] {
            harness.click(p);
        }
        assert_eq!(harness.constraints().len(), usize::from(loops), "{tool}");
        if loops {
            assert_eq!(harness.points(0)[0], harness.points(0)[3]);
        }
    }
}

#[test]
fn shift_allows_multiples_of_fifteen_degrees_only() {
    for angle in [0.1f32, 0.4, 1.0, 2.0, 4.0] {
        let mut harness = ToolHarness::new("Wall", Vec::new());
        harness.held.shift = true;
        harness.click(vec2(0.5, 0.5));
        harness.click(vec2(0.5, 0.5) + Vec2::from_angle(angle) * 0.3);
        harness.key(Key::Enter);
        harness.drag(&path(vec2(0.5, 0.5), vec2(0.5, 0.5) + Vec2::from_angle(angle) * 0.4, 20));
        for i in 0..2 {
            let points = harness.points(i);
            assert_eq!(points.len(), 2);
            let turns = (points[1] - points[0]).to_angle().to_degrees() / 15.0;
            // Angles of f32 vectors of length 0.3.
            assert!((turns - turns.round()).abs() < 1e-3, "{turns}");
        }
    }
}

#[test]
fn escape_leaves_nothing() {
    for tool in ["Wall", "Directed line"] {
        let mut harness = ToolHarness::new(tool, Vec::new());
        let before = harness.document.project().clone();
        harness.click(vec2(0.2, 0.2));
        harness.click(vec2(0.6, 0.2));
        harness.key(Key::Escape);
        harness.key(Key::Enter);
        harness.press_and_drag(&path(vec2(0.1, 0.1), vec2(0.5, 0.5), 10));
        harness.key(Key::Escape);
        harness.gesture(Gesture::Release(vec2(0.5, 0.5)));
        assert!(Arc::ptr_eq(&before, harness.document.project()));
        assert!(!harness.toolbox.tool().is_busy());
    }
}

#[test]
fn a_dot_is_no_line() {
    let mut harness = ToolHarness::new("Wall", Vec::new());
    harness.double_click(vec2(0.3, 0.3));
    harness.key(Key::Enter);
    assert!(harness.constraints().is_empty());
}

#[test]
fn points_lines_and_directions_catch_the_pointer_unless_ctrl_is_held() {
    let drawn = || vec![line(&[[0.1, 0.1], [0.9, 0.1]]), wall(&[[0.5, 0.5], [0.7, 0.9]])];
    let ends = |held: HeldKeys| {
        let mut harness = ToolHarness::new("Directed line", drawn());
        harness.held = held;
        harness.click(vec2(0.503, 0.498));
        harness.click(vec2(0.3, 0.103));
        harness.key(Key::Enter);
        harness.points(2)
    };
    let caught = ends(HeldKeys::default());
    // A foot on a line is a sum of f32 below 1.
    assert!(caught[0] == vec2(0.5, 0.5) && caught[1].distance(vec2(0.3, 0.1)) < 1e-6, "{caught:?}");
    let free = HeldKeys { ctrl: true, ..HeldKeys::default() };
    assert_eq!(ends(free), [vec2(0.503, 0.498), vec2(0.3, 0.103)]);
    let mut level = ToolHarness::new("Directed line", Vec::new());
    level.click(vec2(0.2, 0.4));
    level.click(vec2(0.6, 0.404));
    level.key(Key::Enter);
    assert!((level.points(0)[1].y - 0.4).abs() < 1e-6);
}

#[test]
fn the_grid_catches_while_it_is_shown() {
    for shown in [true, false] {
        let mut harness = ToolHarness::new("Wall", Vec::new());
        harness.session.overlays.grid = shown;
        let cells = harness.document.project().flow.grid.cells(Vec2::ONE)[0] as f32;
        harness.click(vec2(10.0, 20.0) / cells + vec2(0.002, -0.003));
        harness.click(vec2(0.777, 0.333));
        harness.key(Key::Enter);
        let off = harness.points(0)[0].distance(vec2(10.0, 20.0) / cells);
        assert_eq!(off < 1e-6, shown, "{off}");
    }
}

#[test]
fn ghosts_show_the_line_up_to_the_pointer() {
    let mut harness = ToolHarness::new("Wall", Vec::new());
    harness.click(vec2(0.2, 0.2));
    harness.gesture(Gesture::Hover(vec2(0.55, 0.71)));
    let ghosts = harness.with_context(|toolbox, context| toolbox.ghosts(context));
    let Some(Ghost::Wall(points, _)) = ghosts.first() else { panic!("{ghosts:?}") };
    assert_eq!(points[..], [vec2(0.2, 0.2), vec2(0.55, 0.71)]);
}
