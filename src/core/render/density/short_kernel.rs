//! A short separable kernel, applied only where there is light.
//!
//! Both axes are filtered band by band of rows, from one texture to another: the intermediate rows stay in the cache.

use glam::Vec4;
use rayon::prelude::*;

use super::kernel::LANES;
use crate::math::mirror::mirrored;
use crate::render::texture::ReceiverTexture;

/// Texels per block, the unit that is dark or lit. The kernel reaches no farther than the next block.
const BLOCK: usize = 32;
/// Rows per task.
const BAND: usize = 32;
/// Numbers summed at once: four vector registers of eight.
const VECTOR: usize = 32;

/// The filter, with a buffer kept from call to call.
#[derive(Debug, Default)]
pub(super) struct ShortKernel {
    /// The texels of the result; after the swap, those of the input.
    other: Vec<Vec4>,
}

impl ShortKernel {
    /// Filters by the weights at the centre and at each distance, at most a block; reflected at the border.
    pub(super) fn filter(&mut self, texture: &mut ReceiverTexture, weights: &[f32]) {
        let (columns, rows) = (texture.layout().columns, texture.layout().rows);
        self.other.resize(columns * rows, Vec4::ZERO);
        let source = Source { texels: bytemuck::cast_slice(texture.texels()), columns, rows };
        let bands = self.other.par_chunks_mut(BAND * columns).enumerate();
        bands.for_each_init(Band::default, |work, (band, out)| {
            work.filter(&source, weights, band * BAND, bytemuck::cast_slice_mut(out));
        });
        texture.swap_texels(&mut self.other);
    }
}

/// The texels of a texture, number by number.
struct Source<'a> {
    texels: &'a [f32],
    columns: usize,
    rows: usize,
}

impl Source<'_> {
    fn row(&self, row: usize) -> &[f32] {
        &self.texels[LANES * self.columns * row..][..LANES * self.columns]
    }
}

/// The buffers of one band.
#[derive(Default)]
struct Band {
    /// Whether each block of a source row holds light, row by row, from `reach` rows below the band to `reach` above.
    lit: Vec<bool>,
    /// A row filtered along its columns, with `reach` texels more on either side.
    padded: Vec<f32>,
}

impl Band {
    /// Filters the rows from `first` on into `out`.
    fn filter(&mut self, source: &Source, weights: &[f32], first: usize, out: &mut [f32]) {
        let (reach, width) = (weights.len() - 1, LANES * source.columns);
        let (low, high) = (first as isize - reach as isize, first + out.len() / width + reach);
        let window: Vec<usize> = (low..high as isize).map(|row| mirrored(row, source.rows)).collect();
        let blocks = source.columns.div_ceil(BLOCK);
        self.lit.clear();
        for &row in &window {
            let blocks = source.row(row).chunks(LANES * BLOCK);
            self.lit.extend(blocks.map(|block| block.iter().any(|&value| value != 0.0)));
        }
        self.padded.resize(width + 2 * LANES * reach, 0.0);
        for (i, out) in out.chunks_exact_mut(width).enumerate() {
            let near = i..=i + 2 * reach;
            let lit = &self.lit[i * blocks..(i + 2 * reach + 1) * blocks];
            let lit: Vec<bool> =
                (0..blocks).map(|b| lit[b..].iter().step_by(blocks).any(|&lit| lit)).collect();
            let upright = &mut self.padded[LANES * reach..][..width];
            upright_row(source, &window[near], &lit, weights, upright);
            reflect(&mut self.padded, reach, source.columns);
            level_row(&self.padded, &lit, weights, out);
        }
    }
}

/// One row filtered across rows, from those `near` it.
fn upright_row(source: &Source, near: &[usize], lit: &[bool], weights: &[f32], out: &mut [f32]) {
    let mut lines: Vec<&[f32]> = Vec::with_capacity(near.len());
    for (block, out) in out.chunks_mut(LANES * BLOCK).enumerate() {
        if lit[block] {
            lines.clear();
            lines.extend(near.iter().map(|&row| &source.row(row)[block * LANES * BLOCK..][..out.len()]));
            weigh(&lines, weights, out);
        } else {
            out.fill(0.0);
        }
    }
}

/// Fills the `reach` texels on either side of a padded row.
fn reflect(padded: &mut [f32], reach: usize, columns: usize) {
    for at in (0..reach).chain(reach + columns..columns + 2 * reach) {
        let from = LANES * (reach + mirrored(at as isize - reach as isize, columns));
        padded.copy_within(from..from + LANES, LANES * at);
    }
}

/// One row filtered along itself, across columns.
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

/// The weighted sum of lines; a line's weight is by its distance from the middle one.
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
    use glam::{Vec2, vec2};

    use super::super::kernel::ExtendedBox;
    use super::super::running_sum::RunningSum;
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
            let kernel = ExtendedBox::with_variance(variance);
            let (mut short, mut long) = (texture(), texture());
            ShortKernel::default().filter(&mut short, &kernel.weights());
            RunningSum::default().filter(&mut long, &kernel);
            let gap = short.texels().iter().zip(long.texels()).map(|(a, b)| (*a - *b).abs().max_element());
            // Weights and sums of f32, of values up to 2.
            assert!(gap.fold(0.0, f32::max) < 1e-6, "variance {variance}");
        }
    }

    #[test]
    fn a_texture_narrower_than_the_kernel_keeps_its_light() {
        let mut texture = ReceiverTexture::new(TextureLayout::new(Vec2::new(1.0, 0.05), 40, 0.0));
        texture.texels_mut()[3] = Vec4::ONE;
        ShortKernel::default().filter(&mut texture, &ExtendedBox::with_variance(15.0).weights());
        assert!((texture.total().x - 1.0).abs() < 1e-6);
    }
}
