//! Locked constraints.

use super::*;

#[test]
fn what_is_locked_is_touched_by_no_tool() {
    let drawn = vec![locked(&[[0.2, 0.5], [0.5, 0.5], [0.8, 0.5]])];
    for tool in ["Select", "Erase"] {
        let mut harness = ToolHarness::new(tool, drawn.clone());
        for selection in [Selection::default(), Selection::one(0), Selection::point(0, 1)] {
            harness.session.selection = selection;
            harness.drag(&path(vec2(0.5, 0.5), vec2(0.6, 0.7), 6));
            harness.double_click(vec2(0.3, 0.5));
            for key in [Key::Delete, Key::ArrowUp] {
                harness.session.selection = Selection::one(0);
                harness.key(key);
            }
            let commands: [fn(&Project, &Selection) -> Arranged; 4] =
                [arrange::reverse, arrange::join, arrange::split, arrange::delete];
            for command in commands {
                harness.session.selection = Selection::some(0, [1]);
                assert!(!harness.arrange(command), "{tool}");
            }
        }
        assert_eq!(harness.constraints(), drawn, "{tool}");
    }
}

#[test]
fn the_lock_is_saved_only_where_it_is_closed() {
    let text = |constraint: &Constraint| serde_json::to_string(constraint).unwrap();
    let (open, closed) = (wall(&[[0.0, 0.0], [1.0, 0.0]]), locked(&[[0.0, 0.0], [1.0, 0.0]]));
    assert!(!text(&open).contains("locked") && text(&closed).contains("\"locked\":true"));
    assert_eq!(serde_json::from_str::<Constraint>(&text(&closed)).unwrap(), closed);
}
