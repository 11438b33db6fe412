//! Light inside glass, along it, through solid in solid, and of the least and the highest index.

use glam::Vec3;

use super::super::Size;
use super::super::case::{Bound, Case};
use super::super::light::{Room, lamp, limits};
use super::super::solid::{Shape, Solid};
use super::Group;
use lightloom_core::scene::LightDesc;
use lightloom_core::scene::light::DirectionalLight;

pub(super) const GROUP: Group = Group { name: "glass", cases };

const CENTRE: Vec3 = Vec3::new(0.0, 0.2, 0.0);
const WHY: &str = "light is split at a surface and never made: what is sent is found at its ends";

fn ball(radius: f32, ior: f32, priority: i32) -> Solid {
    Solid { shape: Shape::Ball { centre: CENTRE, radius }, ior, priority }
}

fn cases(size: Size) -> Vec<Case> {
    let room = || Room::new(size);
    let of = |solids: Vec<Solid>| Room { solids, ..room() };
    let lit = |light: LightDesc, solids: Vec<Solid>| Room { light, ..of(solids) };
    let plate = |height: f32, thickness: f32| {
        let lower = Vec3::new(-0.4, height, -0.4);
        let shape = Shape::Slab { lower, upper: Vec3::new(0.4, height + thickness, 0.4) };
        Solid { shape, ior: 1.5, priority: 0 }
    };
    let slanting = |degrees: f32| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        LightDesc::Directional(DirectionalLight {
            direction: [sin, -cos, 0.0],
            ..DirectionalLight::default()
        })
    };
    let holds = |name: &str, room: Room| {
        Case::new(name, Bound::Holds(limits(WHY)), move |progress| room.run(progress))
    };
    let refused = |ior: f32| {
        let room = room().of_index(ior);
        let bound = Bound::Refused { words: "ior", why: "beyond the range of the format" };
        Case::new(format!("index {ior}"), bound, move |progress| room.run(progress))
    };
    let past_the_receiver = |name: &str, room: Room| {
        let why = "parallel faces leave the direction as it was: the light comes down 57 m away";
        Case::new(name, Bound::Refused { words: "leaves the scene", why }, move |progress| room.run(progress))
    };
    let onion = vec![ball(0.12, 1.5, 0), ball(0.09, 1.33, 1), ball(0.06, 2.4, 2), ball(0.03, 1.0, 3)];
    vec![
        holds("a light inside a ball", lit(lamp([0.02, 0.2, 0.01]), vec![ball(0.12, 1.5, 0)])),
        holds("a light on the surface of a ball", lit(lamp([0.0, 0.32, 0.0]), vec![ball(0.12, 1.5, 0)])),
        // What leaves the plate goes 570 times as far aside as down; a thin one, so that its sides take little of the light.
        holds(
            "grazing a plate on the receiver at 89.9 degrees",
            lit(slanting(89.9), vec![plate(2e-4, 1e-3)]),
        ),
        holds("grazing a plate at 85 degrees", lit(slanting(85.0), vec![plate(0.01, 0.01)])),
        past_the_receiver(
            "grazing a plate above the receiver at 89.9 degrees",
            lit(slanting(89.9), vec![plate(0.1, 0.05)]),
        ),
        holds("along the receiver onto a ball", lit(slanting(90.0), vec![ball(0.12, 1.5, 0)])),
        holds("straight onto a plate", lit(slanting(0.0), vec![plate(0.1, 0.05)])),
        holds("four solids in each other", of(onion)),
        holds("two balls in the same place", of(vec![ball(0.12, 1.5, 0), ball(0.12, 1.5, 0)])),
        holds("a bubble", of(vec![ball(0.12, 1.5, 0), ball(0.1199, 1.0, 1)])),
        holds("index 1", room().of_index(1.0)),
        holds("index 4", room().of_index(4.0)),
        refused(0.99),
        refused(4.01),
    ]
}
