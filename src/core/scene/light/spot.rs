//! A cone of light from one point, even inside and fading out at its edge.

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::common::{Common, Illumination, LightRole, check_lamp, check_target};
use super::emission::{Cone, Emission, Profile, Source, Sphere};
use crate::Result;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};

/// A spot light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Common::SETTINGS), transform = Describe(Self::SETTINGS))]
pub struct SpotLight {
    /// Its name.
    pub name: String,
    /// What it does in the picture.
    pub role: LightRole,
    /// Whether it shines ([`Common::ENABLED`]).
    pub enabled: bool,
    /// Power of the whole cone (W).
    pub watts: f32,
    /// Factor on the power, linear Rec.709.
    pub colour: [f32; 3],
    /// World (m).
    pub position: [f32; 3],
    /// The point it looks at, world (m).
    pub target: [f32; 3],
    /// Opening angle of the cone from edge to edge, degrees.
    pub angle_deg: f32,
    /// Share of the cone over which it fades.
    pub soft_edge: f32,
}

settings! { SpotLight {
    /// Opening angle of the cone from edge to edge.
    ANGLE = Setting::real("scene.lights[spot].angle_deg", [0.1, 360.0], &[40.0]).unit("°");
    /// Share of the cone over which the light fades; 0 is sharp.
    SOFT_EDGE = Setting::real("scene.lights[spot].soft_edge", [0.0, 1.0], &[0.15]);
} }

impl Default for SpotLight {
    fn default() -> Self {
        Self {
            name: Common::DEFAULT_NAME.into(),
            role: LightRole::default(),
            enabled: Common::ENABLED.is_on(),
            watts: Common::WATTS.value(),
            colour: Common::COLOUR.value(),
            position: Common::POSITION.value(),
            target: Common::TARGET.value(),
            angle_deg: Self::ANGLE.value(),
            soft_edge: Self::SOFT_EDGE.value(),
        }
    }
}

impl SpotLight {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        check_lamp(place, self.watts, self.colour, self.position)?;
        Self::ANGLE.check(self.angle_deg, place)?;
        Self::SOFT_EDGE.check(self.soft_edge, place)?;
        check_target(place, self.position, self.target)
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
