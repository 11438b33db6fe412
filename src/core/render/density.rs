//! Density estimation: the kernel that makes light out of counted photons, and its radius per pass.
//!
//! On a plane, progressive photon mapping with one radius per pass (Knaus and Zwicker 2011, *Progressive photon
//! mapping: a probabilistic approach*) is a histogram of each pass, filtered with the radius of that pass, and the mean
//! over the passes.
//!
//! The kernel is a box applied three times along rows and columns: the quadratic B-spline, smooth and round within
//! 3 %. Boxes of fractional length follow Gwosdek et al. 2011, *Theoretical foundations of Gaussian convolution by
//! extended box filtering*: a whole box plus a fraction of one texel on either side, with exactly the variance asked
//! for. Running sums make the cost independent of the radius.

use std::ops::Range;

use glam::Vec4;
use rayon::prelude::*;

use super::texture::ReceiverTexture;

/// The share of the variance kept by a radius from pass to pass, Knaus and Zwicker's alpha.
const ALPHA: f64 = 2.0 / 3.0;
/// Boxes in a row.
const BOXES: usize = 3;
/// Numbers per texel.
const LANES: usize = 4;
/// Columns, or rows, filtered side by side: two cache lines, and enough vector registers' worth of running sums.
const STRIP: usize = 8;

/// The texels of one row of a strip of columns, or of one column of a block of rows.
type Cell = [f32; LANES * STRIP];
const EMPTY: Cell = [0.0; LANES * STRIP];

/// The kernel radius of pass `pass` (from 0), from that of the first, both in plane units:
/// r_(i+1)^2 = r_i^2 (i + 2/3) / (i + 1), i = 1, 2, ...
pub fn radius_of_pass(first: f32, pass: usize) -> f32 {
    let shrink: f64 = (1..=pass).map(|i| (i as f64 + ALPHA) / (i as f64 + 1.0)).product();
    (f64::from(first) * shrink.sqrt()) as f32
}

/// A first radius, in plane units, for `photons` per pass spread over `area` (plane units squared): about fifty photons
/// under the kernel where the light is at its mean, so 14 % of noise there in the first pass, less in bright places and
/// with every pass.
pub fn default_radius(photons: usize, area: f32) -> f32 {
    // The kernel of radius r has the variance r^2/9 per axis, and averages as many photons as lie on 4 pi r^2/9.
    const UNDER_KERNEL: f32 = 50.0;
    let per_photon = area / photons.max(1) as f32;
    (9.0 * UNDER_KERNEL * per_photon / (4.0 * std::f32::consts::PI)).sqrt()
}

/// The filter with its buffers, kept from call to call.
#[derive(Debug, Default)]
pub struct Smoother {
    strips: Vec<Line>,
}

impl Smoother {
    /// Spreads the light with the kernel of `radius` (plane units), which reaches as far as the radius along each axis
    /// and has the variance radius^2/9. Flux is conserved: at the border the kernel is reflected.
    pub fn filter(&mut self, texture: &mut ReceiverTexture, radius: f32) {
        let variance = f64::from(radius / texture.layout().texel).powi(2) / 9.0 / BOXES as f64;
        let kernel = Box1::with_variance(variance);
        if kernel.is_identity() {
            return;
        }
        let columns = texture.layout().columns;
        self.strips.resize_with(columns.div_ceil(STRIP), Line::default);
        let texels: &[f32] = bytemuck::cast_slice(texture.texels());
        self.strips.par_iter_mut().enumerate().for_each(|(strip, line)| {
            let first = strip * STRIP;
            let width = STRIP.min(columns - first);
            let rows = texels.chunks_exact(LANES * columns).map(|row| {
                let mut cell = EMPTY;
                cell[..LANES * width].copy_from_slice(&row[LANES * first..LANES * (first + width)]);
                cell
            });
            line.filter(rows, &kernel);
        });
        let strips = &self.strips;
        let blocks = texture.texels_mut().par_chunks_mut(STRIP * columns).enumerate();
        blocks.for_each_init(Line::default, |line, (block, texels)| {
            let rows = texels.len() / columns;
            line.filter((0..columns).map(|x| across(strips, x, block * STRIP, rows)), &kernel);
            for (x, cell) in line.cells().iter().enumerate() {
                for (y, texel) in cell.as_chunks::<LANES>().0.iter().enumerate().take(rows) {
                    texels[y * columns + x] = Vec4::from_array(*texel);
                }
            }
        });
    }
}

