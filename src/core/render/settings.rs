//! What an artist decides about the picture.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::plate::PlateSettings;
use super::view::ViewSettings;
use crate::Result;
use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};

/// Size and quality of the pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct RenderSettings {
    /// Width of the picture in pixels.
    pub width: u32,
    /// Height of the picture in pixels.
    pub height: u32,
    /// Number of passes ([`Self::PASSES`]).
    pub passes: u32,
    /// Photons per pass ([`Self::PHOTONS`]).
    pub photons: u64,
    /// Radius of the kernel in the first pass, plane units ([`Self::RADIUS`]).
    pub radius: Option<f32>,
    /// Most texels along the longer side ([`Self::MAX_TEXELS`]).
    pub max_texels: u32,
    /// Camera samples per pixel towards the receiver.
    pub camera_samples: u32,
    /// First light paths per pixel of the background ([`Self::BACKGROUND_SAMPLES`]).
    pub background_samples: u32,
    /// Share of the physical caustic that glass keeps ([`Self::KEPT_IN_GLASS`]).
    pub kept_in_glass: f32,
    /// The picture behind the caustics, in place of a traced background.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plate: Option<PlateSettings>,
    /// How the PNG pictures show the light.
    pub view: ViewSettings,
}

settings! { RenderSettings {
    /// Width of the picture.
    WIDTH = Setting::whole("render.width", [16.0, 16_384.0], &[1280.0]).unit("px");
    /// Height of the picture.
    HEIGHT = Setting::whole("render.height", [16.0, 16_384.0], &[720.0]).unit("px");
    /// Photons per pass. More give less noise and need more memory.
    PHOTONS = Setting::whole("render.photons", [1.0, 1e8], &[1e6]);
    /// Passes, each with photons of its own: with each the noise falls and the caustic sharpens. Time grows alike.
    PASSES = Setting::whole("render.passes", [1.0, 100_000.0], &[8.0]);
    /// Radius of the kernel in the first pass, as a share of the plane's longer side. Larger is smoother, smaller sharper
    /// and noisier. By default about fifty photons fall under the kernel.
    RADIUS = Setting::real("render.radius", [0.0, 0.5], &[]).above();
    /// Most texels of the light along the plane's longer side; the sharpness of the picture decides below it. Raise it
    /// only for large pictures of a near plane.
    MAX_TEXELS = Setting::whole("render.max_texels", [64.0, 8192.0], &[2048.0]);
    /// Camera samples per pixel towards the plane. More smooth the edges of glass.
    CAMERA_SAMPLES = Setting::whole("render.camera_samples", [1.0, 4096.0], &[16.0]);
    /// First light paths per pixel of the picture without caustics; noisy pixels take up to 64 times as many, in glass 16
    /// times. More give less noise around the caustics.
    BACKGROUND_SAMPLES = Setting::whole("render.background_samples", [1.0, 65_536.0], &[16.0]);
    /// Share of the physical caustic that glass still shows once the light has left for a picture, beside the light of the
    /// moment. At 0 the glass goes dark with the table; so it should where one looks through glass at the picture.
    KEPT_IN_GLASS = Setting::real("render.kept_in_glass", [0.0, 1.0], &[1.0]);
    /// What stands behind the caustics. A plate is seen as it is, and the caustics are added to it.
    PLATE = Setting::choice("render.plate", &[
        Choice { value: "", help: "the scene, traced without caustics" },
        Choice { value: "", help: "a plate: a picture of yours, such as a photograph of the set" },
    ]);
} }

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            width: Self::WIDTH.value(),
            height: Self::HEIGHT.value(),
            passes: Self::PASSES.value(),
            photons: Self::PHOTONS.value(),
            radius: Self::RADIUS.value(),
            max_texels: Self::MAX_TEXELS.value(),
            camera_samples: Self::CAMERA_SAMPLES.value(),
            background_samples: Self::BACKGROUND_SAMPLES.value(),
            kept_in_glass: Self::KEPT_IN_GLASS.value(),
            plate: None,
            view: ViewSettings::default(),
        }
    }
}

impl RenderSettings {
    /// Refuses values out of range, naming `place.field`.
    pub fn check(&self, place: &str) -> Result<()> {
        Self::WIDTH.check(self.width, place)?;
        Self::HEIGHT.check(self.height, place)?;
        Self::PASSES.check(self.passes, place)?;
        Self::PHOTONS.check(self.photons, place)?;
        Self::MAX_TEXELS.check(self.max_texels, place)?;
        Self::CAMERA_SAMPLES.check(self.camera_samples, place)?;
        Self::BACKGROUND_SAMPLES.check(self.background_samples, place)?;
        Self::RADIUS.check(self.radius, place)?;
        Self::KEPT_IN_GLASS.check(self.kept_in_glass, place)?;
        self.plate.iter().try_for_each(|plate| plate.check(&format!("{place}.plate")))?;
        self.view.check(&format!("{place}.view"))
    }
}
