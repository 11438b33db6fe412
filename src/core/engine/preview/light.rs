//! The light of a preview on the receiver: the estimate that renders use, from fewer photons.

use glam::{Vec2, Vec3};

use super::Preview;
use crate::engine::Quality;
use crate::render::density::{KernelFilter, default_radius};
use crate::render::splat::Splatter;
use crate::render::{ReceiverTexture, TextureLayout};

/// Widest kernel, plane units.
const WIDEST: f32 = 0.5;

/// Exposes frames of previews, with its buffers.
#[derive(Default)]
pub struct PreviewExposure {
    splatter: Splatter,
    smoother: KernelFilter,
    texture: Option<ReceiverTexture>,
    positions: Vec<Vec2>,
    flux: Vec<Vec3>,
}

impl PreviewExposure {
    /// The light at a frame with `resolution` texels along the longer side of the receiver, watts per texel. `shown` tells
    /// for each of [`Preview::groups`] whether it shines; groups beyond its end do. None before the frame is worked out.
    pub fn expose(
        &mut self,
        preview: &Preview,
        frame: i32,
        resolution: usize,
        shown: &[bool],
    ) -> Option<&ReceiverTexture> {
        let all = preview.positions(frame)?;
        preview.flux(frame, &mut self.flux);
        let is_shown = |group: &usize| shown.get(*group) != Some(&false);
        let groups = 0..preview.groups().len();
        let positions = if groups.clone().all(|group| is_shown(&group)) {
            all
        } else {
            let rows = |group: usize| preview.groups()[group].1.clone();
            let kept = || groups.clone().filter(is_shown).flat_map(rows);
            self.positions = kept().map(|row| all[row]).collect();
            self.flux = kept().map(|row| self.flux[row]).collect();
            &self.positions
        };
        let layout = layout(preview.extent(), resolution);
        let texture = match self.texture.take() {
            Some(texture) if *texture.layout() == layout => texture,
            _ => ReceiverTexture::new(layout),
        };
        let texture = self.texture.insert(texture);
        self.splatter.splat(positions, &self.flux, texture);
        self.smoother.filter(texture, Self::radius(preview));
        Some(texture)
    }

    /// The radius of the kernel for the photons of a preview, plane units: that of a render whose photons lie as densely as
    /// these do where they are. Fewer photons are spread wider. The same at all frames.
    pub fn radius(preview: &Preview) -> f32 {
        default_radius(preview.photons(), preview.keys.covered).min(WIDEST)
    }
}

/// The texture of all previews on a receiver of `extent`, with a margin for the widest kernel.
pub(super) fn layout(extent: Vec2, resolution: usize) -> TextureLayout {
    TextureLayout::new(extent, resolution, margin(extent))
}

fn photons(quality: Quality) -> usize {
    quality.photons().unwrap_or(usize::MAX)
}

/// As wide as the kernel of the coarsest preview whose photons lie all over the plane.
pub(super) fn margin(extent: Vec2) -> f32 {
    default_radius(photons(Quality::Draft), extent.x * extent.y).min(WIDEST)
}

/// Radius of the finest preview, where its photons cover a twentieth of the plane.
pub(super) fn finest_radius(extent: Vec2) -> f32 {
    default_radius(photons(Quality::Fine), 0.05 * extent.x * extent.y).min(WIDEST)
}

/// Cells along the longer side in which photons are counted to see how much of the plane they cover.
const CELLS: usize = 64;

/// The area that photons cover on a plane of `extent`: that of a region on which so many, evenly spread, would have as many
/// neighbours as these have in the mean. Plane units squared.
pub fn covered_area(photons: &[Vec2], extent: Vec2) -> f32 {
    let [columns, rows] = (extent * CELLS as f32).to_array().map(|side| side.ceil().max(1.0) as usize);
    let mut counts = vec![0_u32; columns * rows];
    for p in photons.iter().map(|p| *p * CELLS as f32).filter(|p| p.cmpge(Vec2::ZERO).all()) {
        let (column, row) = (p.x as usize, p.y as usize);
        if column < columns && row < rows {
            counts[row * columns + column] += 1;
        }
    }
    let count: f64 = counts.iter().map(|&n| f64::from(n)).sum();
    let neighbours: f64 = counts.iter().map(|&n| f64::from(n) * (f64::from(n) - 1.0)).sum();
    let cell = (CELLS * CELLS) as f64;
    let area = if neighbours > 0.0 { count * (count - 1.0) / neighbours / cell } else { f64::INFINITY };
    (area as f32).min(extent.x * extent.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec2;

    #[test]
    fn photons_cover_the_area_on_which_they_lie() {
        // 256 x 256 points, evenly on a quarter of the plane, and on all of it.
        let points = |side: f32| -> Vec<Vec2> {
            let at = |i: usize| side * (i as f32 + 0.5) / 256.0;
            (0..256 * 256).map(|i| vec2(at(i % 256), at(i / 256))).collect()
        };
        for (side, area) in [(0.5, 0.25), (1.0, 1.0)] {
            let seen = covered_area(&points(side), Vec2::ONE);
            // Each point is no neighbour of itself: one part in the 16 to 64 of a cell.
            assert!((seen / area - 1.0).abs() < 0.07, "{seen} for {area}");
        }
        assert_eq!(covered_area(&[Vec2::ZERO], vec2(1.0, 0.5)), 0.5);
    }
}
