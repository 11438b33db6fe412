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

use glam::{DVec4, Vec4};
use rayon::prelude::*;

use super::texture::ReceiverTexture;

/// The share of the variance kept by a radius from pass to pass, Knaus and Zwicker's alpha.
const ALPHA: f64 = 2.0 / 3.0;
/// Boxes in a row.
const BOXES: usize = 3;
/// Columns filtered together: two cache lines.
const STRIP: usize = 8;

/// The kernel radius of pass `pass` (from 0), from that of the first, both in plane units:
/// r_(i+1)^2 = r_i^2 (i + 2/3) / (i + 1), i = 1, 2, ...
pub fn radius_of_pass(first: f32, pass: usize) -> f32 {
    let shrink: f64 = (1..=pass).map(|i| (i as f64 + ALPHA) / (i as f64 + 1.0)).product();
    (first as f64 * shrink.sqrt()) as f32
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

impl ReceiverTexture {
    /// Spreads the light with the kernel of `radius` (plane units), which reaches as far as the radius along each axis
    /// and has the variance radius^2/9. Flux is conserved: at the border the kernel is reflected.
    pub fn filter(&mut self, radius: f32) {
        let variance = (radius / self.layout().texel).powi(2) as f64 / 9.0 / BOXES as f64;
        let kernel = Box1::with_variance(variance);
        if kernel.is_identity() {
            return;
        }
        let (columns, rows) = (self.layout().columns, self.layout().rows);
        let texels = self.texels();
        let strips: Vec<Vec<[Vec4; STRIP]>> = (0..columns.div_ceil(STRIP))
            .into_par_iter()
            .map_init(Lines::default, |lines, strip| {
                let first = strip * STRIP;
                let width = STRIP.min(columns - first);
                let column = texels.chunks_exact(columns).map(|row| {
                    let mut group = [Vec4::ZERO; STRIP];
                    group[..width].copy_from_slice(&row[first..first + width]);
                    group
                });
                lines.filter(column, rows, &kernel).to_vec()
            })
            .collect();
        let by_row = self.texels_mut().par_chunks_exact_mut(columns).enumerate();
        by_row.for_each_init(Lines::default, |lines, (y, row)| {
            let line = (0..columns).map(|x| [strips[x / STRIP][y][x % STRIP]]);
            let filtered = lines.filter(line, columns, &kernel);
            row.iter_mut().zip(filtered).for_each(|(texel, &[value])| *texel = value);
        });
    }
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
    fn apply<const W: usize>(&self, from: &[[Vec4; W]], to: &mut [[Vec4; W]]) {
        let length = 2 * self.half + 1;
        let norm = 1.0 / (length as f64 + 2.0 * self.edge);
        // In f64: a running sum in f32 would leave a residue of bright texels behind.
        let mut sum = [DVec4::ZERO; W];
        for cell in &from[1..length] {
            (0..W).for_each(|lane| sum[lane] += cell[lane].as_dvec4());
        }
        let before = from;
        let last = &from[length..];
        let after = &from[length + 1..];
        for (i, out) in to.iter_mut().enumerate() {
            for lane in 0..W {
                sum[lane] += last[i][lane].as_dvec4();
                let edges = (before[i][lane] + after[i][lane]).as_dvec4();
                out[lane] = ((sum[lane] + edges * self.edge) * norm).as_vec4();
                sum[lane] -= before[i + 1][lane].as_dvec4();
            }
        }
    }
}

/// Two buffers between which the boxes go to and fro, kept by each thread.
#[derive(Default)]
struct Lines<const W: usize> {
    from: Vec<[Vec4; W]>,
    to: Vec<[Vec4; W]>,
}

impl<const W: usize> Lines<W> {
    /// All boxes over a line of `count` cells.
    fn filter(&mut self, line: impl Iterator<Item = [Vec4; W]>, count: usize, kernel: &Box1) -> &[[Vec4; W]] {
        let reach = kernel.half + 1;
        self.to.clear();
        self.to.extend(line);
        for _ in 0..BOXES {
            // Reflected with the edge cell repeated, as often as the kernel is longer than the line.
            let mirror = |i: isize| {
                let i = i.rem_euclid(2 * count as isize) as usize;
                if i < count { i } else { 2 * count - 1 - i }
            };
            self.from.clear();
            self.from.extend((0..reach).map(|i| self.to[mirror(i as isize - reach as isize)]));
            self.from.extend_from_slice(&self.to);
            self.from.extend((0..reach).map(|i| self.to[mirror((count + i) as isize)]));
            kernel.apply(&self.from, &mut self.to);
        }
        &self.to
    }
}
