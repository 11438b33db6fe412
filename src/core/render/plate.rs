//! The plate: a picture that stands behind the caustics in place of the background that would be traced.
//!
//! Its light is taken as it is, times its exposure; the caustics are added to it unchanged, so that the layers of a frame
//! add up as without a plate. It fills the frame: scaled evenly, and cut where its shape is another.

use std::path::Path;

use glam::Vec3;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::image::Image;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};
use crate::targets::PictureLight;
use crate::{Error, Progress, Result};

/// Share of a side of the plate that may be cut without a note: shapes that are meant to be the same.
const TOLERATED_CUT: f32 = 0.005;

/// The picture behind the caustics.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct PlateSettings {
    /// PNG, JPEG, WebP, TIFF, OpenEXR or Radiance HDR file, relative to the project.
    pub file: String,
    /// Exposure in stops ([`Self::EXPOSURE`]).
    #[serde(default)]
    pub exposure: f32,
}

settings! { PlateSettings {
    /// PNG, JPEG, WebP, TIFF, OpenEXR or Radiance HDR file, relative to the project: one still picture, no sequence. It fills
    /// the frame; where its shape is another, it is cut evenly on both sides.
    FILE = Setting::part("render.plate.file");
    /// Exposure of the plate alone: each stop doubles its light, in all files. Match its table to that of the scene by it.
    EXPOSURE = Setting::real("render.plate.exposure", [-32.0, 32.0], &[0.0]).unit("EV");
} }

impl PlateSettings {
    /// A picture as it is.
    pub fn new(file: impl Into<String>) -> Self {
        Self { file: file.into(), exposure: Self::EXPOSURE.value() }
    }

    /// Refuses an empty file name and an exposure out of range, naming the field under `place`.
    pub fn check(&self, place: &str) -> Result<()> {
        if self.file.is_empty() {
            return Err(Error::value(format!("{place}.file"), "name a picture"));
        }
        Self::EXPOSURE.check(self.exposure, place)
    }
}

/// A plate of the size of the frame.
#[derive(Clone, Debug)]
pub struct Plate {
    /// Linear light.
    pub image: Image,
    /// Warnings about the file.
    pub notes: Vec<String>,
}

impl Plate {
    /// Reads the picture at `path` and makes it fill `width` x `height` pixels.
    ///
    /// # Errors
    /// `Io`, `Format` or `Limit` when the file cannot be used; `Cancelled`.
    pub fn load(
        path: &Path,
        settings: &PlateSettings,
        [width, height]: [usize; 2],
        progress: &Progress,
    ) -> Result<Self> {
        let mut light = PictureLight::load(path, progress)?;
        let ratio = glam::vec2(width as f32, height as f32) / light.shown;
        let kept = (ratio / ratio.max_element()).to_array();
        let cut = 1.0 - kept[0].min(kept[1]);
        if cut > TOLERATED_CUT {
            let [sides, wider] =
                if kept[0] < kept[1] { ["left and right", "wider"] } else { ["top and bottom", "higher"] };
            light.notes.push(format!(
                "'{}': {:.1} % are cut off at {sides}, since the plate is {wider} than the frame of {width} x {height}",
                path.display(),
                100.0 * cut
            ));
        }
        let gain = settings.exposure.exp2();
        let mut pixels = fitted(&light, kept, [width, height], progress)?;
        pixels.iter_mut().for_each(|pixel| *pixel *= gain);
        Ok(Self { image: Image { width, height, pixels }, notes: light.notes })
    }
}

/// The middle of a picture, these shares of its sides, in `width` x `height` pixels.
fn fitted(
    light: &PictureLight,
    kept: [f32; 2],
    [width, height]: [usize; 2],
    progress: &Progress,
) -> Result<Vec<Vec3>> {
    let columns = weights(light.size[0], kept[0], width);
    let rows = weights(light.size[1], kept[1], height);
    let across = |line: &[Vec3]| -> Result<Vec<Vec3>> {
        progress.check()?;
        let sum = |taps: &Taps| taps.iter().map(|&(i, weight)| line[i] * weight).sum();
        Ok(columns.iter().map(sum).collect())
    };
    let narrow: Vec<Vec<Vec3>> = light.pixels.par_chunks(light.size[0]).map(across).collect::<Result<_>>()?;
    let row = |taps: &Taps| {
        progress.check()?;
        let sum = |x: usize| taps.iter().map(|&(y, weight)| narrow[y][x] * weight).sum();
        Ok((0..width).map(sum).collect::<Vec<Vec3>>())
    };
    Ok(rows.par_iter().map(row).collect::<Result<Vec<_>>>()?.concat())
}

