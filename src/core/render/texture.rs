//! The texture of flux on the receiver.
//!
//! Texels are square. The texture covers the receiver and a margin, so that light a little beyond the edge is still
//! filtered into it. Photons beyond the margin are counted, never clamped to the border.

use glam::{DVec3, Vec2, Vec4, Vec4Swizzles};
use rayon::prelude::*;

use crate::math::sum::ordered_sum;

/// The placement of the texels on the plane; row 0 is at the bottom (smallest plane y).
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub struct TextureLayout {
    /// Texels per row.
    pub columns: usize,
    /// Rows.
    pub rows: usize,
    /// The lower left corner of texel (0, 0), in plane units.
    pub origin: Vec2,
    /// Side of a texel, in plane units.
    pub texel: f32,
}

impl TextureLayout {
    /// `resolution` texels along the longer side of a receiver of `extent`, and at least `margin` plane units more on
    /// every side.
    pub fn new(extent: Vec2, resolution: usize, margin: f32) -> Self {
        let texel = extent.max_element() / resolution.max(1) as f32;
        let border = (margin.max(0.0) / texel).ceil() + 1.0;
        let size = (extent / texel - 1e-3).ceil() + 2.0 * border;
        Self { columns: size.x as usize, rows: size.y as usize, origin: Vec2::splat(-border * texel), texel }
    }

    /// Number of texels.
    pub fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// Whether there is no texel.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Texel coordinates of a plane point: whole numbers are texel centres.
    pub fn texel_from_plane(&self, point: Vec2) -> Vec2 {
        (point - self.origin) / self.texel - 0.5
    }

    /// The centre of a texel on the plane.
    pub fn plane_from_texel(&self, column: usize, row: usize) -> Vec2 {
        self.origin + self.texel * (Vec2::new(column as f32, row as f32) + 0.5)
    }

    /// The four texels around a point and their bilinear weights, which sum to 1; none outside the texture.
    pub fn bilinear(&self, point: Vec2) -> Option<[(usize, f32); 4]> {
        let p = self.texel_from_plane(point);
        // Written so that NaN is outside, too.
        let inside =
            p.x >= 0.0 && p.y >= 0.0 && p.x < (self.columns - 1) as f32 && p.y < (self.rows - 1) as f32;
        if !inside {
            return None;
        }
        let (column, row) = (p.x as usize, p.y as usize);
        let (fx, fy) = (p.x - column as f32, p.y - row as f32);
        let first = row * self.columns + column;
        Some([
            (first, (1.0 - fx) * (1.0 - fy)),
            (first + 1, fx * (1.0 - fy)),
            (first + self.columns, (1.0 - fx) * fy),
            (first + self.columns + 1, fx * fy),
        ])
    }
}

/// RGB flux per texel, f32. The fourth lane is always zero: four lanes are one vector register.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub struct ReceiverTexture {
    layout: TextureLayout,
    texels: Vec<Vec4>,
}

impl ReceiverTexture {
    /// A texture without light.
    pub fn new(layout: TextureLayout) -> Self {
        Self { layout, texels: vec![Vec4::ZERO; layout.len()] }
    }

    /// The layout.
    pub fn layout(&self) -> &TextureLayout {
        &self.layout
    }

    /// Flux per texel in watts, row by row from the bottom.
    pub fn texels(&self) -> &[Vec4] {
        &self.texels
    }

    /// As [`Self::texels`], mutable.
    pub fn texels_mut(&mut self) -> &mut [Vec4] {
        &mut self.texels
    }

    /// Swaps all texels with others of the same number.
    ///
    /// # Panics
    /// If the numbers differ.
    pub(super) fn swap_texels(&mut self, other: &mut Vec<Vec4>) {
        assert_eq!(other.len(), self.texels.len(), "one texture for another");
        std::mem::swap(&mut self.texels, other);
    }

    /// Total flux in watts, summed in f64; the same for any number of threads.
    pub fn total(&self) -> DVec3 {
        ordered_sum(&self.texels, |t| t.xyz().as_dvec3())
    }

    /// Multiplies every texel.
    pub fn scale(&mut self, factor: f32) {
        self.texels.par_iter_mut().for_each(|t| *t *= factor);
    }
}
