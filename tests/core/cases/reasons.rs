//! Scenes that show nothing, or not what was meant: the reason is told.

use glam::{Vec3, vec3};
use lightloom_core::Error;
use lightloom_core::note::About;
use lightloom_core::scene::LightDesc;
use lightloom_core::scene::light::{SphereLight, SpotLight};
use lightloom_core::scene::material::{Diffuse, Material};

use super::{check, lamp};
use crate::scenes::{Stage, box_obj, glass, mirror, sphere_obj, texts};

fn ball() -> Stage {
    let mut stage = Stage::new();
    stage.desc.lights.push(lamp([0.0, 1.5, 0.0], 20.0));
    stage.mesh("ball", sphere_obj(3, vec3(0.0, 0.2, 0.0), 0.12), glass(1.5));
    stage
}

fn wall(stage: &mut Stage, lower: Vec3, upper: Vec3) {
    stage.mesh("wall", box_obj(lower, upper), Some(Material::Diffuse(Diffuse::default())));
}

fn around(radius: f32) -> LightDesc {
    LightDesc::Sphere(SphereLight {
        name: "sun".into(),
        position: [0.0, 0.2, 0.0],
        radius,
        ..Default::default()
    })
}

/// A change of the scene with the ball, and words of the note or of the error.
type Row = (fn(&mut Stage), &'static [&'static str]);

fn table() -> Vec<Row> {
    vec![
        (
            |s| s.desc.camera.look_at = [0.0, 2.0, 3.0],
            &["note", "camera sees nothing of the receiver", "look_at"],
        ),
        (
            |s| (s.desc.camera.position, s.desc.camera.look_at) = ([0.0, -1.0, 0.5], [0.0; 3]),
            &["note", "camera sees nothing", "behind the receiver"],
        ),
        (
            |s| wall(s, vec3(-2.0, 0.1, 1.0), vec3(2.0, 1.5, 1.1)),
            &["note", "camera sees nothing", "'wall' stands before it"],
        ),
        (|s| s.desc.lights[0] = around(0.5), &["error", "'ball' stands inside the ball"]),
        (|s| s.desc.lights.push(around(0.5)), &["note", "'ball' stands inside the ball lamp 'sun'"]),
        (
            |s| {
                let (position, target) = ([1.0, 1.0, 0.0], [2.0, 0.0, 0.0]);
                let name = "key".into();
                let key = SpotLight { name, position, target, angle_deg: 10.0, ..Default::default() };
                s.desc.lights.push(LightDesc::Spot(key));
            },
            &["note", "no caustic of its own: light 'key'", "it shines past them"],
        ),
        (
            |s| wall(s, vec3(-0.5, 0.8, -0.5), vec3(0.5, 0.9, 0.5)),
            &["error", "'wall' stands between it and 'ball'"],
        ),
        (|s| s.desc.meshes[0].transform.scale = 1000.0, &["note", "other units", "transform.scale (0.001"]),
        (
            |s| {
                s.file(
                    "ball.obj",
                    format!("mtllib lost.mtl\nusemtl Glass\n{}", box_obj(Vec3::ZERO, Vec3::ONE)),
                );
                s.desc.meshes[0].material = None;
            },
            &["error", "no mesh is of glass or a mirror: 'ball' is matt", "lost.mtl", "note: ball"],
        ),
        (
            |s| {
                s.file(
                    "thing.obj",
                    format!("mtllib lost.mtl\nusemtl Glass\n{}", box_obj(Vec3::ZERO, Vec3::ONE)),
                );
                s.mesh("late", "v 0 0 0\n", None);
                s.desc.meshes[0].file = "thing.obj".into();
                s.desc.meshes[0].material = None;
            },
            &["error", "late.obj", "lost.mtl"],
        ),
    ]
}

#[test]
fn what_is_wrong_is_told() {
    let mut wrong = Vec::new();
    for (row, (change, words)) in table().into_iter().enumerate() {
        let mut stage = ball();
        change(&mut stage);
        let told = match check(&stage) {
            Ok(report) => format!("note\n{}", texts(&report.notes).join("\n")),
            Err(error) => format!("error\n{error}"),
        };
        if !words.iter().all(|word| told.contains(word)) {
            wrong.push(format!("row {row}: {words:?}: {told}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn what_is_told_is_about_something() {
    type Row = (fn(&mut Stage), About);
    let rows: [Row; 4] = [
        (|s| s.desc.meshes[0].transform.scale = 1000.0, About::Mesh(0)),
        (|s| s.desc.lights.push(around(0.5)), About::Light(1)),
        (|s| s.desc.camera.look_at = [0.0, 9.0, 0.0], About::Camera),
        (|s| s.desc.meshes.push(s.desc.meshes[0].clone()), About::Mesh(0)),
    ];
    for (row, (change, about)) in rows.into_iter().enumerate() {
        let mut stage = ball();
        change(&mut stage);
        let notes = match check(&stage) {
            Ok(report) => report.notes,
            Err(Error::Noted { notes, .. }) => notes,
            Err(error) => panic!("row {row}: {error}"),
        };
        assert!(notes.iter().any(|note| note.about == about), "row {row}: {notes:?}");
    }
}

#[test]
fn nothing_is_told_where_nothing_is_wrong() {
    assert_eq!(check(&ball()).unwrap().notes, Vec::new());
    // A receiver that is seen in a mirror alone.
    let mut stage = ball();
    stage.mesh("mirror", box_obj(vec3(-1.0, 0.0, -1.1), vec3(1.0, 2.0, -1.0)), mirror(0.9));
    (stage.desc.camera.position, stage.desc.camera.look_at) = ([0.0, 0.8, -0.6], [0.0, 0.7, -2.0]);
    assert_eq!(check(&stage).unwrap().notes, Vec::new());
}

#[test]
fn watts_are_those_of_the_lamp() {
    // All of the lamp's cone falls on the ball, and most of it comes through: less than 5 W, of which each surface reflects
    // 4 % and more at the silhouette.
    let mut stage = ball();
    stage.desc.lights[0] = lamp([0.0, 1.5, 0.0], 8.0);
    let watts: f64 = check(&stage).unwrap().caustics.iter().map(|caustic| caustic.watts).sum();
    assert!((4.0..5.0).contains(&watts), "{watts}");
}
