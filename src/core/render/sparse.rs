//! Smoothing of light that few photons carry.
//!
//! One kernel for all of a frame leaves dim light grainy where bright light is sharp. Progressive photon mapping proper has a radius
//! for each point, by the photons around it (Hachisuka et al. 2008); here a part of the light of each texel, the larger the
//! fewer photons are under its kernel, is spread by a wide kernel. The flux stays what it is.

use glam::{Vec4, Vec4Swizzles};
use rayon::prelude::*;

use super::texture::ReceiverTexture;
use crate::math::colour::luminance;

/// Texels along a block: the light is spread from block to block.
const BLOCK: usize = 4;
/// Photons under the kernel at which half of the light is spread: 16 % noise, where grain is seen.
const FEW: f32 = 40.0;
/// The binomial kernel of variance 1.
const BINOMIAL: [f32; 5] = [1.0 / 16.0, 4.0 / 16.0, 6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0];

/// Spreads what is sparse in the mean of some passes, which has `per_watt` photons for each watt of luminance; `radius` is that of
/// the kernel of the last pass, plane units.
pub fn smooth_sparse(texture: &mut ReceiverTexture, per_watt: f32, radius: f32) {
    let radius = radius / texture.layout().texel;
    // See `default_radius`.
    let texels = (4.0 * std::f32::consts::PI / 9.0 * radius * radius).max(1.0);
    let mut light = Blocks::of(texture);
    light.spread();
    let share = |light: &Vec4| {
        let count = per_watt * texels * luminance(light.xyz());
        Vec4::splat(FEW * FEW / (FEW * FEW + count * count))
    };
    let shares = Blocks { texels: light.texels.iter().map(share).collect(), ..light };
    let mut sparse = Blocks { texels: vec![Vec4::ZERO; shares.texels.len()], ..light };
    let columns = texture.layout().columns;
    let rows =
        texture.texels_mut().par_chunks_mut(BLOCK * columns).zip(sparse.texels.par_chunks_mut(light.columns));
    rows.enumerate().for_each(|(block, (texels, sparse))| {
        for (y, row) in texels.chunks_exact_mut(columns).enumerate() {
            for (x, texel) in row.iter_mut().enumerate() {
                let part = *texel * shares.at(x, block * BLOCK + y);
                *texel -= part;
                sparse[x / BLOCK] += part / (BLOCK * BLOCK) as f32;
            }
        }
    });
    sparse.spread();
    let rows = texture.texels_mut().par_chunks_mut(columns).enumerate();
    rows.for_each(|(y, row)| row.iter_mut().enumerate().for_each(|(x, texel)| *texel += sparse.at(x, y)));
}

/// The means of blocks of texels.
struct Blocks {
    columns: usize,
    rows: usize,
    texels: Vec<Vec4>,
}

impl Blocks {
    fn of(texture: &ReceiverTexture) -> Self {
        let wide = texture.layout().columns;
        let (columns, rows) = (wide.div_ceil(BLOCK), texture.layout().rows.div_ceil(BLOCK));
        let mut texels = vec![Vec4::ZERO; columns * rows];
        let blocks = texels.par_chunks_mut(columns).zip(texture.texels().par_chunks(BLOCK * wide));
        blocks.for_each(|(means, texels)| {
            for (x, texel) in texels.chunks_exact(wide).flat_map(|row| row.iter().enumerate()) {
                means[x / BLOCK] += *texel / (BLOCK * BLOCK) as f32;
            }
        });
        Self { columns, rows, texels }
    }

    /// Between the four blocks around a texel; their weights sum to 1 over the texels of a block as over the blocks of a texel.
    fn at(&self, column: usize, row: usize) -> Vec4 {
        let along = |i: usize, count: usize| {
            let place = ((i as f32 + 0.5) / BLOCK as f32 - 0.5).clamp(0.0, (count - 1) as f32);
            let first = (place as usize).min(count.saturating_sub(2));
            (first, (first + 1).min(count - 1), place - first as f32)
        };
        let ((left, right, x), (below, above, y)) = (along(column, self.columns), along(row, self.rows));
        let of = |row: usize| {
            let row = row * self.columns;
            self.texels[row + left].lerp(self.texels[row + right], x)
        };
        of(below).lerp(of(above), y)
    }

    /// Spreads with the binomial kernel along columns and rows; the border reflects.
    fn spread(&mut self) {
        let mut other = vec![Vec4::ZERO; self.texels.len()];
        let (columns, rows) = (self.columns, self.rows);
        let row = |(to, from): (&mut [Vec4], &[Vec4])| {
            to.iter_mut().enumerate().for_each(|(x, to)| *to = weighted(x, columns, |x| from[x]));
        };
        other.par_chunks_mut(columns).zip(self.texels.par_chunks(columns)).for_each(row);
        let column = |(y, to): (usize, &mut [Vec4])| {
            let at = |x: usize| move |y: usize| y * columns + x;
            to.iter_mut().enumerate().for_each(|(x, to)| *to = weighted(y, rows, |y| other[at(x)(y)]));
        };
        self.texels.par_chunks_mut(columns).enumerate().for_each(column);
    }
}

/// The binomial mean around place `i` of `count`.
fn weighted(i: usize, count: usize, value: impl Fn(usize) -> Vec4) -> Vec4 {
    let mirror = |at: isize| {
        let at = at.rem_euclid(2 * count as isize) as usize;
        if at < count { at } else { 2 * count - 1 - at }
    };
    let reach = BINOMIAL.len() as isize / 2;
    BINOMIAL.iter().zip(-reach..).map(|(weight, by)| *weight * value(mirror(i as isize + by))).sum()
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

    fn smooth(texture: &mut ReceiverTexture) {
        // A kernel of one texel: the photons under it are those of the texel.
        let radius = 0.5 * texture.layout().texel;
        smooth_sparse(texture, 1.0, radius);
    }

    #[test]
    fn dim_light_is_smoothed_and_bright_light_stays() {
        let before = lit(3000.0, 6.0, 0.5);
        let mut after = before.clone();
        smooth(&mut after);
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
        let mut after = before.clone();
        smooth(&mut after);
        let [before, after]: [DVec3; 2] = [before.total(), after.total()];
        // Rounding in 32 bits.
        assert!((after / before - 1.0).abs().max_element() < 1e-5, "{before} {after}");
        let mut dark = ReceiverTexture::new(TextureLayout::new(Vec2::ONE, 10, 0.0));
        smooth_sparse(&mut dark, 1.0, 0.1);
        assert_eq!(dark.total(), DVec3::ZERO);
    }
}