/// The texels of column `x` in `rows` rows from `first` on.
fn across(strips: &[Line], x: usize, first: usize, rows: usize) -> Cell {
    let strip = &strips[x / STRIP].cells()[first..first + rows];
    let lane = x % STRIP * LANES;
    let mut cell = EMPTY;
    for (to, from) in cell.chunks_exact_mut(LANES).zip(strip) {
        to.copy_from_slice(&from[lane..lane + LANES]);
    }
    cell
}

/// A box of 2 `half` + 1 cells and `edge` of a cell more on either side.
#[derive(Clone, Copy, Debug)]
struct Box1 {
    half: usize,
    edge: f64,
}

impl Box1 {
    /// The box whose variance, in cells squared, is `variance`.
    fn with_variance(variance: f64) -> Self {
        // A box of 2k+1 cells has the variance k(k+1)/3; k is the largest that does not exceed it.
        let k = ((0.25 + 3.0 * variance).sqrt() - 0.5).floor().max(0.0);
        let missing = variance * (2.0 * k + 1.0) - k * (k + 1.0) * (2.0 * k + 1.0) / 3.0;
        let edge = missing / (2.0 * ((k + 1.0) * (k + 1.0) - variance));
        Self { half: k as usize, edge: edge.clamp(0.0, 1.0) }
    }

    fn is_identity(&self) -> bool {
        self.half == 0 && self.edge < 1e-9
    }

    /// One box over `from`, which reaches `half` + 1 cells further on either side than `to`.
    fn apply(&self, from: &[Cell], to: &mut [Cell]) {
        let length = 2 * self.half + 1;
        let norm = 1.0 / (length as f64 + 2.0 * self.edge);
        let edge = self.edge * norm;
        // In f64: a running sum in f32 would leave a residue of bright texels behind.
        let mut sum = [0.0_f64; LANES * STRIP];
        for cell in &from[1..length] {
            (0..LANES * STRIP).for_each(|lane| sum[lane] += f64::from(cell[lane]));
        }
        let entering = from[length..].iter().zip(&from[length + 1..]);
        let leaving = from.iter().zip(&from[1..]);
        for ((out, (last, after)), (before, first)) in to.iter_mut().zip(entering).zip(leaving) {
            for lane in 0..LANES * STRIP {
                sum[lane] += f64::from(last[lane]);
                out[lane] = (sum[lane] * norm + f64::from(before[lane] + after[lane]) * edge) as f32;
                sum[lane] -= f64::from(first[lane]);
            }
        }
    }
}

/// A line of cells with room for its reflection on either side, and a second one: boxes go from one to the other.
#[derive(Debug, Default)]
struct Line {
    padded: Vec<Cell>,
    other: Vec<Cell>,
    inside: Range<usize>,
}

impl Line {
    fn cells(&self) -> &[Cell] {
        &self.padded[self.inside.clone()]
    }

    /// Takes a line and applies all boxes to it.
    fn filter(&mut self, line: impl Iterator<Item = Cell>, kernel: &Box1) {
        let reach = kernel.half + 1;
        self.padded.clear();
        self.padded.resize(reach, EMPTY);
        self.padded.extend(line);
        self.inside = reach..self.padded.len();
        self.padded.resize(self.inside.end + reach, EMPTY);
        self.other.resize(self.padded.len(), EMPTY);
        for _ in 0..BOXES {
            self.reflect(reach);
            kernel.apply(&self.padded, &mut self.other[self.inside.clone()]);
            std::mem::swap(&mut self.padded, &mut self.other);
        }
    }

    /// Fills the room on either side; as often to and fro as it is longer than the line.
    fn reflect(&mut self, reach: usize) {
        let count = self.inside.len();
        let mirror = |i: isize| {
            let i = i.rem_euclid(2 * count as isize) as usize;
            reach + if i < count { i } else { 2 * count - 1 - i }
        };
        for i in 0..reach {
            self.padded[i] = self.padded[mirror(i as isize - reach as isize)];
            self.padded[reach + count + i] = self.padded[mirror((count + i) as isize)];
        }
    }
}
