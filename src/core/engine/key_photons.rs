//! The photons of one pass, before and at the key frames.

use glam::{DVec3, Vec2, Vec3};

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
    /// Index of the traced photon in each row, where photons stay in place until the next key frame; else empty.
    pub(super) origin: Vec<u32>,
    /// Distance of each photon's path from the straight line at the middle of the segment before, plane units; empty where
    /// paths have none.
    pub(super) midpoint_offsets: Vec<Vec2>,
}

impl KeyPhotons {
    /// The photons in another order: row k of the result is row `order[k]` of this, not yet paired.
    pub(super) fn permuted(&self, order: &[u32]) -> Self {
        let origin = if self.origin.is_empty() {
            Vec::new()
        } else {
            order.iter().map(|&i| self.origin[i as usize]).collect()
        };
        Self {
            positions: order.iter().map(|&i| self.positions[i as usize]).collect(),
            flux: order.iter().map(|&i| self.flux[i as usize]).collect(),
            origin,
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
            origin: of(&self.origin, rows),
            midpoint_offsets: of(&self.midpoint_offsets, rows),
        }
    }
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
