//! A short kernel as one weighted sum along each axis, done only where there is light.

use rayon::prelude::*;

use super::LANES;
use crate::render::texture::ReceiverTexture;

/// Texels that are dark or lit together. A kernel reaches no farther than to the next block.
const BLOCK: usize = 32;
/// Rows per task.
const BAND: usize = 16;
/// Numbers summed at once: four vector registers of eight.
const VECTOR: usize = 32;

/// The filter with its buffers, kept from call to call.
#[derive(Debug, Default)]
pub(super) struct Taps {
    /// The texture, filtered along its columns.
    upright: Vec<f32>,
    /// Whether a block of a row of the texture holds light, row by row.
    lit: Vec<bool>,
    /// The same of the texture filtered along its columns.
    lit_upright: Vec<bool>,
}

impl Taps {
    /// Filters by the weights of the middle and of each distance from it, which reach no farther than a block; at the
    /// border the kernel is reflected.
    pub(super) fn filter(&mut self, texture: &mut ReceiverTexture, weights: &[f32]) {
        let (columns, rows) = (texture.layout().columns, texture.layout().rows);
        let (width, blocks) = (LANES * columns, columns.div_ceil(BLOCK));
        let texels: &mut [f32] = bytemuck::cast_slice_mut(texture.texels_mut());
        self.lit.resize(rows * blocks, false);
        self.lit_upright.resize(rows * blocks, false);
        self.upright.resize(rows * width, 0.0);
        let marked = self.lit.par_chunks_mut(BAND * blocks).zip(texels.par_chunks(BAND * width));
        marked.for_each(|(lit, texels)| mark(lit, texels, width));
        let (source, lit) = (&*texels, &self.lit);
        let bands =
            self.upright.par_chunks_mut(BAND * width).zip(self.lit_upright.par_chunks_mut(BAND * blocks));
        bands.enumerate().for_each(|(band, (out, lit_out))| {
            let lines = out.chunks_exact_mut(width).zip(lit_out.chunks_exact_mut(blocks));
            for (i, (out, lit_out)) in lines.enumerate() {
                let near = around(band * BAND + i, weights.len() - 1, rows);
                upright_row(&near, (source, lit), weights, (out, lit_out));
            }
        });
        let (upright, lit) = (&self.upright, &self.lit_upright);
        texels.par_chunks_mut(BAND * width).enumerate().for_each_init(Vec::new, |padded, (band, out)| {
            for (i, out) in out.chunks_exact_mut(width).enumerate() {
                let row = band * BAND + i;
                let lit = &lit[row * blocks..][..blocks];
                pad(&upright[row * width..][..width], weights.len() - 1, padded);
                level_row(padded, lit, weights, out);
            }
        });
    }
}

/// Which blocks of some rows hold light.
fn mark(lit: &mut [bool], texels: &[f32], width: usize) {
    let blocks = texels.chunks_exact(width).flat_map(|row| row.chunks(LANES * BLOCK));
    lit.iter_mut().zip(blocks).for_each(|(lit, block)| *lit = block.iter().any(|&value| value != 0.0));
}

/// The rows as far as `reach` from `row`, from below upwards, reflected at the border as often as it takes.
fn around(row: usize, reach: usize, rows: usize) -> Vec<usize> {
    let mirror = |i: isize| {
        let i = i.rem_euclid(2 * rows as isize) as usize;
        i.min(2 * rows - 1 - i)
    };
    (0..=2 * reach).map(|i| mirror(row as isize + i as isize - reach as isize)).collect()
}

/// One row filtered along the columns, and which of its blocks hold light.
fn upright_row(
    near: &[usize],
    (source, lit): (&[f32], &[bool]),
    weights: &[f32],
    (out, lit_out): (&mut [f32], &mut [bool]),
) {
    let (width, blocks) = (out.len(), lit_out.len());
    let mut lines: Vec<&[f32]> = Vec::with_capacity(near.len());
    for (block, (out, lit_out)) in out.chunks_mut(LANES * BLOCK).zip(lit_out).enumerate() {
        *lit_out = near.iter().any(|row| lit[row * blocks + block]);
        if *lit_out {
            let start = block * LANES * BLOCK;
            lines.clear();
            lines.extend(near.iter().map(|row| &source[row * width + start..][..out.len()]));
            weigh(&lines, weights, out);
        } else {
            out.fill(0.0);
        }
    }
}

