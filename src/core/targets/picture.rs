//! Sampling of points from a picture, with density proportional to brightness.

use std::path::Path;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::decode::{self, Picture, linear_from_srgb};
use super::points::Points;
use super::settings::{Channel, ImageTarget};
use crate::math::colour::luminance;
use crate::math::distribution::Distribution2;
use crate::math::rng::{Purpose, Stream};
use crate::math::sobol;
use crate::{Error, Progress, Result};

/// Larger pictures are averaged down to at most this many cells a side: finer than any plane texture.
const MAX_CELLS: usize = 2048;

/// Points of a picture by which it is told how much of it lies beyond the edge.
const PROBES: usize = 4096;
/// Share of a picture that is missed.
const SEEN: f32 = 0.01;

/// The sampling distribution of a picture that lies on the plane.
#[derive(Clone, Debug)]
pub struct PictureSampler {
    brightness: Distribution2,
    /// Colour of each cell divided by its brightness; empty unless the target takes colours.
    colours: Vec<Vec3>,
    /// Pixels along the side of a cell.
    block: usize,
    /// Pixels.
    size: Vec2,
    /// The picture's centre, and one pixel to the right and up, in the plane.
    frame: (Vec2, Vec2, Vec2),
    notes: Vec<String>,
}

impl PictureSampler {
    /// Reads the picture at `path`, placed as `target` says on a receiver of `extent`; `place` is the target's path in
    /// the project, for messages.
    ///
    /// # Errors
    /// `Value` when a setting is out of range; `Io`, `Format` or `Limit` when the file cannot be used, or has no light.
    pub fn load(path: &Path, target: &ImageTarget, extent: Vec2, place: &str) -> Result<Self> {
        Self::load_cancellable(path, target, (extent, place), &Progress::new())
    }

    /// As [`Self::load`], until it is cancelled.
    ///
    /// # Errors
    /// Those of [`Self::load`]; `Cancelled`.
    pub(crate) fn load_cancellable(
        path: &Path,
        target: &ImageTarget,
        (extent, place): (Vec2, &str),
        progress: &Progress,
    ) -> Result<Self> {
        target.check(place)?;
        let picture = decode::read(path, progress)?;
        let mut notes = picture.notes.clone();
        let mut cells = Cells::of(&picture, target, target.channel, progress)?;
        notes.extend(note_on_bad(path, cells.bad_pixels));
        if target.channel == Channel::Brightness && cells.black_with_shape {
            cells = Cells::of(&picture, target, Channel::Alpha, progress)?;
            notes.push(format!("'{}' is black all over: its opacity is used as brightness", path.display()));
        }
        let Some(brightness) = Distribution2::new(&cells.weights, cells.width) else {
            return Err(Error::format(path, "", no_light(target)));
        };
        let size = Vec2::new(picture.width as f32, picture.height as f32);
        let (centre, right, up) = target.placement.frame(picture.shown_size(), extent);
        let frame = (centre, right * picture.aspect, up);
        let block = cells.block;
        let colours = if target.colour { cells.relative_colours() } else { Vec::new() };
        let mut sampler = Self { brightness, colours, block, size, frame, notes };
        sampler.notes.extend(sampler.note_on_place(path, extent, place));
        Ok(sampler)
    }

    /// A note on a picture of which some lies beyond the plane's edge.
    fn note_on_place(&self, path: &Path, extent: Vec2, place: &str) -> Option<String> {
        let points = self.sample(0, 0, PROBES).positions;
        let is_beyond = |point: &&Vec2| **point != point.clamp(Vec2::ZERO, extent);
        let share = points.iter().filter(is_beyond).count() as f32 / PROBES as f32;
        (share > SEEN).then(|| {
            format!(
                "{:.0} % of the light of '{}' lies beyond the edge, where it is lost; move the picture ({place}.placement.centre), or make \
                 it smaller ({place}.placement.width)",
                100.0 * share,
                path.display()
            )
        })
    }

    /// Warnings about the file.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The `n` points of `pass`.
    ///
    /// Scrambled Sobol points through the inverse of the brightness's cumulative distribution: all passes together
    /// are one low-discrepancy sequence. Between pixels the brightness is bilinear, so no pixel grid shows.
    pub fn sample(&self, seed: u64, pass: u64, n: usize) -> Points {
        let scramble = Stream::new(seed, Purpose::Target, 0, 0).u32();
        let first = (pass as u32).wrapping_mul(n as u32);
        let draw =
            |i: usize| self.brightness.sample(sobol::scrambled(first.wrapping_add(i as u32), scramble));
        let positions =
            (0..n).into_par_iter().with_min_len(4096).map(|i| self.plane_from_sample(&draw(i))).collect();
        let colours = if self.colours.is_empty() {
            Vec::new()
        } else {
            let width = self.brightness.size()[0];
            let colour = |i: usize| {
                let [column, row] = draw(i).cell;
                self.colours[row * width + column]
            };
            (0..n).into_par_iter().with_min_len(4096).map(colour).collect()
        };
        Points { positions, colours }.with_mean_luminance_one()
    }

