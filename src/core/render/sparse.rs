//! Smoothing of light that few photons carry.
//!
//! One kernel for all of a frame leaves dim light grainy where bright light is sharp. Progressive photon mapping proper has a radius
//! for each point, by the photons around it (Hachisuka et al. 2008); here a part of the light of each texel, the larger the
//! fewer photons are under its kernel, is spread by a wide kernel. The flux stays what it is.

use glam::{Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::texture::ReceiverTexture;
use crate::math::colour::luminance;
use crate::math::mirror::mirrored;

/// Texels along a block: the light is spread from block to block.
const BLOCK: usize = 4;
/// Photons under the kernel at which half of the light is spread: 16 % noise, where grain is seen.
const FEW: f32 = 40.0;
/// The binomial kernel of variance 1.
const BINOMIAL: [f32; 5] = [1.0 / 16.0, 4.0 / 16.0, 6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0];

/// Spreads what is sparse in the textures of a frame, the mean of some passes; all together have the light of `photons`. `radius` is
/// that of the kernel of the last pass, plane units.
pub fn smooth_sparse<'a>(textures: impl Iterator<Item = &'a mut ReceiverTexture>, photons: f32, radius: f32) {
    let mut textures: Vec<_> = textures.map(|texture| (Blocks::of(texture), texture)).collect();
    let sums = textures.iter().map(|(light, _)| light.cells.iter().map(brightness).sum::<f32>());
    let total = sums.sum::<f32>() * (BLOCK * BLOCK) as f32;
    if total > 0.0 {
        textures.iter_mut().for_each(|(light, texture)| smooth(texture, light, photons / total, radius));
    }
}

/// Spreads what is sparse in a texture with these blocks, of `per_watt` photons for each watt of luminance.
fn smooth(texture: &mut ReceiverTexture, light: &mut Blocks<Vec4>, per_watt: f32, radius: f32) {
    light.spread();
    let radius = radius / texture.layout().texel;
    // See `default_radius`.
    let texels = (4.0 * std::f32::consts::PI / 9.0 * radius * radius).max(1.0);
    let share = |light: &Vec4| {
        let count = per_watt * texels * brightness(light);
        FEW * FEW / (FEW * FEW + count * count)
    };
    let Blocks { columns, rows, .. } = *light;
    let shares = Blocks { columns, rows, cells: light.cells.iter().map(share).collect() };
    let mut sparse = Blocks { columns, rows, cells: vec![Vec4::ZERO; columns * rows] };
    let wide = texture.layout().columns;
    let blocks = texture.texels_mut().par_chunks_mut(BLOCK * wide).zip(sparse.cells.par_chunks_mut(columns));
    blocks.enumerate().for_each_init(Vec::new, |line, (block, (texels, sparse))| {
        for (y, row) in texels.chunks_exact_mut(wide).enumerate() {
            shares.line(block * BLOCK + y, line);
            for ((x, texel), share) in row.iter_mut().enumerate().zip(between(line)) {
                let part = *texel * share;
                *texel -= part;
                sparse[x / BLOCK] += part / (BLOCK * BLOCK) as f32;
            }
        }
    });
    sparse.spread();
    let rows = texture.texels_mut().par_chunks_mut(wide).enumerate();
    rows.for_each_init(Vec::new, |line, (y, row)| {
        sparse.line(y, line);
        row.iter_mut().zip(between(line)).for_each(|(texel, sparse)| *texel += sparse);
    });
}

fn brightness(light: &Vec4) -> f32 {
    luminance(light.xyz())
}

/// Values of blocks of texels; the light of a block is that of its mean texel.
struct Blocks<T> {
    columns: usize,
    rows: usize,
    cells: Vec<T>,
}

/// What can be weighed.
trait Value: Copy + Send + Sync + std::ops::Add<Output = Self> + std::ops::Mul<f32, Output = Self> {}
impl<T: Copy + Send + Sync + std::ops::Add<Output = T> + std::ops::Mul<f32, Output = T>> Value for T {}

impl<T: Value> Blocks<T> {
    /// Writes the values at a row of texels, a cell for each column of blocks and one more on either side.
    fn line(&self, row: usize, line: &mut Vec<T>) {
        let place = ((row as f32 + 0.5) / BLOCK as f32 - 0.5).clamp(0.0, (self.rows - 1) as f32);
        let below = place as usize;
        let above = (below + 1).min(self.rows - 1);
        let share = place - below as f32;
        let [below, above] = [below, above].map(|y| &self.cells[y * self.columns..(y + 1) * self.columns]);
        let of = |x: usize| below[x] * (1.0 - share) + above[x] * share;
        line.clear();
        line.extend(std::iter::once(of(0)).chain((0..self.columns).map(of)).chain([of(self.columns - 1)]));
    }
}

