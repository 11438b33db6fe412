//! The reference: the light of many more photons, and the error of a picture against it.

use glam::Vec3;

use crate::crop::{Crop, shrunk};
use crate::ssim::ssim;
use lightloom_core::Result;
use lightloom_core::engine::{FittedProject, PlaneLight};
use lightloom_core::render::density::KernelFilter;
use lightloom_core::render::{Image, ReceiverTexture, View, plane_image};

/// Largest change of a still pixel from one frame to the next, as a share of its light.
const STILL: f32 = 0.02;
/// Least light of a still pixel, as a share of the mean.
const LIT: f32 = 0.1;
/// Least share of still pixels for which noise is measured.
const ENOUGH: f64 = 1e-3;

/// Largest noise, over the mean light, of a reference that is sharper than the last pass.
const CLEAN: f64 = 0.05;
/// Kernel radii of the reference over that of the last pass, the sharpest first.
const SHARPER: [f32; 4] = [0.125, 0.25, 0.5, 1.0];
/// The sharpest.
pub(super) const SHARPEST: f32 = SHARPER[0];

/// Linear pictures of the plane at one or two consecutive frames; one where nothing moves.
pub(super) struct PlanePictures(Vec<Image>);

/// The display of a picture of the plane.
#[derive(Clone)]
pub(super) struct Display {
    pub(super) view: View,
    /// Largest width in pixels.
    pub(super) width: usize,
}

/// Two independent halves of a long run.
pub(super) struct Reference {
    crop: Crop,
    /// Cropped to the lit part.
    halves: [PlanePictures; 2],
    display: Display,
    /// Their mean, as displayed.
    pub(super) picture: Image,
    /// Mean radiance of the lit part.
    mean: f64,
    still: Vec<usize>,
    /// The kernel's radius, plane units.
    pub(super) radius: f32,
    /// The noise of the mean of the halves, over the mean light: root mean square.
    pub(super) noise: f64,
}

/// The error of a picture against the reference.
pub(super) struct LightError {
    /// Root mean square difference over the mean light.
    pub(super) rms: f64,
    /// 1 - SSIM of the displayed pictures.
    pub(super) perceptual: f64,
    /// Root mean square of the change from one frame to the next less that of the reference, where the reference stands
    /// still, over the mean light there; none where too little stands still.
    pub(super) flicker: Option<f64>,
    /// The picture, as displayed.
    pub(super) picture: Image,
}

impl PlanePictures {
    /// The light of all frames of a take.
    pub(super) fn of(passed: &PlaneLight, frames: usize, fitted: &FittedProject) -> Result<Self> {
        Ok(Self::spread(&light(passed, frames)?, 0.0, fitted))
    }

    /// Light spread by the kernel of this radius, plane units.
    fn spread(light: &[ReceiverTexture], radius: f32, fitted: &FittedProject) -> Self {
        let picture = |texture: &ReceiverTexture| {
            let mut texture = texture.clone();
            if radius > 0.0 {
                KernelFilter::default().filter(&mut texture, radius);
            }
            plane_image(&texture, fitted.extent(), fitted.plane_material())
        };
        Self(light.iter().map(picture).collect())
    }

    fn cut(&self, crop: &Crop) -> Self {
        Self(self.0.iter().map(|picture| crop.cut(picture)).collect())
    }
}

/// The light of all frames of a take, watts per texel.
pub(super) fn light(passed: &PlaneLight, frames: usize) -> Result<Vec<ReceiverTexture>> {
    (0..frames).map(|frame| passed.texture(frame)).collect()
}

impl Reference {
    /// The reference of two halves whose light is not filtered yet; none where there is no light. The kernel is the sharpest
    /// of [`SHARPER`] times `radius` that leaves little noise.
    pub(super) fn new(
        halves: [&[ReceiverTexture]; 2],
        radius: f32,
        fitted: &FittedProject,
        display: &Display,
    ) -> Option<Self> {
        SHARPER.iter().find_map(|share| {
            let halves = halves.map(|half| PlanePictures::spread(half, share * radius, fitted));
            let reference = Self::of(halves, share * radius, display.clone());
            // The widest at last, whatever its noise.
            reference.filter(|reference| *share >= 1.0 || reference.noise <= CLEAN)
        })
    }

    fn of(halves: [PlanePictures; 2], radius: f32, display: Display) -> Option<Self> {
        let crop = Crop::lit(&mean(&halves[0].0[0], &halves[1].0[0]));
        let halves = halves.map(|half| half.cut(&crop));
        let [a, b] = &halves;
        let means: Vec<Image> = a.0.iter().zip(&b.0).map(|(a, b)| mean(a, b)).collect();
        let light = mean_light(&means[0].pixels);
        if !(light > 0.0 && light.is_finite()) {
            return None;
        }
        // Half their difference is the noise of their mean.
        let differences = a.0[0].pixels.iter().zip(&b.0[0].pixels).map(|(a, b)| 0.5 * (*a - *b));
        let noise = root_mean(differences.map(|d| (d, d))) / light;
        let still = match means.as_slice() {
            [now, next, ..] => still(now, next, light as f32),
            _ => Vec::new(),
        };
        let picture = display.picture(&means[0]);
        Some(Self { crop, halves, display, picture, mean: light, still, radius, noise })
    }