    /// The point of a sample: tent-distributed over two cells' width, which makes the density the bilinear interpolation.
    fn plane_from_sample(&self, sample: &crate::math::distribution::Sample2) -> Vec2 {
        let cell = Vec2::new(sample.cell[0] as f32, sample.cell[1] as f32) + 0.5;
        let offset = Vec2::new(tent(sample.within.x), tent(sample.within.y));
        // Mirrored at the border, which is interpolation by the outermost pixels' values.
        let pixel = mirror((cell + offset) * self.block as f32, self.size);
        let (centre, right, up) = self.frame;
        centre + right * (pixel.x - self.size.x / 2.0) + up * (self.size.y / 2.0 - pixel.y)
    }
}

/// Inverse cumulative distribution of the tent 1 - |x| on [-1, 1].
fn tent(u: f32) -> f32 {
    if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() }
}

fn mirror(point: Vec2, size: Vec2) -> Vec2 {
    let inside = point.abs();
    (size - (size - inside).abs()).max(Vec2::ZERO)
}

fn no_light(target: &ImageTarget) -> &'static str {
    if target.threshold > 0.0 {
        "the target has no light: no pixel is as bright as the threshold; lower it"
    } else {
        "the target has no light: every pixel is black or transparent; use another picture, or `invert`"
    }
}

/// The picture averaged to cells.
pub(super) struct Cells {
    pub(super) width: usize,
    /// Pixels along the side of a cell.
    block: usize,
    /// Sum over the cell's pixels of what attracts photons.
    pub(super) weights: Vec<f32>,
    /// Sum of the colours, when asked for.
    colours: Vec<Vec3>,
    bad_pixels: usize,
    /// No pixel has any colour, but not all are equally opaque.
    pub(super) black_with_shape: bool,
}

impl Cells {
    pub(super) fn of(
        picture: &Picture,
        target: &ImageTarget,
        channel: Channel,
        progress: &Progress,
    ) -> Result<Self> {
        let block = picture.width.max(picture.height).div_ceil(MAX_CELLS);
        let (width, height) = (picture.width.div_ceil(block), picture.height.div_ceil(block));
        let coloured = if target.colour { width * height } else { 0 };
        let mut cells = Self {
            width,
            block,
            weights: vec![0.0; width * height],
            colours: vec![Vec3::ZERO; coloured],
            bad_pixels: 0,
            black_with_shape: false,
        };
        let threshold = linear_from_srgb(target.threshold);
        let (mut black, mut alphas) = (true, (f32::INFINITY, f32::NEG_INFINITY));
        let mut line = Vec::with_capacity(picture.width);
        for row in 0..picture.height {
            progress.check()?;
            picture.read_row(row, &mut line);
            for (column, pixel) in line.iter_mut().enumerate() {
                cells.bad_pixels += usize::from(clean(pixel));
                let (colour, alpha) = (Vec3::from_slice(pixel), pixel[3].min(1.0));
                black &= colour == Vec3::ZERO;
                alphas = (alphas.0.min(alpha), alphas.1.max(alpha));
                let (weight, colour) = attraction(colour, alpha, target.invert, channel);
                if weight >= threshold {
                    let cell = row / block * width + column / block;
                    cells.weights[cell] += weight;
                    if let Some(sum) = cells.colours.get_mut(cell) {
                        *sum += colour;
                    }
                }
            }
        }
        cells.black_with_shape = black && !target.invert && alphas.0 < alphas.1;
        Ok(cells)
    }

    fn relative_colours(self) -> Vec<Vec3> {
        let relative =
            |(colour, weight): (Vec3, f32)| if weight > 0.0 { colour / weight } else { Vec3::ZERO };
        self.colours.into_iter().zip(self.weights).map(relative).collect()
    }
}

/// Weight and colour of a pixel whose colour is premultiplied.
fn attraction(colour: Vec3, alpha: f32, invert: bool, channel: Channel) -> (f32, Vec3) {
    let colour =
        if invert && channel == Channel::Brightness { (alpha - colour).max(Vec3::ZERO) } else { colour };
    match channel {
        Channel::Brightness => (luminance(colour), colour),
        Channel::Alpha if invert => (1.0 - alpha, colour),
        Channel::Alpha => (alpha, colour),
    }
}

/// A note on the pixels of a file that [`clean`] changed.
pub(super) fn note_on_bad(path: &Path, pixels: usize) -> Option<String> {
    (pixels > 0).then(|| {
        let path = path.display();
        format!("'{path}': {pixels} pixels hold NaN, infinite or negative values, which count as 0")
    })
}

/// Values that are no amounts of light become 0; returns whether there were any.
pub(super) fn clean(pixel: &mut [f32; 4]) -> bool {
    let mut bad = false;
    for value in pixel {
        if !(value.is_finite() && *value >= 0.0) {
            *value = 0.0;
            bad = true;
        }
    }
    bad
}
