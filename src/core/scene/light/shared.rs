//! What several kinds of light share: settings, default name, checks.

use crate::setting::{Setting, settings};
use crate::{Error, Result};

/// The settings that several kinds of light share.
pub struct LightSettings;

settings! { LightSettings {
    /// Name of the light in the list of caustics; each name once.
    NAME = Setting::text("scene.lights[].name");
    /// Power of the whole light. A narrower cone of the same power is brighter.
    WATTS = Setting::real("scene.lights[].watts", [0.0, 1e9], &[10.0]).unit("W");
    /// Factor on the power, linear Rec.709.
    COLOUR = Setting::colour("scene.lights[].colour", [0.0, 1000.0], &[1.0, 1.0, 1.0]);
    /// Position of the light, x y z; y is up.
    POSITION = Setting::vector("scene.lights[].position", [-1e6, 1e6], &[0.0, 2.0, 0.0]).unit("m");
    /// The point the light looks at.
    TARGET = Setting::vector("scene.lights[].target", [-1e6, 1e6], &[0.0; 3]).unit("m");
} }

/// The name of a light without one.
pub(super) const DEFAULT_NAME: &str = "light";

/// Checks that all lights but the directional share.
pub(super) fn check_lamp(place: &str, watts: f32, colour: [f32; 3], position: [f32; 3]) -> Result<()> {
    LightSettings::WATTS.check(watts, place)?;
    LightSettings::COLOUR.check(colour, place)?;
    LightSettings::POSITION.check(position, place)
}

/// Checks of the lights that look at a point.
pub(super) fn check_target(place: &str, position: [f32; 3], target: [f32; 3]) -> Result<()> {
    LightSettings::TARGET.check(target, place)?;
    if position == target {
        return Err(Error::value(format!("{place}.target"), "is where the light stands: move one of them"));
    }
    Ok(())
}
