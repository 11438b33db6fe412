//! A cone of light from one point, even inside and fading out at its edge.

use std::f32::consts::TAU;

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::emission::{Cone, Source};
use super::{Emission, Illumination, Sphere, check_power};
use crate::scene::check;
use crate::{Error, Result};

/// A spot light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SpotLight {
    /// Shown in the list of caustics. Default "light".
    pub name: String,
    /// Power of the whole cone [W], 0 to 1e9; a narrower cone is brighter. Default 10.
    pub watts: f32,
    /// Factor on the power, linear Rec.709, 0 to 1000. Default white.
    pub colour: [f32; 3],
    /// World [m]. Default (0, 2, 0).
    pub position: [f32; 3],
    /// The point it looks at, world [m]. Default the origin.
    pub target: [f32; 3],
    /// Opening angle of the cone from edge to edge in degrees, 0.1 to 360. Default 40.
    pub angle_deg: f32,
    /// Share of the cone over which it fades, 0 (sharp) to 1. Default 0.15.
    pub soft_edge: f32,
}

impl Default for SpotLight {
    fn default() -> Self {
        Self {
            name: "light".into(),
            watts: 10.0,
            colour: [1.0; 3],
            position: [0.0, 2.0, 0.0],
            target: [0.0; 3],
            angle_deg: 40.0,
            soft_edge: 0.15,
        }
    }
}

/// Relative intensity by direction, 0..=1.
#[derive(Clone, Debug)]
pub(super) struct Profile {
    axis: Vec3,
    /// 1 - cosine where the fading begins and ends.
    inner: f32,
    outer: f32,
}

impl Profile {
    /// Smoothstep in the cosine of the angle; its mean over the soft edge is one half.
    pub(super) fn at(&self, direction: Vec3) -> f32 {
        // 1 - cosine by the chord: accurate for narrow cones too.
        let off = (direction - self.axis).length_squared() / 2.0;
        if off <= self.inner {
            return 1.0;
        }
        let x = ((self.outer - off) / (self.outer - self.inner)).clamp(0.0, 1.0);
        x * x * (3.0 - 2.0 * x)
    }

    /// Integral over all directions [sr].
    fn solid_angle(&self) -> f32 {
        TAU * (self.inner + self.outer) / 2.0
    }
}

impl SpotLight {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        check_power(place, self.watts, self.colour)?;
        check::within(place, "position", &self.position, -1e6, 1e6)?;
        check::within(place, "target", &self.target, -1e6, 1e6)?;
        check::within(place, "angle_deg", &[self.angle_deg], 0.1, 360.0)?;
        check::within(place, "soft_edge", &[self.soft_edge], 0.0, 1.0)?;
        if self.position == self.target {
            return Err(Error::value(
                format!("{place}.target"),
                "is where the light stands: move one of them",
            ));
        }
        Ok(())
    }

    fn profile(&self) -> Profile {
        let axis = (Vec3::from(self.target) - Vec3::from(self.position)).normalize_or(Vec3::NEG_Y);
        let one_minus_cos = |degrees: f32| 2.0 * (degrees.to_radians() / 4.0).sin().powi(2);
        Profile {
            axis,
            inner: one_minus_cos(self.angle_deg * (1.0 - self.soft_edge)),
            outer: one_minus_cos(self.angle_deg),
        }
    }

    fn intensity(&self, profile: &Profile) -> Vec3 {
        Vec3::from(self.colour) * (self.watts / profile.solid_angle())
    }

    pub(super) fn emission(&self, target: Option<Sphere>) -> Emission {
        let origin = Vec3::from(self.position);
        let profile = self.profile();
        let own = Cone { axis: profile.axis, one_minus_cos: profile.outer };
        let aimed = target.map_or(Cone::ALL, |sphere| sphere.subtended_cone(origin));
        let cone = if aimed.one_minus_cos < own.one_minus_cos { aimed } else { own };
        let flux = self.intensity(&profile) * cone.solid_angle();
        Emission { flux, source: Source::Spot { origin, cone, profile } }
    }

    pub(super) fn illuminate(&self, point: Vec3) -> Option<Illumination> {
        let offset = Vec3::from(self.position) - point;
        let distance = offset.length();
        let profile = self.profile();
        let share = profile.at(-offset / distance);
        (share > 0.0).then(|| Illumination {
            direction: offset / distance,
            distance,
            irradiance: self.intensity(&profile) * (share / (distance * distance)),
        })
    }
}
