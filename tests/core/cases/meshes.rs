//! Meshes as programs export them: the light is that of the clean mesh.

use glam::{Vec3, vec3};

use super::{lamp, notes, watts};
use crate::scenes::{Stage, box_obj, glass, icosphere, obj};

type Faces = Vec<[usize; 3]>;

const CENTRE: Vec3 = vec3(0.0, 0.2, 0.0);

fn turned(face: &[usize; 3]) -> [usize; 3] {
    [face[0], face[2], face[1]]
}

/// A ball, its faces as `change` makes them.
fn ball(change: impl Fn(&[Vec3], Faces) -> Faces) -> String {
    let (unit, faces) = icosphere(3);
    let faces = change(&unit, faces);
    let vertices: Vec<Vec3> = unit.iter().map(|v| CENTRE + *v * 0.12).collect();
    obj(&vertices, None, &faces)
}

/// Balls of some radii and places, each with its faces turned or not.
fn balls(which: &[(Vec3, f32, bool)]) -> String {
    let (unit, faces) = icosphere(3);
    let (mut vertices, mut all) = (Vec::new(), Faces::new());
    for (centre, radius, inward) in which {
        let start = vertices.len();
        vertices.extend(unit.iter().map(|v| *centre + *v * *radius));
        all.extend(faces.iter().map(|face| if *inward { turned(face) } else { *face }.map(|v| v + start)));
    }
    obj(&vertices, None, &all)
}

fn stage(mesh: &str) -> Stage {
    let mut stage = Stage::new();
    stage.desc.lights.push(lamp([0.05, 1.5, 0.0], 25.0));
    stage.mesh("glass", mesh, glass(1.5));
    stage
}

fn joined(parts: &[String]) -> String {
    let mut text = String::new();
    let mut start = 0;
    for part in parts {
        for line in part.lines() {
            match line.strip_prefix("f ") {
                Some(corners) => {
                    let moved = corners.split(' ').map(|v| (v.parse::<usize>().unwrap() + start).to_string());
                    text += &format!("f {}\n", moved.collect::<Vec<_>>().join(" "));
                }
                None => text += &format!("{line}\n"),
            }
        }
        start += part.lines().filter(|line| line.starts_with("v ")).count();
    }
    text
}

/// Name, the mesh as it is exported, the clean mesh, words of the note.
fn table() -> Vec<(&'static str, String, String, &'static str)> {
    let clean = || ball(|_, faces| faces);
    let left = vec3(-0.16, 0.2, 0.0);
    let right = vec3(0.16, 0.2, 0.0);
    let pair = |inward: [bool; 2]| balls(&[(left, 0.12, inward[0]), (right, 0.12, inward[1])]);
    let hollow = |inward: [bool; 2]| balls(&[(CENTRE, 0.12, inward[0]), (CENTRE, 0.1, inward[1])]);
    let boxed = |low: f32, high: f32| box_obj(vec3(-0.1, low, -0.1), vec3(0.1, high, 0.1));
    vec![
        (
            "two-sided export",
            ball(|_, faces| faces.iter().flat_map(|face| [*face, turned(face)]).collect()),
            clean(),
            "1280 faces stand twice",
        ),
        (
            "the second sides first, from another corner",
            ball(|_, faces| {
                let other = faces.iter().map(|face| [face[2], face[1], face[0]]);
                other.chain(faces.iter().copied()).collect()
            }),
            clean(),
            "1280 faces stand twice",
        ),
        (
            "some faces twice",
            ball(|_, faces| faces.iter().chain(faces.iter().step_by(6)).copied().collect()),
            clean(),
            "214 faces stand twice",
        ),
        (
            "half of a ball mirrored",
            ball(|unit, faces| {
                let is_left = |face: &[usize; 3]| face.iter().map(|v| unit[*v].x).sum::<f32>() < 0.0;
                faces.iter().map(|face| if is_left(face) { turned(face) } else { *face }).collect()
            }),
            clean(),
            "of 1280 triangles faced inward",
        ),
        ("one of two balls mirrored", pair([false, true]), pair([false, false]), "1280 of 2560"),
        ("the other of two balls mirrored", pair([true, false]), pair([false, false]), "1280 of 2560"),
        ("two balls inside out", pair([true, true]), pair([false, false]), "turned inside out"),
        ("a hollow ball inside out", hollow([true, false]), hollow([false, true]), "turned inside out"),
        (
            "a wall between two halves of a box",
            joined(&[boxed(0.02, 0.1), boxed(0.1, 0.2)]),
            boxed(0.02, 0.2),
            "faces between parts",
        ),
    ]
}

#[test]
fn odd_meshes_cast_the_light_of_clean_ones() {
    let mut wrong = Vec::new();
    for (name, odd, clean, words) in table() {
        let (odd, clean) = (stage(&odd), stage(&clean));
        let (got, expected) = (watts(&odd), watts(&clean));
        // The same rays meet the same triangles, but for their order: within the noise of 16 384 photons.
        if (got / expected - 1.0).abs() > 0.02 {
            wrong.push(format!("{name}: {got:.3} W, expected {expected:.3} W"));
        }
        if !notes(&odd).iter().any(|note| note.contains(words)) || !notes(&clean).is_empty() {
            wrong.push(format!("{name}: {:?}, {:?}", notes(&odd), notes(&clean)));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_cavity_is_no_mirrored_part() {
    let hollow = balls(&[(CENTRE, 0.12, false), (CENTRE, 0.1, true)]);
    let scene = stage(&hollow).load();
    assert!(scene.media_at(CENTRE).is_empty());
    assert!(!scene.media_at(CENTRE + vec3(0.0, 0.11, 0.0)).is_empty());
}

#[test]
fn units_are_hinted_at_from_a_factor_of_twenty() {
    // The ball is .24 m wide over a receiver of 1 m.
    for (scale, told) in
        [(1000.0, true), (100.0, true), (84.0, true), (80.0, false), (1.0, false), (0.1, false), (0.01, true)]
    {
        let mut stage = stage(&ball(|_, faces| faces));
        stage.desc.meshes[0].transform.scale = scale;
        let notes = notes(&stage).join("\n");
        assert_eq!(notes.contains("other units"), told, "{scale}: {notes}");
    }
}

#[test]
fn many_materials_are_as_one() {
    let (unit, faces) = icosphere(3);
    let vertices: Vec<Vec3> = unit.iter().map(|v| CENTRE + *v * 0.12).collect();
    let mut lines: Vec<String> = obj(&vertices, None, &faces).lines().map(str::to_owned).collect();
    let first = lines.len() - faces.len();
    for k in 0..faces.len() {
        lines[first + k] = format!("usemtl m{k}\n{}", lines[first + k]);
    }
    let mut stage = Stage::new();
    stage.mesh("ball", lines.join("\n"), None);
    let scene = stage.load();
    assert_eq!(scene.meshes().len(), faces.len());
    assert!(scene.meshes().iter().all(|mesh| mesh.triangles == 1));
}
