//! Splatting of photons into the texture: a bilinear histogram.
//!
//! The photons are stably sorted by bands of rows, and each band is then summed by one thread: every texel gets its photons
//! in the same order for any number of threads, and a band stays in the cache.

use glam::{DVec3, Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::texture::{ReceiverTexture, TextureLayout};

/// Rows summed by one thread; with 1024 texels per row a band takes 256 KiB and stays in the second-level cache.
const BAND: usize = 16;
/// Photons sorted by one thread.
const CHUNK: usize = 1 << 16;

/// The photons outside the texture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutsidePhotons {
    /// Photons beyond the margin, or without a finite position or flux.
    pub photons: usize,
    /// Their finite flux in watts.
    pub flux: DVec3,
}

/// Buffers of the sort, kept from call to call.
#[derive(Debug, Default)]
pub struct Splatter {
    chunks: Vec<Chunk>,
    seams: Vec<Vec4>,
}

/// The photons of one chunk by band, in their order within each.
#[derive(Debug, Default)]
struct Chunk {
    bands: Vec<Vec<TexelPhoton>>,
    outside: OutsidePhotons,
}

/// A photon in texel coordinates; rows counted within its band.
#[derive(Clone, Copy, Debug)]
struct TexelPhoton {
    x: f32,
    y: f32,
    flux: Vec3,
}

impl Splatter {
    /// Replaces the texture by photons at plane `positions` with RGB `flux` (watts), each spread over the four texels around
    /// it. The same photons give the same bytes for any number of threads.
    ///
    /// # Panics
    /// If the columns differ in length.
    pub fn splat(
        &mut self,
        positions: &[Vec2],
        flux: &[Vec3],
        texture: &mut ReceiverTexture,
    ) -> OutsidePhotons {
        assert_eq!(positions.len(), flux.len(), "one flux per photon");
        let layout = *texture.layout();
        let chunks = positions.len().div_ceil(CHUNK);
        if self.chunks.len() < chunks {
            self.chunks.resize_with(chunks, Chunk::default);
        }
        self.chunks[..chunks]
            .par_iter_mut()
            .zip(positions.par_chunks(CHUNK).zip(flux.par_chunks(CHUNK)))
            .for_each(|(chunk, (positions, flux))| chunk.sort(&layout, positions, flux));
        let sorted = &self.chunks[..chunks];
        // The upper texels of a band's last row belong to the next band: they go to a separate seam first.
        let columns = layout.columns;
        self.seams.clear();
        self.seams.resize(layout.rows.div_ceil(BAND) * columns, Vec4::ZERO);
        texture
            .texels_mut()
            .par_chunks_mut(BAND * columns)
            .zip(self.seams.par_chunks_mut(columns))
            .enumerate()
            .for_each(|(band, (rows, seam))| {
                // Brings the whole band into the cache; the photons access it in no order.
                rows.fill(Vec4::ZERO);
                for chunk in sorted {
                    chunk.bands[band].iter().for_each(|photon| photon.add(columns, rows, seam));
                }
            });
        for (band, seam) in self.seams.chunks_exact(columns).enumerate() {
            let first = (band + 1) * BAND * columns;
            let above = texture.texels_mut().iter_mut().skip(first).take(columns);
            above.zip(seam).for_each(|(texel, &flux)| *texel += flux);
        }
        sorted.iter().fold(OutsidePhotons::default(), |sum, chunk| OutsidePhotons {
            photons: sum.photons + chunk.outside.photons,
            flux: sum.flux + chunk.outside.flux,
        })
    }
}

impl Chunk {
    fn sort(&mut self, layout: &TextureLayout, positions: &[Vec2], flux: &[Vec3]) {
        let limit = Vec2::new((layout.columns - 1) as f32, (layout.rows - 1) as f32);
        self.outside = OutsidePhotons::default();
        self.bands.resize_with(layout.rows.div_ceil(BAND), Vec::new);
        self.bands.iter_mut().for_each(Vec::clear);
        for (&position, &flux) in positions.iter().zip(flux) {
            let p = layout.texel_from_plane(position);
            // Written so that NaN is outside, too.
            let inside = p.x >= 0.0 && p.y >= 0.0 && p.x < limit.x && p.y < limit.y;
            if inside && flux.is_finite() {
                let row = p.y as usize;
                let (band, row) = (row / BAND, (row % BAND) as f32);
                self.bands[band].push(TexelPhoton { x: p.x, y: row + p.y.fract(), flux });
            } else {
                self.outside.photons += 1;
                self.outside.flux += if flux.is_finite() { flux.as_dvec3() } else { DVec3::ZERO };
            }
        }
    }
}

impl TexelPhoton {
    /// Adds the photon to the rows of its band and to the seam above them.
    fn add(&self, columns: usize, rows: &mut [Vec4], seam: &mut [Vec4]) {
        let (column, row) = (self.x as usize, self.y as usize);
        let (fx, fy) = (self.x - column as f32, self.y - row as f32);
        let flux = self.flux.extend(0.0);
        let (lower, upper) = (flux * (1.0 - fy), flux * fy);
        let pair = &mut rows[row * columns + column..][..2];
        pair[0] += lower * (1.0 - fx);
        pair[1] += lower * fx;
        let pair =
            if row + 1 < BAND { &mut rows[(row + 1) * columns + column..] } else { &mut seam[column..] };
        pair[0] += upper * (1.0 - fx);
        pair[1] += upper * fx;
    }
}
