//! The lamp that is made where a file has none: a spot from behind on the left, so that the caustic falls to the front.

use std::f32::consts::{PI, TAU};

use glam::{Vec3, vec3};

use super::draft::{Bounds, shortened};
use crate::scene::LightDesc;
use crate::scene::light::{Common, LightRole, SpotLight};

/// From the glass to the lamp.
const TOWARDS: Vec3 = vec3(-0.62, 0.62, -0.48);
/// Its distance in radii of the glass.
const DISTANCE: f32 = 9.0;
/// The cone over that in which the glass is seen.
const WIDER: f32 = 1.2;
/// The cone over that in which the glass is seen above which it lights the table around, too.
const POOL: f32 = 1.5;
/// Irradiance at the glass (W/m²): what it casts is brighter than a matt table beneath the faint sky.
const IRRADIANCE: f32 = 6.0;

/// A spot that shines on the glass, from a place or from one that is good. Its own pool of light would drown the caustic, so it
/// draws caustics alone.
pub(super) fn aimed_at(glass: &Bounds, place: Option<Vec3>) -> LightDesc {
    let (centre, radius) = (glass.centre(), glass.radius());
    let place = place.filter(|place| place.distance(centre) > 1.5 * radius);
    let position = place.unwrap_or(centre + TOWARDS.normalize() * (DISTANCE * radius));
    let distance = position.distance(centre);
    let half = (radius / distance).clamp(0.0, 0.95).asin() * WIDER;
    let solid_angle = TAU * (1.0 - half.cos());
    let watts = IRRADIANCE * distance * distance * solid_angle;
    LightDesc::Spot(SpotLight {
        name: "lamp".into(),
        role: LightRole::Caustics,
        watts: Common::WATTS.clamped(watts),
        position: position.to_array(),
        target: centre.to_array(),
        angle_deg: SpotLight::ANGLE.clamped(2.0 * half * 180.0 / PI),
        ..SpotLight::default()
    })
}

/// A note on lamps whose light on the table beside the glass takes from the contrast of its caustic.
pub(super) fn note_on_pools(lights: &[LightDesc], glass: &Bounds) -> Option<String> {
    let lights_table = |light: &&LightDesc| match light {
        _ if light.role() != LightRole::All => false,
        LightDesc::Spot(spot) => {
            let distance = Vec3::from(spot.position).distance(glass.centre());
            let needed = (glass.radius() / distance.max(1e-6)).clamp(0.0, 1.0).asin();
            spot.angle_deg.to_radians() / 2.0 > POOL * needed
        }
        _ => true,
    };
    let names: Vec<String> =
        lights.iter().filter(lights_table).map(|light| light.name().to_owned()).collect();
    (!names.is_empty()).then(|| {
        format!(
            "lights the table around the glass, too: {}; a caustic stands out more where its lamp casts caustics alone \
             (scene.lights[].role)",
            shortened(&names)
        )
    })
}
