//! Glass: refraction and reflection by Fresnel, absorption by Beer-Lambert, optional dispersion.

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Result;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};

/// Fraunhofer lines d, F and C [um], between which the Abbe number is defined.
const LINE_D: f32 = 0.587_56;
const LINE_F: f32 = 0.486_13;
const LINE_C: f32 = 0.656_27;

/// Clear or coloured glass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct Glass {
    /// Index of refraction at 587.6 nm.
    pub ior: f32,
    /// Absorption per metre, linear Rec.709.
    pub absorption: [f32; 3],
    /// Abbe number.
    pub dispersion: Option<f32>,
}

settings! { Glass {
    /// Index of refraction at 587.6 nm: water 1.33, window glass 1.52, diamond 2.42. Higher bends light more.
    IOR = Setting::real("scene.meshes[].material.ior", [1.0, 4.0], &[1.5]);
    /// Absorption, linear Rec.709: light falls to exp(-absorption x metres). The glass has the colour it absorbs least.
    ABSORPTION = Setting::colour("scene.meshes[].material.absorption", [0.0, 1e6], &[0.0; 3]).unit("1/m");
    /// Abbe number; none for no dispersion. Smaller spreads the colours more: crown glass 60, flint 36.
    DISPERSION = Setting::real("scene.meshes[].material.dispersion", [5.0, 1000.0], &[]);
} }

impl Default for Glass {
    fn default() -> Self {
        Self {
            ior: Self::IOR.value(),
            absorption: Self::ABSORPTION.value(),
            dispersion: Self::DISPERSION.value(),
        }
    }
}

impl Glass {
    pub(super) fn check(&self, place: &str) -> Result<()> {
        Self::IOR.check(self.ior, place)?;
        Self::ABSORPTION.check(self.absorption, place)?;
        Self::DISPERSION.check(self.dispersion, place)
    }

    /// Index of refraction at a wavelength (nm) by Cauchy's two-term equation n = A + B / lambda^2, fixed by index and
    /// Abbe number V = (n_d - 1) / (n_F - n_C); without dispersion or wavelength it is `ior`.
    pub fn index(&self, wavelength: Option<f32>) -> f32 {
        let (Some(abbe), Some(nm)) = (self.dispersion, wavelength) else { return self.ior };
        let inverse_square = |um: f32| 1.0 / (um * um);
        let b = (self.ior - 1.0) / (abbe * (inverse_square(LINE_F) - inverse_square(LINE_C)));
        self.ior + b * (inverse_square(nm / 1000.0) - inverse_square(LINE_D))
    }

    /// RGB transmittance over `distance` (m).
    pub fn transmittance(&self, distance: f32) -> Vec3 {
        if self.absorption == [0.0; 3] {
            return Vec3::ONE;
        }
        (Vec3::from(self.absorption) * -distance).exp()
    }
}
