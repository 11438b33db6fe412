//! Lines and walls that were drawn oddly.

use serde_json::{Value, json};

use super::Row;
use crate::constraints::{line, notes, wall};

/// A point list that does not end where it should.
fn circle(count: usize) -> Value {
    (0..count)
        .map(|i| {
            let angle = i as f64 / (count - 1) as f64 * std::f64::consts::TAU;
            json!([0.25 + 0.2 * angle.cos(), 0.35 + 0.2 * angle.sin()])
        })
        .collect()
}

pub(super) fn rows() -> Vec<Row> {
    let thick = json!({ "type": "wall", "points": [[0.2, 0.2], [0.3, 0.7]], "thickness": 0.5 });
    let thin = json!({ "type": "wall", "points": [[0.5, 0.2], [0.5, 0.8]], "thickness": 0.01 });
    let read: Vec<(&str, Vec<Value>, &str)> = vec![
        ("a line of no point", vec![line(json!([]))], "directed line 1 is no longer than a dot"),
        ("a line of one point", vec![line(json!([[0.5, 0.5]]))], "no longer than a dot"),
        ("a line of equal points", vec![line(json!([[0.5, 0.5], [0.5, 0.5]]))], "no longer than a dot"),
        ("a wall of one point", vec![wall(json!([[0.5, 0.5]]))], "no longer than a dot"),
        ("a line off the receiver", vec![line(json!([[2, 2], [3, 2]]))], "off the receiver"),
        (
            "a line that crosses itself",
            vec![line(json!([[0.2, 0.5], [0.8, 0.5], [0.8, 0.8], [0.5, 0.8], [0.5, 0.2]]))],
            "",
        ),
        (
            "two opposite lines in one place",
            vec![line(json!([[0.3, 0.5], [0.7, 0.5]])), line(json!([[0.7, 0.5], [0.3, 0.5]]))],
            "contradict each other",
        ),
        ("a wall around all light of a key", vec![wall(circle(60))], ""),
        ("a wall over all light of a key", vec![thick], ""),
        ("a wall at the border", vec![wall(json!([[0, 0.9], [1, 0.9]]))], "border at both ends"),
        ("a wall thinner than a cell", vec![thin], "0.32 cells thick"),
        ("50 equal walls", vec![wall(json!([[0.5, 0.2], [0.5, 0.8]])); 50], ""),
    ];
    let refused: Vec<(&str, Value, &str)> = vec![
        ("a wall of 10 001 points", wall(json!(vec![[0.5, 0.5]; 10_001])), "constraints[0] … limit"),
        ("a point far off", wall(json!([[0, 0], [1, 11]])), "constraints[0].points[1]"),
        ("a point of three numbers", wall(json!([[0, 0, 0]])), "constraints[0]"),
        ("a wall of thickness 0", json!({ "type": "wall", "points": [], "thickness": 0 }), "thickness"),
        ("a line of weight -1", json!({ "type": "directed_line", "points": [], "weight": -1 }), "weight"),
        (
            "a line that ends before it begins",
            json!({ "type": "directed_line", "points": [], "span": { "from": 9, "to": 3 } }),
            "constraints[0].span",
        ),
        ("a constraint of no kind", json!({ "type": "vortex", "points": [] }), "constraints[0]"),
    ];
    let read = read.into_iter().map(|(input, drawn, words)| Row::read(input, words, || notes(json!(drawn))));
    let refused =
        refused.into_iter().map(|(input, drawn, words)| Row::refused(input, words, || notes(json!([drawn]))));
    read.chain(refused).collect()
}
