//! Damaged GLB files: each is read or refused with an error that names it. `LIGHTLOOM_FUZZ=100000` sets how many are tried;
//! the slowest is printed.

use std::time::{Duration, Instant};

use glam::Vec3;
use lightloom_core::Progress;
use lightloom_core::import;
use serde_json::{Value, json};

use super::{Glb, Written, ball, glass, with_table};
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
fn seed() -> Glb {
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

#[test]
fn every_beginning_of_a_file_is_refused() {
    // The smallest file that is read.
    let mut glb = Glb::new();
    let mesh = glb.mesh(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]], None);
    glb.node(json!({ "mesh": mesh }));
    let good = glb.bytes();
    let written = Written::new(&good);
    written.import().unwrap();
    for length in 0..good.len() {
        std::fs::write(written.path(), &good[..length]).unwrap();
        let error = written.import().map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("scene.glb"), "{length}: {error}");
    }
}

#[test]
fn damaged_files_are_read_or_refused() {
    let rounds = std::env::var("LIGHTLOOM_FUZZ").ok().and_then(|rounds| rounds.parse().ok()).unwrap_or(200);
    let seed = seed();
    let bytes = seed.bytes();
    let written = Written::new(&bytes);
    let mut random = Random::new(0x9e37_79b9_7f4a_7c15);
    let (mut read, mut slowest) = (0, (Duration::ZERO, 0));
    for round in 0..rounds {
        let mut file = bytes.clone();
        if random.below(2) == 0 {
            let mut glb = seed.clone();
            (0..1 + random.below(3)).for_each(|_| damage(&mut glb.json, &mut random));
            file = glb.bytes();
        }
        if random.below(2) == 0 {
            for _ in 0..1 + random.below(4) {
                let at = random.below(file.len());
                file[at] = random.below(256) as u8;
            }
        }
        if random.below(8) == 0 {
            file.truncate(random.below(file.len()));
        }
        std::fs::write(written.path(), &file).unwrap();
        let start = Instant::now();
        match import::read(&written.path(), &Progress::new()) {
            Ok(_) => read += 1,
            Err(error) => assert!(error.to_string().contains("scene.glb"), "round {round}: {error}"),
        }
        slowest = slowest.max((start.elapsed(), round));
    }
    println!(
        "{rounds} files: {read} read, {} refused; the slowest, of round {}, took {:?}",
        rounds - read,
        slowest.1,
        slowest.0
    );
    // Neither all damage nor none is fatal.
    assert!(read > rounds / 20 && read < rounds, "{read} of {rounds}");
}