/// Pixels of a line and their weights, which sum to 1.
type Taps = Vec<(usize, f32)>;

/// The taps of `to` pixels that show the middle of a line of `from`, of which the share `kept` is seen. The filter is a tent as
/// wide as two pixels of the coarser line: exact where both are the same, linear between pixels of a small plate, without
/// aliasing of a large one.
fn weights(from: usize, kept: f32, to: usize) -> Vec<Taps> {
    let step = from as f64 * f64::from(kept) / to as f64;
    let start = from as f64 * (1.0 - f64::from(kept)) / 2.0;
    let reach = step.max(1.0);
    (0..to)
        .map(|i| {
            let centre = start + (i as f64 + 0.5) * step - 0.5;
            let (first, last) = ((centre - reach).ceil() as i64, (centre + reach).floor() as i64);
            let inside = |at: i64| at.clamp(0, from as i64 - 1) as usize;
            let tent = |at: i64| 1.0 - (at as f64 - centre).abs() / reach;
            let sum: f64 = (first..=last).map(tent).sum();
            let taps = (first..=last).map(|at| (inside(at), (tent(at) / sum) as f32));
            taps.filter(|(_, weight)| *weight > 0.0).collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A plate in whose red stands the column, in whose green the row.
    fn loaded(size: [usize; 2], frame: [usize; 2]) -> Plate {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("plate.exr");
        let pixel = |x, y| (x as f32 + 0.5, y as f32 + 0.5, 1.0_f32);
        exr::prelude::write_rgb_file(&path, size[0], size[1], pixel).unwrap();
        let settings = PlateSettings { exposure: 1.0, ..PlateSettings::new("plate.exr") };
        Plate::load(&path, &settings, frame, &Progress::new()).unwrap()
    }

    #[test]
    fn a_plate_of_the_frames_size_is_kept_to_the_bit() {
        let plate = loaded([40, 30], [40, 30]);
        assert!(plate.notes.is_empty(), "{:?}", plate.notes);
        for (i, pixel) in plate.image.pixels.iter().enumerate() {
            let (x, y) = ((i % 40) as f32, (i / 40) as f32);
            assert_eq!(*pixel, 2.0 * Vec3::new(x + 0.5, y + 0.5, 1.0));
        }
    }

    #[test]
    fn another_size_shows_the_same_places_and_another_shape_its_middle() {
        for (size, frame) in
            [([40, 30], [80, 60]), ([80, 60], [40, 30]), ([80, 30], [40, 30]), ([40, 60], [40, 30])]
        {
            let plate = loaded(size, frame);
            assert_eq!(plate.notes.len(), usize::from(size[0] * 3 != size[1] * 4), "{:?}", plate.notes);
            let scale = (size[0] as f32 / frame[0] as f32).min(size[1] as f32 / frame[1] as f32);
            // Away from the border, where the outermost pixels are repeated.
            for (x, y) in [(4, 4), (20, 15), (35, 25)] {
                let from_middle = glam::vec2(
                    x as f32 + 0.5 - frame[0] as f32 / 2.0,
                    y as f32 + 0.5 - frame[1] as f32 / 2.0,
                );
                let place = glam::vec2(size[0] as f32, size[1] as f32) / 2.0 + from_middle * scale;
                let seen = plate.image.at(x, y) / 2.0;
                // A filter that is even around its middle keeps a ramp, up to rounding.
                assert!(seen.truncate().distance(place) < 1e-3, "{size:?} {frame:?}: {seen} for {place}");
                assert!((seen.z - 1.0).abs() < 1e-6);
            }
        }
    }
}
