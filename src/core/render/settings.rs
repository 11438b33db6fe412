//! What an artist decides about the picture.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::view::ViewSettings;
use crate::{Error, Result};

/// Size and quality of the pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct RenderSettings {
    /// Width of the picture in pixels, 16 to 16384. Default 1280.
    pub width: u32,
    /// Height of the picture in pixels, 16 to 16384. Default 720.
    pub height: u32,
    /// Passes, each with its own batch of photons, 1 to 100000: the noise falls and the caustic sharpens with each.
    /// Default 8.
    pub passes: u32,
    /// Photons per pass, 1 to 100000000. Default 1000000.
    pub photons: u64,
    /// Radius of the kernel in the first pass, as a share of the longer side of the receiver, above 0 to 0.5: larger is
    /// smoother, smaller sharper. Default: so that about fifty photons fall under the kernel.
    pub radius: Option<f32>,
    /// Largest number of texels along the longer side of the receiver, 64 to 8192; the picture's own sharpness decides
    /// below it. Default 2048.
    pub max_texels: u32,
    /// Camera samples per pixel towards the receiver, 1 to 4096. Default 16.
    pub camera_samples: u32,
    /// First light paths per pixel of the background, 1 to 65536; noisy pixels take up to 64 times as many. Default 16.
    pub background_samples: u32,
    /// How the PNG pictures show the light.
    pub view: ViewSettings,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self {
            width: 1280,
            height: 720,
            passes: 8,
            photons: 1_000_000,
            radius: None,
            max_texels: 2048,
            camera_samples: 16,
            background_samples: 16,
            view: ViewSettings::default(),
        }
    }
}

impl RenderSettings {
    /// Refuses values out of range, naming `place.field`.
    pub fn check(&self, place: &str) -> Result<()> {
        let counts = [
            ("width", self.width.into(), 16, 16_384),
            ("height", self.height.into(), 16, 16_384),
            ("passes", self.passes.into(), 1, 100_000),
            ("photons", self.photons, 1, 100_000_000),
            ("max_texels", self.max_texels.into(), 64, 8192),
            ("camera_samples", self.camera_samples.into(), 1, 4096),
            ("background_samples", self.background_samples.into(), 1, 65_536),
        ];
        for (field, value, least, most) in counts {
            if !(least..=most).contains(&value) {
                let what = format!("is {value}, but must lie between {least} and {most}");
                return Err(Error::value(format!("{place}.{field}"), what));
            }
        }
        if let Some(radius) = self.radius.filter(|r| !(*r > 0.0 && *r <= 0.5)) {
            let what = format!("is {radius}, but must lie above 0 and at most at 0.5 of the longer side");
            return Err(Error::value(format!("{place}.radius"), what));
        }
        self.view.check(&format!("{place}.view"))
    }
}