    /// The error of the light of a take. The noise of the reference does not count: the errors of the halves are
    /// independent, so they cancel in the mean of the product of both differences.
    pub(super) fn distance(&self, seen: &PlanePictures) -> LightError {
        let seen = seen.cut(&self.crop);
        let [a, b] = self.halves.each_ref().map(|half| &half.0[0].pixels);
        let now = &seen.0[0];
        let terms = now.pixels.iter().zip(a.iter().zip(b)).map(|(&x, (&a, &b))| (x - a, x - b));
        let rms = root_mean(terms) / self.mean;
        let picture = self.display.picture(now);
        let perceptual = 1.0 - ssim(&picture, &self.picture);
        LightError { rms, perceptual, flicker: self.flicker(&seen), picture }
    }

    fn flicker(&self, seen: &PlanePictures) -> Option<f64> {
        let [now, next, ..] = seen.0.as_slice() else { return None };
        if self.still.is_empty() || self.still_share() < ENOUGH {
            return None;
        }
        let change = |now: &Image, next: &Image, i: usize| next.pixels[i] - now.pixels[i];
        let of_half = |half: &PlanePictures, i: usize| change(&half.0[0], &half.0[1], i);
        let [a, b] = &self.halves;
        let terms = self.still.iter().map(|&i| {
            let own = change(now, next, i);
            (own - of_half(a, i), own - of_half(b, i))
        });
        let lit: Vec<Vec3> =
            self.still.iter().map(|&i| 0.5 * (a.0[0].pixels[i] + b.0[0].pixels[i])).collect();
        Some(root_mean(terms) / mean_light(&lit))
    }

    /// Share of the lit part that stands still.
    pub(super) fn still_share(&self) -> f64 {
        self.still.len() as f64 / self.halves[0].0[0].pixels.len().max(1) as f64
    }
}

impl Display {
    fn picture(&self, linear: &Image) -> Image {
        self.view.apply(&shrunk(linear, self.width))
    }
}

fn mean(a: &Image, b: &Image) -> Image {
    let pixels = a.pixels.iter().zip(&b.pixels).map(|(a, b)| 0.5 * (*a + *b)).collect();
    Image { width: a.width, height: a.height, pixels }
}

/// Mean over pixels and colours.
fn mean_light(pixels: &[Vec3]) -> f64 {
    pixels.iter().map(|p| p.as_dvec3().element_sum()).sum::<f64>() / (3 * pixels.len().max(1)) as f64
}

/// Root of the mean product over pixels and colours; 0 where chance makes the mean negative.
fn root_mean(pairs: impl Iterator<Item = (Vec3, Vec3)>) -> f64 {
    let (sum, count) = pairs.fold((0.0, 0_usize), |(sum, count), (a, b)| {
        (sum + (a.as_dvec3() * b.as_dvec3()).element_sum(), count + 3)
    });
    (sum / count.max(1) as f64).max(0.0).sqrt()
}

/// Pixels that are lit and do not change.
fn still(now: &Image, next: &Image, light: f32) -> Vec<usize> {
    let stands = |(i, (a, b)): (usize, (&Vec3, &Vec3))| {
        let (own, change) = (a.element_sum() / 3.0, (*b - *a).abs().element_sum() / 3.0);
        (own >= LIT * light && change <= STILL * own).then_some(i)
    };
    now.pixels.iter().zip(&next.pixels).enumerate().filter_map(stands).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two halves and a run, flat light of 1 with errors of given sizes, all independent: multiples of different
    /// irrational numbers, uniform within -1/2..1/2.
    fn pictures(sizes: [f32; 3]) -> [Image; 3] {
        let error = |factor: f64, i: usize| ((i + 1) as f64 * factor).fract() as f32 - 0.5;
        let factors = [2_f64.sqrt(), 3_f64.sqrt(), 5_f64.sqrt()];
        [0, 1, 2].map(|k| {
            let pixels = (0..10_000).map(|i| Vec3::splat(1.0 + sizes[k] * error(factors[k], i))).collect();
            Image { width: 100, height: 100, pixels }
        })
    }

    #[test]
    fn the_noise_of_the_reference_is_not_taken_for_error() {
        let view = lightloom_core::render::ViewSettings::default().view();
        let [a, b, run] = pictures([0.4, 0.4, 0.2]);
        let seen = |picture: &Image| PlanePictures(vec![picture.clone()]);
        let reference = Reference::of([seen(&a), seen(&b)], 0.1, Display { view, width: 50 })
            .unwrap_or_else(|| panic!("light"));
        // The standard deviation of a uniform number over 1/sqrt(12); a mean of two has 1/sqrt(2) of it.
        let deviation = |size: f64| size / 12_f64.sqrt();
        assert!(
            (reference.noise / (deviation(0.4) / 2_f64.sqrt()) - 1.0).abs() < 0.02,
            "{}",
            reference.noise
        );
        let rms = reference.distance(&seen(&run)).rms;
        // Products of independent numbers vanish but for 1/sqrt of the pixels, 1 %, relative to squares.
        assert!((rms / deviation(0.2) - 1.0).abs() < 0.05, "{rms}");
        assert!(reference.distance(&seen(&run)).flicker.is_none(), "one frame does not flicker");
    }
}
