//! The photons of one pass, before and at the key frames.

use glam::{DVec3, Vec2, Vec3};

use crate::flow::flux;

/// The light of one group in one pass.
pub(super) struct GroupLight {
    /// The traced photons; absent where no key frame shows them.
    pub(super) physical: Option<KeyPhotons>,
    /// Flux of all photons, watts; the other key frames distribute it over their points.
    pub(super) total: DVec3,
    /// Number of photons.
    pub(super) count: usize,
}

/// The light of one pass, group by group.
pub(super) struct PassLight {
    pub(super) groups: Vec<GroupLight>,
}

/// The photons of one group in one pass at one key frame: columns of equal length.
#[derive(Clone, Debug, Default)]
pub(super) struct KeyPhotons {
    /// Plane coordinates.
    pub(super) positions: Vec<Vec2>,
    /// RGB flux, watts.
    pub(super) flux: Vec<Vec3>,
    /// Colour of each photon's light before the factors of the key frame, of sum 1; empty where the key frame gives none, so
    /// that photons keep theirs.
    pub(super) colours: Vec<Vec3>,
    /// Index of the traced photon in each row, where photons stay in place until the next key frame; else empty.
    pub(super) origin: Vec<u32>,
    /// Distance of each photon's path from the straight line at the middle of the segment before, plane units; empty where
    /// paths have none.
    pub(super) midpoint_offsets: Vec<Vec2>,
}

impl KeyPhotons {
    /// The photons in another order: row k of the result is row `order[k]` of this, not yet paired.
    pub(super) fn permuted(&self, order: &[u32]) -> Self {
        fn of<T: Copy>(column: &[T], order: &[u32]) -> Vec<T> {
            if column.is_empty() { Vec::new() } else { order.iter().map(|&i| column[i as usize]).collect() }
        }
        Self {
            positions: of(&self.positions, order),
            flux: of(&self.flux, order),
            colours: of(&self.colours, order),
            origin: of(&self.origin, order),
            midpoint_offsets: Vec::new(),
        }
    }

    /// Some of the photons, paired as before; the others are left out.
    pub(super) fn selected(&self, rows: &[usize]) -> Self {
        fn of<T: Copy>(column: &[T], rows: &[usize]) -> Vec<T> {
            if column.is_empty() { Vec::new() } else { rows.iter().map(|&row| column[row]).collect() }
        }
        Self {
            positions: of(&self.positions, rows),
            flux: of(&self.flux, rows),
            colours: of(&self.colours, rows),
            origin: of(&self.origin, rows),
            midpoint_offsets: of(&self.midpoint_offsets, rows),
        }
    }
}

/// The colours of light, of sum 1; of photons without light that of all together.
pub(super) fn colours(flux: &[Vec3]) -> Vec<Vec3> {
    let colour = |flux: Vec3| (flux.element_sum() > 0.0).then(|| flux / flux.element_sum());
    let all = flux::total(flux).as_vec3();
    let mean = colour(all).unwrap_or(Vec3::splat(1.0 / 3.0));
    flux.iter().map(|flux| colour(*flux).unwrap_or(mean)).collect()
}

/// The number of photons in all groups.
pub(super) fn count(groups: &[KeyPhotons]) -> usize {
    groups.iter().map(|group| group.positions.len()).sum()
}

/// The positions of all groups, one after the other.
pub(super) fn all_positions(groups: &[KeyPhotons]) -> impl Iterator<Item = Vec2> {
    groups.iter().flat_map(|group| &group.positions).copied()
}

/// The flux of all groups, one after the other, watts.
pub(super) fn all_flux(groups: &[KeyPhotons]) -> impl Iterator<Item = Vec3> {
    groups.iter().flat_map(|group| &group.flux).copied()
}
