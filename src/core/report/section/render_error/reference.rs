//! What the light would be with many more photons, and how far a picture is from it.

use glam::Vec3;

use crate::Result;
use crate::pipeline::{Passed, Rehearsal};
use crate::render::{Image, View, plane_picture};
use crate::report::crop::{Crop, shrunk};
use crate::report::ssim::ssim;

/// Largest change of a still pixel from one frame to the next, as a share of its light.
const STILL: f32 = 0.02;
/// Least light of a still pixel, as a share of the mean.
const LIT: f32 = 0.1;
/// Least share of still pixels that tell something of their noise.
const ENOUGH: f64 = 1e-3;

/// Linear pictures of the plane at neighbouring frames; the second is absent where nothing moves.
pub(super) struct Seen(Vec<Image>);

/// How a picture of the plane is shown.
pub(super) struct Shown {
    pub(super) view: View,
    /// Most pixels side by side.
    pub(super) width: usize,
}

/// Two independent halves of a long run.
pub(super) struct Reference {
    crop: Crop,
    /// The first frame by each half, the lit part alone.
    halves: [Image; 2],
    shown: Shown,
    /// Their mean as it is shown.
    pub(super) picture: Image,
    /// Mean radiance of the lit part.
    mean: f64,
    still: Vec<usize>,
    /// The noise of the mean of the halves, over the mean light: root mean square.
    pub(super) noise: f64,
    /// See [`Error::flicker`], of the reference itself.
    pub(super) flicker: Option<f64>,
}

/// How far a picture is from the reference.
pub(super) struct Distance {
    /// Root mean square difference over the mean light.
    pub(super) rms: f64,
    /// 1 - SSIM of the pictures as they are shown.
    pub(super) perceptual: f64,
    /// Root mean square change from one frame to the next where the reference stands still, over the mean light there;
    /// none where too little stands still.
    pub(super) flicker: Option<f64>,
    /// The picture as it is shown.
    pub(super) picture: Image,
}

impl Seen {
    /// The light of all frames of a take.
    pub(super) fn of(passed: &Passed, frames: usize, rehearsal: &Rehearsal) -> Result<Self> {
        let picture = |index| Ok(plane_picture(&passed.light(index)?, rehearsal.extent(), rehearsal.paper()));
        (0..frames).map(picture).collect::<Result<_>>().map(Self)
    }
}

impl Reference {
    /// Of two halves; none where there is no light.
    pub(super) fn new(halves: [&Seen; 2], shown: Shown) -> Option<Self> {
        let frames = halves[0].0.len();
        let means: Vec<Image> =
            (0..frames).map(|frame| mean(&halves[0].0[frame], &halves[1].0[frame])).collect();
        let crop = Crop::lit(means.first()?);
        let halves = halves.map(|half| crop.cut(&half.0[0]));
        let means: Vec<Image> = means.iter().map(|picture| crop.cut(picture)).collect();
        let light = mean_light(&means[0].pixels);
        if !(light > 0.0 && light.is_finite()) {
            return None;
        }
        // Half their difference is the noise of their mean.
        let noise = 0.5 * root(product(&halves[0], &halves[1], |a, b| (a - b) * (a - b))) / light;
        let still = match means.as_slice() {
            [now, next, ..] => still(now, next, light as f32),
            _ => Vec::new(),
        };
        let picture = shown.picture(&means[0]);
        let mut reference = Self { crop, halves, shown, picture, mean: light, still, noise, flicker: None };
        reference.flicker = reference.flicker(&means);
        Some(reference)
    }

    /// How far the light of a take is from this. The noise of the reference does not count: the two halves err
    /// independently, so that the product of the differences to both has none of it in the mean.
    pub(super) fn distance(&self, seen: &Seen) -> Distance {
        let frames: Vec<Image> = seen.0.iter().map(|picture| self.crop.cut(picture)).collect();
        let [a, b] = &self.halves;
        let terms = frames[0].pixels.iter().zip(a.pixels.iter().zip(&b.pixels));
        let sum: f64 = terms.map(|(&x, (&a, &b))| ((x - a) * (x - b)).as_dvec3().element_sum()).sum();
        let rms = root(sum / (3 * a.pixels.len()) as f64) / self.mean;
        let picture = self.shown.picture(&frames[0]);
        let perceptual = 1.0 - ssim(&picture, &self.picture);
        Distance { rms, perceptual, flicker: self.flicker(&frames), picture }
    }

    fn flicker(&self, frames: &[Image]) -> Option<f64> {
        let [now, next, ..] = frames else { return None };
        let enough = self.still.len() as f64 >= ENOUGH * now.pixels.len() as f64;
        if !enough || self.still.is_empty() {
            return None;
        }
        let pick = |picture: &Image| self.still.iter().map(|&i| picture.pixels[i]).collect::<Vec<_>>();
        let (now, next) = (pick(now), pick(next));
        let squares = now.iter().zip(&next).map(|(a, b)| f64::from((*b - *a).length_squared()));
        let light = mean_light(&pick(&self.halves[0]));
        (light > 0.0).then(|| root(squares.sum::<f64>() / (3 * now.len()) as f64) / light)
    }

    /// Share of the lit part that stands still.
    pub(super) fn still_share(&self) -> f64 {
        self.still.len() as f64 / self.halves[0].pixels.len().max(1) as f64
    }
}

impl Shown {
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

/// Mean over pixels and colours of a product of two pictures.
fn product(a: &Image, b: &Image, of: impl Fn(Vec3, Vec3) -> Vec3) -> f64 {
    let terms = a.pixels.iter().zip(&b.pixels).map(|(&a, &b)| of(a, b).as_dvec3().element_sum());
    terms.sum::<f64>() / (3 * a.pixels.len().max(1)) as f64
}

/// A mean square that chance made negative is none.
fn root(mean_square: f64) -> f64 {
    mean_square.max(0.0).sqrt()
}

/// Pixels that are lit and do not change.
fn still(now: &Image, next: &Image, light: f32) -> Vec<usize> {
    let stands = |(i, (a, b)): (usize, (&Vec3, &Vec3))| {
        let (own, change) = (a.element_sum() / 3.0, (*b - *a).abs().element_sum() / 3.0);
        (own >= LIT * light && change <= STILL * own).then_some(i)
    };
    now.pixels.iter().zip(&next.pixels).enumerate().filter_map(stands).collect()
}