/// The values at the texels of a line; their weights sum to 1 over the texels of a block as over the blocks of a texel.
fn between<T: Value>(line: &[T]) -> impl Iterator<Item = T> {
    const HALF: usize = BLOCK / 2;
    let pairs = line.iter().zip(&line[1..]).enumerate();
    pairs.flat_map(|(i, (&a, &b))| {
        let texels = if i == 0 { HALF..BLOCK } else { 0..BLOCK };
        texels.map(move |texel| {
            let share = (texel as f32 + 0.5) / BLOCK as f32;
            a * (1.0 - share) + b * share
        })
    })
}

impl Blocks<Vec4> {
    fn of(texture: &ReceiverTexture) -> Self {
        let wide = texture.layout().columns;
        let (columns, rows) = (wide.div_ceil(BLOCK), texture.layout().rows.div_ceil(BLOCK));
        let mut cells = vec![Vec4::ZERO; columns * rows];
        let blocks = cells.par_chunks_mut(columns).zip(texture.texels().par_chunks(BLOCK * wide));
        blocks.for_each(|(means, texels)| {
            for (x, texel) in texels.chunks_exact(wide).flat_map(|row| row.iter().enumerate()) {
                means[x / BLOCK] += *texel / (BLOCK * BLOCK) as f32;
            }
        });
        Self { columns, rows, cells }
    }

    /// Spreads with the binomial kernel along columns and rows; the border reflects.
    fn spread(&mut self) {
        let mut other = vec![Vec4::ZERO; self.cells.len()];
        let (columns, rows) = (self.columns, self.rows);
        let row = |(to, from): (&mut [Vec4], &[Vec4])| {
            to.iter_mut().enumerate().for_each(|(x, to)| *to = weighted(x, columns, |x| from[x]));
        };
        other.par_chunks_mut(columns).zip(self.cells.par_chunks(columns)).for_each(row);
        let column = |(y, to): (usize, &mut [Vec4])| {
            let value = |x: usize, y: usize| other[y * columns + x];
            to.iter_mut().enumerate().for_each(|(x, to)| *to = weighted(y, rows, |y| value(x, y)));
        };
        self.cells.par_chunks_mut(columns).enumerate().for_each(column);
    }
}

/// The binomial mean around place `i` of `count`.
fn weighted(i: usize, count: usize, value: impl Fn(usize) -> Vec4) -> Vec4 {
    let reach = BINOMIAL.len() as isize / 2;
    BINOMIAL.iter().zip(-reach..).map(|(weight, by)| *weight * value(mirrored(i as isize + by, count))).sum()
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec2, Vec3};

    use super::*;
    use crate::render::TextureLayout;

    /// A texture that is bright on the left and dim on the right, of as many photons as watts; checkered by `noise`.
    fn lit(bright: f32, dim: f32, noise: f32) -> ReceiverTexture {
        let mut texture = ReceiverTexture::new(TextureLayout::new(Vec2::ONE, 78, 0.0));
        let columns = texture.layout().columns;
        for (i, texel) in texture.texels_mut().iter_mut().enumerate() {
            let (x, y) = (i % columns, i / columns);
            let sign = if (x + y) % 2 == 0 { 1.0 } else { -1.0 };
            *texel =
                (if x < columns / 2 { bright } else { dim } * (1.0 + noise * sign)) * Vec3::ONE.extend(0.0);
        }
        texture
    }

    fn smoothed(before: &ReceiverTexture) -> ReceiverTexture {
        let mut after = before.clone();
        // A kernel of one texel: the photons under it are those of the texel.
        let radius = 0.5 * after.layout().texel;
        smooth_sparse([&mut after].into_iter(), before.total().x as f32, radius);
        after
    }

    #[test]
    fn dim_light_is_smoothed_and_bright_light_stays() {
        let before = lit(3000.0, 6.0, 0.5);
        let after = smoothed(&before);
        let columns = before.layout().columns;
        let place = |x: usize| 40 * columns + x;
        let [bright, dim] = [10, 70].map(|x| {
            [&before, &after].map(|texture| texture.texels()[place(x)].x - texture.texels()[place(x + 1)].x)
        });
        // 3000 photons keep 1 - (40/3000)^2, and 6 of them 2 %.
        assert!((bright[1] / bright[0] - 1.0).abs() < 1e-3, "{bright:?}");
        assert!((dim[1] / dim[0]).abs() < 0.03, "{dim:?}");
        // No halo: of the bright light beside it, dim light takes what the bright light is smoothed by.
        let beside = place(columns / 2);
        assert!((after.texels()[beside].x - before.texels()[beside].x).abs() < 1.0);
    }

    #[test]
    fn no_flux_is_lost_nor_made() {
        let before = lit(70.0, 5.0, 0.9);
        assert!(before.layout().columns.is_multiple_of(BLOCK));
        let after = smoothed(&before);
        let [before, after]: [DVec3; 2] = [before.total(), after.total()];
        // Rounding in 32 bits.
        assert!((after / before - 1.0).abs().max_element() < 1e-5, "{before} {after}");
        let dark = ReceiverTexture::new(TextureLayout::new(Vec2::ONE, 10, 0.0));
        assert_eq!(smoothed(&dark), dark);
    }
}
