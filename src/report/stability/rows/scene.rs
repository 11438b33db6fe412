//! Rows of small scenes: their size, and light in glass, along it, and of the least and the highest index.

use glam::Vec3;

use super::super::glass::{GlassObject, Shape};
use super::super::scene_case::{SceneCase, lamp};
use super::row::Expected::{Fails, Holds, Refused};
use super::row::Row;
use crate::effort::Effort;
use lightloom_core::scene::LightDesc;
use lightloom_core::scene::light::DirectionalLight;

const RANGE: &str = "beyond the range of the format";

/// A scene the size of a grain, and one of ten kilometres.
pub(super) fn receiver(effort: Effort) -> Vec<Row> {
    const WHY: &str =
        "all lengths times one factor: as much light lands, within five deviations of two independent runs";
    let count: usize = effort.pick(20_000, 400_000);
    let row = |scale: f32, expected| {
        Row::scene(format!("{scale:e} m"), expected, move |scene| {
            (scene.scale, scene.compared) = (scale, Some(count));
        })
        .limited(move |limits| limits.energy = Some(5.0 * (2.0 / count as f64).sqrt()))
    };
    let [holds, refused] = [Holds(WHY), Refused("receiver.size", RANGE)];
    vec![row(1e-4, holds), row(1e-2, holds), row(1e4, holds), row(1e-5, refused), row(2e5, refused)]
}

fn ball(radius: f32, ior: f32, priority: i32) -> GlassObject {
    GlassObject { shape: Shape::Ball { centre: Vec3::new(0.0, 0.2, 0.0), radius }, ior, priority }
}

fn plate(height: f32, thickness: f32) -> GlassObject {
    let (lower, upper) = (Vec3::new(-0.4, height, -0.4), Vec3::new(0.4, height + thickness, 0.4));
    GlassObject { shape: Shape::Slab { lower, upper }, ior: 1.5, priority: 0 }
}

/// Parallel light at this angle from straight down.
fn slanting(degrees: f32) -> LightDesc {
    let (sin, cos) = degrees.to_radians().sin_cos();
    LightDesc::Directional(DirectionalLight { direction: [sin, -cos, 0.0], ..DirectionalLight::default() })
}

/// Light inside glass, along it, through solid in solid, and of the least and the highest index.
pub(super) fn glass(_: Effort) -> Vec<Row> {
    const WHY: &str = "light is split at a surface and never made: what is sent is found at its ends";
    const FAR: &str = "parallel faces leave the direction as it was: the light comes down 57 m away";
    const SLIVER: &str = "edge-on a plate is a sliver of the ball at which light is first aimed, and reflects 99 % of what meets it: \
                          the first photons all miss";
    let lit = |name: &str, light: LightDesc, object: GlassObject| {
        Row::scene(name, Holds(WHY), move |scene| (scene.light, scene.objects) = (light, vec![object]))
    };
    let of = |name: &str, objects: Vec<GlassObject>| {
        Row::scene(name, Holds(WHY), move |scene| scene.objects = objects)
    };
    let index =
        |name: &str, expected, ior: f32| Row::scene(name, expected, move |scene| scene.objects[0].ior = ior);
    let past_the_receiver = |scene: &mut SceneCase| {
        (scene.light, scene.objects) = (slanting(89.9), vec![plate(0.1, 0.05)]);
    };
    // What leaves the plate goes 570 times as far aside as down; a thin one, so that its sides take little of the light.
    let on_the_receiver = |scene: &mut SceneCase| {
        (scene.light, scene.objects) = (slanting(89.9), vec![plate(2e-4, 1e-3)]);
    };
    let onion = vec![ball(0.12, 1.5, 0), ball(0.09, 1.33, 1), ball(0.06, 2.4, 2), ball(0.03, 1.0, 3)];
    vec![
        lit("a light inside a ball", lamp([0.02, 0.2, 0.01]), ball(0.12, 1.5, 0)),
        lit("a light on the surface of a ball", lamp([0.0, 0.32, 0.0]), ball(0.12, 1.5, 0)),
        Row::scene(
            "grazing a plate on the receiver at 89.9 degrees",
            Fails("leaves the scene", SLIVER),
            on_the_receiver,
        ),
        lit("grazing a plate at 85 degrees", slanting(85.0), plate(0.01, 0.01)),
        Row::scene(
            "grazing a plate above the receiver at 89.9 degrees",
            Fails("leaves the scene", FAR),
            past_the_receiver,
        ),
        lit("along the receiver onto a ball", slanting(90.0), ball(0.12, 1.5, 0)),
        lit("straight onto a plate", slanting(0.0), plate(0.1, 0.05)),
        of("four solids in each other", onion),
        of("two balls in the same place", vec![ball(0.12, 1.5, 0), ball(0.12, 1.5, 0)]),
        of("a bubble", vec![ball(0.12, 1.5, 0), ball(0.1199, 1.0, 1)]),
        index("index 1", Holds(WHY), 1.0),
        index("index 4", Holds(WHY), 4.0),
        index("index 0.99", Refused("ior", RANGE), 0.99),
        index("index 4.01", Refused("ior", RANGE), 4.01),
    ]
}
