//! What the lights have in common: settings and their checks, illumination, a frame around a direction.

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};
use crate::{Error, Result};

/// What a light does in the picture ([`Common::ROLE`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(transform = Describe(Common::ROLE))]
pub enum LightRole {
    /// Lights everything.
    #[default]
    All,
    /// Casts caustics alone.
    Caustics,
    /// Lights everything, and casts no caustics.
    Background,
}

/// The settings that lights share.
pub struct Common;

impl Common {
    /// The name of a light without one.
    pub(super) const DEFAULT_NAME: &str = "light";
}

settings! { Common {
    /// Name of the light in the list of caustics; each name once.
    NAME = Setting::text("scene.lights[].name");
    /// Off leaves the light in the list, but it emits nothing.
    ENABLED = Setting::switch("scene.lights[].enabled", true);
    /// Power of the whole light. A narrower cone of the same power is brighter.
    WATTS = Setting::real("scene.lights[].watts", [0.0, 1e9], &[10.0]).unit("W");
    /// Factor on the power, linear Rec.709.
    COLOUR = Setting::colour("scene.lights[].colour", [0.0, 1000.0], &[1.0, 1.0, 1.0]);
    /// Position of the light, x y z; y is up.
    POSITION = Setting::vector("scene.lights[].position", [-1e6, 1e6], &[0.0, 2.0, 0.0]).unit("m");
    /// What the light does in the picture.
    ROLE = Setting::choice("scene.lights[].role", &[
        Choice { value: "all", help: "lights everything, and casts caustics" },
        Choice { value: "caustics", help: "casts caustics alone: its own pool of light, shadows and reflections are left out" },
        Choice { value: "background", help: "lights everything, and casts no caustics, as a softbox whose own would be faint noise" },
    ]);
    /// The point the light looks at.
    TARGET = Setting::vector("scene.lights[].target", [-1e6, 1e6], &[0.0; 3]).unit("m");
} }

/// The illumination of a point by one light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illumination {
    /// Unit vector from the point to the light.
    pub direction: Vec3,
    /// Distance to the light (m); infinite for a directional one.
    pub distance: f32,
    /// RGB irradiance on a surface that faces it [W/m^2]; for area lights an unbiased sample.
    pub irradiance: Vec3,
}

/// Checks that all lights but the directional share.
pub(super) fn check_lamp(place: &str, watts: f32, colour: [f32; 3], position: [f32; 3]) -> Result<()> {
    Common::WATTS.check(watts, place)?;
    Common::COLOUR.check(colour, place)?;
    Common::POSITION.check(position, place)
}

/// Checks of the lights that look at a point.
pub(super) fn check_target(place: &str, position: [f32; 3], target: [f32; 3]) -> Result<()> {
    Common::TARGET.check(target, place)?;
    if position == target {
        return Err(Error::value(format!("{place}.target"), "is where the light stands: move one of them"));
    }
    Ok(())
}

/// Two unit vectors that complete the unit vector `z` to a right-handed frame (Duff et al. 2017).
pub(super) fn frame(z: Vec3) -> (Vec3, Vec3) {
    z.any_orthonormal_pair()
}
