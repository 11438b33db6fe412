//! From linear light to what a screen shows: exposure and view transform.
//!
//! *agx* is Troy Sobotka's AgX in the polynomial fit of Benjamin Wrensch (*Minimal AgX implementation*, iolite-engine.com,
//! 2024): bright colours bleach towards white as on film, instead of clipping to a flat tone. The rows of its
//! matrix are normalised here, so that grey stays grey exactly, and its curve is stretched by 0.4 % to reach black
//! and white. Its values are meant for a display with the exponent 2.2 and are written as they are, as Blender does.
//! *standard* is the sRGB curve of IEC 61966-2-1: colours as they are, clipped at 1.

use glam::{DMat3, DVec3, Mat3, Vec3};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wide::f32x4;

use super::image::Image;
use crate::Result;
use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};

/// The function from light to screen colours ([`ViewSettings::TRANSFORM`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(transform = Describe(ViewSettings::TRANSFORM))]
pub enum ViewTransform {
    /// AgX, filmic.
    #[default]
    Agx,
    /// The sRGB curve.
    Standard,
}

/// How the PNG pictures show the light; the EXR files hold it unchanged.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct ViewSettings {
    /// Exposure in stops ([`Self::EXPOSURE`]).
    pub exposure: f32,
    /// The view transform ([`Self::TRANSFORM`]).
    pub transform: ViewTransform,
}

settings! { ViewSettings {
    /// Exposure of the PNG pictures and the preview: each stop doubles the light. EXR files hold it unchanged.
    EXPOSURE = Setting::real("render.view.exposure", [-32.0, 32.0], &[0.0]).unit("EV");
    /// View transform of the PNG pictures and the preview, from light to the colours of a screen.
    TRANSFORM = Setting::choice("render.view.transform", &[
        Choice { value: "agx", help: "filmic: highlights roll off and bleach towards white" },
        Choice { value: "standard", help: "the plain sRGB curve, clipped at white" },
    ]);
} }

impl ViewSettings {
    /// Refuses an exposure out of range, naming `place.exposure`.
    pub fn check(&self, place: &str) -> Result<()> {
        Self::EXPOSURE.check(self.exposure, place)
    }

    /// The resolved transform.
    pub fn view(&self) -> View {
        View { gain: self.exposure.exp2(), transform: self.transform, agx: Agx::new() }
    }
}

/// A resolved view transform.
#[derive(Clone, Debug)]
pub struct View {
    gain: f32,
    transform: ViewTransform,
    agx: Agx,
}

impl View {
    /// Screen values 0..=1 (encoded, not linear) of a linear colour; negative values and NaN are black.
    pub fn encode(&self, linear: Vec3) -> Vec3 {
        let exposed = linear * self.gain;
        // Written so that NaN is black, too.
        let c = Vec3::from(exposed.to_array().map(|v| if v > 0.0 { v.min(f32::MAX) } else { 0.0 }));
        match self.transform {
            ViewTransform::Agx => self.agx.encode(c),
            ViewTransform::Standard => Vec3::from(c.to_array().map(srgb_from_linear)),
        }
    }

    /// A whole picture in screen values.
    pub fn apply(&self, image: &Image) -> Image {
        let pixels = image.pixels.par_iter().map(|&c| self.encode(c)).collect();
        Image { width: image.width, height: image.height, pixels }
    }
}

/// The sRGB curve: screen value of a linear one, clipped to 0..=1.
fn srgb_from_linear(v: f32) -> f32 {
    let v = v.min(1.0);
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

#[derive(Clone, Debug)]
struct Agx {
    inset: Mat3,
    outset: Mat3,
}

impl Agx {
    /// Stops from black to white, around middle grey.
    const MIN_EV: f32 = -12.473_93;
    const MAX_EV: f32 = 4.026_069;

    fn new() -> Self {
        let rows = [
            DVec3::new(0.842_479_062_253_094, 0.078_433_6, 0.079_223_745_147_764_3),
            DVec3::new(0.042_328_242_261_012_3, 0.878_468_636_469_772, 0.079_166_127_460_543_4),
            DVec3::new(0.042_375_654_905_705_1, 0.078_433_6, 0.879_142_973_793_104),
        ];
        let [r, g, b] = rows.map(|row| row / row.element_sum());
        let inset = DMat3::from_cols(r, g, b).transpose();
        Self { inset: inset.as_mat3(), outset: inset.inverse().as_mat3() }
    }

    fn encode(&self, linear: Vec3) -> Vec3 {
        let [r, g, b] = (self.inset * linear).to_array();
        let stops = f32x4::new([r, g, b, 1.0]).max(f32x4::splat(1e-10)).log2();
        let log = (stops - Self::MIN_EV) / (Self::MAX_EV - Self::MIN_EV);
        let [r, g, b, _] = curve(log.max(f32x4::ZERO).min(f32x4::ONE)).to_array();
        (self.outset * Vec3::new(r, g, b)).clamp(Vec3::ZERO, Vec3::ONE)
    }
}

/// Wrensch's fit of the AgX contrast curve, from 0 to 1.
fn curve(x: f32x4) -> f32x4 {
    let (black, white) = (FIT[0], FIT.iter().sum::<f32>());
    let fit = FIT.into_iter().rev().fold(f32x4::ZERO, |sum, factor| sum * x + factor);
    (fit - black) / (white - black)
}

/// The factors of its powers, from the zeroth.
const FIT: [f32; 7] = [-0.00232, 0.1191, 0.4298, -6.868, 31.96, -40.14, 15.5];
