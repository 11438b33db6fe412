//! Surfaces that lie in one another: the light is that of the same scene in which they overlap by 1e-6 m.

use std::f32::consts::TAU;

use glam::{Vec3, vec3};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::scene::material::{Beam, Diffuse, Material};
use lightloom_core::scene::{Media, MeshDesc, Ray, Scene, mesh::Transform};

use super::{lamp, notes, watts};
use crate::scenes::{Stage, box_obj, glass, icosphere, mirror, obj, sphere_obj};

const ABOVE: [f32; 3] = [0.0, 1.5, 0.0];
const ASLANT: [f32; 3] = [0.4, 0.8, 0.2];
/// An overlap (m) far above rounding and far below anything that light shows.
const HAIR: f32 = 1e-6;

fn matt() -> Option<Material> {
    Some(Material::Diffuse(Diffuse::default()))
}

fn lit(position: [f32; 3], angle: f32) -> Stage {
    let mut stage = Stage::new();
    stage.desc.lights.push(lamp(position, angle));
    stage
}

fn ball(stage: &mut Stage, name: &str) {
    stage.mesh(name, sphere_obj(3, vec3(0.0, 0.2, 0.0), 0.12), glass(1.5));
}

/// A flat square of `cells` x `cells` quads at a height.
fn sheet(half: f32, height: f32, cells: usize) -> String {
    let at = |k: usize| half * (2.0 * k as f32 / cells as f32 - 1.0);
    let vertices: Vec<Vec3> =
        (0..=cells).flat_map(|i| (0..=cells).map(move |k| vec3(at(i), height, at(k)))).collect();
    let number = |i: usize, k: usize| i * (cells + 1) + k;
    let faces: Vec<[usize; 3]> = (0..cells * cells)
        .flat_map(|cell| {
            let (i, k) = (cell / cells, cell % cells);
            let [a, b, c, d] = [number(i, k), number(i, k + 1), number(i + 1, k + 1), number(i + 1, k)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    obj(&vertices, None, &faces)
}

/// A closed round body of `sides` facets around the Y axis, by radius and height from the middle below to the middle above.
fn turned(profile: &[[f32; 2]], sides: usize) -> String {
    let mut vertices = Vec::new();
    for [radius, height] in profile {
        vertices.extend((0..sides).map(|k| {
            let (sin, cos) = (TAU * k as f32 / sides as f32).sin_cos();
            vec3(radius * cos, *height, radius * sin)
        }));
    }
    let below = vertices.len();
    vertices.extend([vec3(0.0, profile[0][1], 0.0), vec3(0.0, profile[profile.len() - 1][1], 0.0)]);
    let mut faces = Vec::new();
    for k in 0..sides {
        let next = (k + 1) % sides;
        let last = (profile.len() - 1) * sides;
        faces.extend([[below, k, next], [below + 1, last + next, last + k]]);
        for ring in 0..profile.len() - 1 {
            let (a, b) = (ring * sides, (ring + 1) * sides);
            faces.extend([[a + k, b + k, b + next], [a + k, b + next, a + next]]);
        }
    }
    obj(&vertices, None, &faces)
}

fn tumbler() -> String {
    turned(&[[0.1, 0.05], [0.1, 0.25], [0.09, 0.25], [0.09, 0.06]], 48)
}

/// Water in it, larger by `overlap`, its wall in three rings where the glass has one.
fn water(overlap: f32) -> String {
    let r = 0.09 + overlap;
    turned(&[[r, 0.06 - overlap], [r, 0.1], [r, 0.14], [r, 0.2]], 48)
}

fn placed(mesh: &mut MeshDesc, rotate: [f32; 3], translate: [f32; 3]) {
    mesh.transform = Transform { rotate, translate: translate.map(f64::from), scale: 1.0 };
}

/// A box of glass on a tilted receiver, sunk into it by `overlap` along its own height.
fn on_tilted(overlap: f32, has_floor: bool) -> Stage {
    let (turn, centre) = ([20.0, 35.0, -25.0], [0.13, 0.27, -0.31]);
    let mut stage = lit([0.4, 1.2, 0.2], 40.0);
    let body = box_obj(vec3(-0.1, -overlap, -0.1), vec3(0.1, 0.2, 0.1));
    placed(stage.mesh("box", body, glass(1.5)), turn, centre);
    if has_floor {
        placed(stage.mesh("floor", sheet(1.0, 0.0, 7), matt()), turn, centre);
    }
    stage.desc.receiver.centre = centre;
    stage.desc.receiver.rotate = turn;
    stage
}

fn stage(light: ([f32; 3], f32), build: impl Fn(&mut Stage)) -> Stage {
    let mut stage = lit(light.0, light.1);
    build(&mut stage);
    stage
}

/// Name, the scene with surfaces that touch, the same with an overlap or without the second surface.
fn table() -> Vec<(&'static str, Stage, Stage)> {
    let above = (ABOVE, 20.0);
    let aslant = (ASLANT, 40.0);
    let only_ball = || stage(above, |s| ball(s, "ball"));
    let block = |low: f32| box_obj(vec3(-0.1, low, -0.1), vec3(0.1, 0.2, 0.1));
    let boxed = |low: f32| stage(aslant, move |s| _ = s.mesh("box", block(low), glass(1.5)));
    let tumbled = |overlap: f32| {
        stage(above, move |s| {
            s.mesh("glass", tumbler(), glass(1.5)).priority = 1;
            s.mesh("water", water(overlap), glass(1.33));
        })
    };
    let shelled = |overlap: f32| {
        stage(above, move |s| {
            let (unit, faces) = icosphere(3);
            let at = |radius: f32| unit.iter().map(move |v| vec3(0.0, 0.2, 0.0) + *v * radius);
            let vertices: Vec<Vec3> = at(0.12).chain(at(0.1)).collect();
            let inner = faces.iter().map(|f| [f[0], f[2], f[1]].map(|v| v + unit.len()));
            let all: Vec<[usize; 3]> = faces.iter().copied().chain(inner).collect();
            s.mesh("glass", obj(&vertices, None, &all), glass(1.5)).priority = 1;
            let within: Vec<Vec3> = at(0.1 + overlap).collect();
            s.mesh("water", obj(&within, None, &faces), glass(1.33));
        })
    };
    let stacked = |overlap: f32, cells: usize| {
        stage(aslant, move |s| {
            s.mesh("lower", box_obj(vec3(-0.1, 0.02, -0.1), vec3(0.1, 0.1, 0.1)), glass(1.5)).priority = 1;
            // A thin lid of many triangles lies on the lower block, and the upper block on the lid.
            let lid = [[0.06, 0.1 - overlap], [0.06, 0.12]];
            s.mesh("lid", turned(&lid, cells), glass(1.7)).priority = 2;
            let upper = box_obj(vec3(-0.05, 0.12 - overlap, -0.03), vec3(0.08, 0.2, 0.1));
            s.mesh("upper", upper, glass(1.33));
        })
    };
    let on_coaster = |overlap: f32| {
        stage(aslant, move |s| {
            s.mesh("coaster", box_obj(vec3(-0.05, 0.0, -0.06), vec3(0.07, 0.02, 0.06)), matt());
            s.mesh("box", block(0.02 - overlap), glass(1.5));
        })
    };
    let mirrored = |copies: usize| {
        stage(([0.0, 1.0, 0.6], 60.0), move |s| {
            for copy in 0..copies {
                let plate = box_obj(vec3(-0.2, 0.05, -0.4), vec3(0.2, 0.3, -0.38));
                s.mesh(&format!("plate {copy}"), plate, mirror(0.9));
            }
        })
    };
    vec![
        (
            "a matt floor in the receiver's plane",
            stage(above, |s| {
                ball(s, "ball");
                s.mesh("floor", sheet(1.0, 0.0, 5), matt());
            }),
            only_ball(),
        ),
        ("a box on the receiver", boxed(0.0), boxed(-HAIR)),
        ("a box off the receiver by rounding", boxed(1e-8), boxed(-HAIR)),
        (
            "a dome on the receiver",
            stage(aslant, |s| _ = s.mesh("dome", dome(0.0), glass(1.5))),
            stage(aslant, |s| _ = s.mesh("dome", dome(-HAIR), glass(1.5))),
        ),
        ("a box on a tilted receiver", on_tilted(0.0, false), on_tilted(HAIR, false)),
        ("a box on a tilted floor in the receiver's plane", on_tilted(0.0, true), on_tilted(HAIR, false)),
        ("water in a cavity of the same triangles", shelled(0.0), shelled(1e-3)),
        ("water that fills a part of a tumbler", tumbled(0.0), tumbled(1e-5)),
        (
            "a ball twice in place",
            stage(above, |s| {
                ball(s, "a");
                ball(s, "b");
            }),
            only_ball(),
        ),
        (
            "a ball thrice in place",
            stage(above, |s| {
                ball(s, "a");
                ball(s, "b");
                ball(s, "c");
            }),
            only_ball(),
        ),
        (
            "a ball twice, once turned by 360 degrees",
            stage(above, |s| {
                ball(s, "a");
                ball(s, "b");
                s.desc.meshes[1].transform.rotate = [360.0, -720.0, 360.0];
            }),
            only_ball(),
        ),
        ("blocks on a round lid on a block", stacked(0.0, 40), stacked(HAIR, 40)),
        ("a box on a matt coaster", on_coaster(0.0), on_coaster(HAIR)),
        ("a mirror twice in place", mirrored(2), mirrored(1)),
    ]
}

fn dome(low: f32) -> String {
    let arc = (0..=12).map(|k| {
        let (sin, cos) = (TAU / 4.0 * k as f32 / 12.5).sin_cos();
        [0.12 * cos, low + 0.12 * sin]
    });
    turned(&arc.collect::<Vec<_>>(), 40)
}

#[test]
fn surfaces_that_touch_are_one_surface() {
    let mut wrong = Vec::new();
    for (name, touching, reference) in table() {
        let (got, expected) = (watts(&touching), watts(&reference));
        // Three errors of the difference of two fluxes of 16 384 photons, .55 % each at a landing rate of a half; what is lost
        // at surfaces that are met by rounding is 20 to 90 %.
        if (got / expected - 1.0).abs() > 0.025 {
            wrong.push(format!("{name}: {got:.3} W, expected {expected:.3} W"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Whether a ray that goes straight down through a scene, and is never reflected, is in air at its end.
fn comes_out(scene: &Scene, x: f32, z: f32) -> bool {
    let mut ray = Ray::new(vec3(x, 2.0, z), Vec3::NEG_Y);
    let mut beam = Beam::new(Vec3::ONE, Media::default());
    let mut rng = Stream::new(3, Purpose::Trace, 0, 0);
    while let Some(hit) = scene.intersect(&ray).filter(|hit| scene.mesh_of(hit.surface).is_some()) {
        let mut next = beam.clone();
        let material = scene.material(hit.surface);
        let way = material.scatter(scene.geometry(), &hit, ray.direction, &mut next, &mut rng).unwrap();
        if way.y < 0.0 {
            (ray, beam) = (Ray::leaving(&hit, Vec3::NEG_Y), next);
        }
    }
    beam.media.is_empty()
}

#[test]
fn every_ray_that_enters_touching_blocks_leaves_them() {
    let mut rng = Stream::new(11, Purpose::Trace, 1, 0);
    for round in 0..40 {
        // Blocks between the planes of a coarse grid: most of their faces, edges and corners lie in one another. Every other
        // scene is turned about Y, so that they do but for rounding.
        let turn = if round % 2 == 0 { 0.0 } else { 360.0 * rng.f32() };
        let mut stage = Stage::new();
        stage.desc.receiver.centre = [0.0, -1.0, 0.0];
        for k in 0..6 {
            let mut ends = || {
                let a = (rng.f32() * 4.0) as u32;
                let b = a + 1 + (rng.f32() * (4 - a) as f32) as u32;
                [a, b].map(|end| 0.1 * end.min(4) as f32 - 0.2)
            };
            let ([x0, x1], [y0, y1], [z0, z1]) = (ends(), ends(), ends());
            let block = match k % 3 {
                0 => turned(&[[0.1 + 0.01 * k as f32, y0], [0.1 + 0.01 * k as f32, y1]], 7 + k),
                _ => box_obj(vec3(x0, y0, z0), vec3(x1, y1, z1)),
            };
            let mesh = stage.mesh(&format!("block {k}"), block, glass(1.2 + 0.1 * k as f32));
            mesh.transform.rotate = [0.0, turn, 0.0];
        }
        let scene = stage.load();
        let lost = (0..500).filter(|_| {
            let [x, z] = [0.5 * rng.f32() - 0.25, 0.5 * rng.f32() - 0.25];
            !comes_out(&scene, x, z)
        });
        assert_eq!(lost.count(), 0, "round {round}");
    }
}

#[test]
fn a_gap_above_rounding_is_air() {
    let boxed = |low: f32| {
        let body = box_obj(vec3(-0.1, low, -0.1), vec3(0.1, 0.2, 0.1));
        watts(&stage((ASLANT, 40.0), |s| _ = s.mesh("box", body.clone(), glass(1.5))))
    };
    let ratio = boxed(HAIR) / boxed(0.0);
    // Two more surfaces of 4 % and total reflections: .79 by an independent run of the same scene, 3.16 W and 4.00 W.
    assert!((ratio - 0.79).abs() < 0.025, "{ratio}");
}

#[test]
fn what_touches_is_named() {
    for (stage, words) in [
        (
            stage((ABOVE, 20.0), |s| {
                ball(s, "a");
                ball(s, "b");
            }),
            ["'a' and 'b'", "one glass, that of 'b'"],
        ),
        (on_tilted(0.0, true), ["'box'", "'floor'"]),
        (on_tilted(0.0, false), ["'box' touches the receiver", "without air"]),
    ] {
        let notes = notes(&stage).join("\n");
        assert!(words.iter().all(|word| notes.contains(word)), "{notes}");
    }
    let near = notes(&on_tilted(HAIR, false)).join("\n");
    assert!(near.contains("'box' nearly touches the receiver, up to 1e-6 m apart"), "{near}");
    assert_eq!(notes(&on_tilted(1e-4, false)), Vec::<String>::new());
}

#[test]
fn glass_that_the_receiver_cuts_off_is_named() {
    let sphere = |height: f32| {
        let at = vec3(0.0, height, 0.0);
        notes(&stage((ABOVE, 20.0), |s| _ = s.mesh("ball", sphere_obj(3, at, 0.1), glass(1.5)))).join("\n")
    };
    // Its lowest vertex is a pole.
    let sunk = sphere(0.06);
    assert!(sunk.contains("'ball' stands 0.04 m deep in the receiver"), "{sunk}");
    assert!(sunk.contains("scene.meshes[0].transform.translate"), "{sunk}");
    assert!(sphere(-0.2).contains("'ball' lies behind the receiver"));
    // By a hair, as it is done to make things touch.
    assert!(!sphere(0.0995).contains("deep in the receiver"));
    let mut beside =
        stage((ABOVE, 20.0), |s| _ = s.mesh("ball", sphere_obj(3, vec3(9.0, 0.0, 0.0), 0.1), glass(1.5)));
    beside.desc.receiver.surround = 0.0;
    assert!(!notes(&beside).join("\n").contains("receiver"), "over the edge of the table");
}