/// A row with `reach` texels more on either side, reflected.
fn pad(row: &[f32], reach: usize, padded: &mut Vec<f32>) {
    let columns = row.len() / LANES;
    padded.clear();
    let texel = |i: &usize| row[i * LANES..].iter().take(LANES);
    let [before, after] = [0, columns - 1].map(|column| around(column, reach, columns));
    padded.extend(before[..reach].iter().flat_map(texel));
    padded.extend_from_slice(row);
    padded.extend(after[reach + 1..].iter().flat_map(texel));
}

/// One row filtered along itself.
fn level_row(padded: &[f32], lit: &[bool], weights: &[f32], out: &mut [f32]) {
    let taps = 2 * weights.len() - 1;
    let mut lines: Vec<&[f32]> = Vec::with_capacity(taps);
    for (block, out) in out.chunks_mut(LANES * BLOCK).enumerate() {
        if lit[block.saturating_sub(1)..lit.len().min(block + 2)].contains(&true) {
            let start = block * LANES * BLOCK;
            lines.clear();
            lines.extend((0..taps).map(|tap| &padded[start + LANES * tap..][..out.len()]));
            weigh(&lines, weights, out);
        } else {
            out.fill(0.0);
        }
    }
}

/// The weighted sum of lines as long as `out`; the weight of a line is that of its distance from the middle one.
fn weigh(lines: &[&[f32]], weights: &[f32], out: &mut [f32]) {
    let reach = weights.len() - 1;
    let (vectors, rest) = out.as_chunks_mut::<VECTOR>();
    let done = vectors.len();
    for (i, out) in vectors.iter_mut().enumerate() {
        let part = |line: usize| &lines[line].as_chunks::<VECTOR>().0[i];
        let middle = part(reach);
        let mut sum = [0.0_f32; VECTOR];
        (0..VECTOR).for_each(|lane| sum[lane] = weights[0] * middle[lane]);
        for (distance, weight) in weights.iter().enumerate().skip(1) {
            let (below, above) = (part(reach - distance), part(reach + distance));
            (0..VECTOR).for_each(|lane| sum[lane] = weight.mul_add(below[lane] + above[lane], sum[lane]));
        }
        *out = sum;
    }
    for (i, out) in rest.iter_mut().enumerate() {
        let at = done * VECTOR + i;
        let pair = |distance: usize| lines[reach - distance][at] + lines[reach + distance][at];
        *out = (1..=reach).fold(weights[0] * lines[reach][at], |sum, k| weights[k].mul_add(pair(k), sum));
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec4, vec2};

    use super::super::boxes::{Box1, Running};
    use super::*;
    use crate::render::TextureLayout;

    /// Some bright places, one of them in a corner, in a dark texture.
    fn texture() -> ReceiverTexture {
        let mut texture = ReceiverTexture::new(TextureLayout::new(vec2(1.0, 0.7), 150, 0.0));
        let count = texture.texels().len();
        for i in [0, 77, count / 2, count / 2 + 1, count - 40] {
            texture.texels_mut()[i] = Vec4::new(1.0, 0.5, 2.0, 0.0);
        }
        texture
    }

    #[test]
    fn short_sums_and_running_ones_are_the_same_filter() {
        // From a part of a texel to the longest that is taken.
        for variance in [0.1, 0.6, 1.9, 4.0, 15.0] {
            let kernel = Box1::with_variance(variance);
            let (mut short, mut long) = (texture(), texture());
            Taps::default().filter(&mut short, &kernel.taps());
            Running::default().filter(&mut long, &kernel);
            let gap = short.texels().iter().zip(long.texels()).map(|(a, b)| (*a - *b).abs().max_element());
            // Weights and sums of f32, of values up to 2.
            assert!(gap.fold(0.0, f32::max) < 1e-6, "variance {variance}");
        }
    }

    #[test]
    fn a_texture_narrower_than_the_kernel_keeps_its_light() {
        let mut texture = ReceiverTexture::new(TextureLayout::new(Vec2::new(1.0, 0.05), 40, 0.0));
        texture.texels_mut()[3] = Vec4::ONE;
        Taps::default().filter(&mut texture, &Box1::with_variance(15.0).taps());
        assert!((texture.total().x - 1.0).abs() < 1e-6);
    }
}
