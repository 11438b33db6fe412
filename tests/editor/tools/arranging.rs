//! Reverse, join, split.

use super::*;

#[test]
fn reversed_twice_it_is_as_before() {
    let mut harness = ToolHarness::new("Select", vec![line(&[[0.1, 0.2], [0.5, 0.2], [0.9, 0.3]])]);
    let before = harness.document.project().clone();
    harness.session.selection = Selection::point(0, 0);
    assert!(harness.arrange(arrange::reverse));
    assert_eq!(harness.points(0)[0], vec2(0.9, 0.3));
    assert_eq!(harness.session.selection, Selection::point(0, 2));
    assert!(harness.arrange(arrange::reverse));
    assert_eq!(*before, **harness.document.project());
    assert_eq!(harness.session.selection, Selection::point(0, 0));
}

#[test]
fn what_is_split_joins_again() {
    let points = [[0.1, 0.2], [0.3, 0.5], [0.5, 0.2], [0.9, 0.3]];
    let mut harness = ToolHarness::new("Select", vec![wall(&[[0.0, 0.9], [1.0, 0.9]]), line(&points)]);
    let before = harness.document.project().clone();
    harness.session.selection = Selection::some(1, [1, 2]);
    assert!(harness.arrange(arrange::split));
    assert_eq!(harness.constraints().len(), 4);
    assert_eq!(harness.session.selection, Selection::all([1, 2, 3]));
    assert_eq!(harness.points(2), [vec2(0.3, 0.5), vec2(0.5, 0.2)]);
    assert!(harness.arrange(arrange::join));
    assert_eq!(*before, **harness.document.project());
    assert_eq!(harness.session.selection, Selection::one(1));
}

#[test]
fn lines_join_at_their_nearest_ends_and_the_first_keeps_its_direction() {
    let mut harness = ToolHarness::new(
        "Select",
        vec![
            line(&[[0.1, 0.5], [0.4, 0.5]]),
            wall(&[[0.0, 0.0], [1.0, 0.0]]),
            line(&[[0.9, 0.5], [0.42, 0.5]]),
        ],
    );
    harness.session.selection = Selection::all([0, 1, 2]);
    assert!(harness.arrange(arrange::join));
    assert_eq!(harness.constraints().len(), 2);
    assert_eq!(harness.points(0), [vec2(0.1, 0.5), vec2(0.4, 0.5), vec2(0.42, 0.5), vec2(0.9, 0.5)]);
}

#[test]
fn a_wall_alone_closes_and_splits_open_again() {
    let mut harness = ToolHarness::new("Select", vec![wall(&[[0.1, 0.1], [0.5, 0.1], [0.5, 0.5]])]);
    harness.session.selection = Selection::one(0);
    assert!(harness.arrange(arrange::join));
    assert_eq!(harness.points(0)[0], harness.points(0)[3]);
    assert!(!harness.arrange(arrange::join), "a loop is closed already");
    harness.session.selection = Selection::point(0, 1);
    assert!(harness.arrange(arrange::split));
    assert_eq!(harness.constraints().len(), 1);
    let begin = vec2(0.5, 0.1);
    assert_eq!(harness.points(0), [begin, vec2(0.5, 0.5), vec2(0.1, 0.1), begin]);
    harness.session.selection = Selection::some(0, [0, 2]);
    assert!(harness.arrange(arrange::split));
    assert_eq!(harness.constraints().len(), 2);
}

#[test]
fn there_is_nothing_to_do_without_a_selection_or_at_the_ends() {
    let mut harness = ToolHarness::new("Select", vec![line(&[[0.1, 0.1], [0.5, 0.1], [0.5, 0.5]])]);
    assert!(!harness.arrange(arrange::reverse) && !harness.arrange(arrange::join));
    assert!(!harness.arrange(arrange::split) && !harness.arrange(arrange::delete));
    harness.session.selection = Selection::some(0, [0, 2]);
    assert!(!harness.arrange(arrange::split));
    assert!(!harness.arrange(arrange::join), "a directed line alone has nothing to join");
}
