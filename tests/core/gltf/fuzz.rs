//! Damaged GLB files, which the tests of bad inputs read.

use serde_json::{Value, json};

use super::{Glb, ball, glass, with_table};
use crate::cases::Random;

/// Numbers that have meant trouble to readers of this format.
const NUMBERS: [&str; 16] = [
    "-1",
    "0",
    "1",
    "2",
    "3",
    "255",
    "65535",
    "4294967295",
    "4294967296",
    "18446744073709551615",
    "1e39",
    "-1e39",
    "1e-39",
    "0.5",
    "null",
    "[]",
];

/// A file with all that is read: sparse elements, lamps, a camera, a table, a tree.
pub(super) fn seed() -> Glb {
    let mut glb = ball();
    with_table(&mut glb, json!({ "name": "Desk", "translation": [0, -0.1, 0] }));
    let spot = json!({ "innerConeAngle": 0.2, "outerConeAngle": 0.4 });
    glb.light(
        json!({ "type": "spot", "intensity": 900, "spot": spot }),
        json!({ "name": "key", "translation": [0, 2, 0] }),
    );
    let camera = glb.push(
        "cameras",
        json!({ "type": "perspective", "perspective": { "yfov": 0.6, "znear": 0.1, "aspectRatio": 1.5 } }),
    );
    let camera = glb.push("nodes", json!({ "camera": camera, "translation": [0, 1, 3] }));
    glb.node(json!({ "children": [camera], "rotation": [0, 0.7, 0, 0.7] }));
    let indices = glb.view(&[1, 0, 2, 0]);
    glb.json["accessors"][0]["sparse"] = json!({ "count": 2, "indices": { "bufferView": indices, "componentType": 5123 },
        "values": { "bufferView": 0 } });
    glb.push("materials", glass());
    glb
}

/// Replaces a value somewhere in a tree.
fn damage(value: &mut Value, random: &mut Random) {
    match value {
        Value::Object(map) if !map.is_empty() => {
            let at = random.below(map.len());
            let key = map.keys().nth(at).unwrap().clone();
            match random.below(12) {
                0 => drop(map.remove(&key)),
                _ => damage(&mut map[&key], random),
            }
        }
        Value::Array(list) if !list.is_empty() => {
            let at = random.below(list.len());
            match random.below(12) {
                0 => drop(list.remove(at)),
                1 => list.push(list[at].clone()),
                _ => damage(&mut list[at], random),
            }
        }
        other => *other = serde_json::from_str(NUMBERS[random.below(NUMBERS.len())]).unwrap_or(Value::Null),
    }
}

/// The good file with values of its JSON exchanged, bytes changed, or its end cut off.
pub(crate) fn damaged(random: &mut Random) -> Vec<u8> {
    let mut glb = seed();
    if random.below(2) == 0 {
        (0..1 + random.below(3)).for_each(|_| damage(&mut glb.json, random));
    }
    let mut file = glb.bytes();
    if random.below(2) == 0 {
        for _ in 0..1 + random.below(4) {
            let at = random.below(file.len());
            file[at] = random.below(256) as u8;
        }
    }
    if random.below(8) == 0 {
        file.truncate(random.below(file.len()));
    }
    file
}
