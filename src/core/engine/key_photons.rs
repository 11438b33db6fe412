//! The photons of one pass, before and at the key frames.

use glam::{DVec3, Vec2, Vec3};

/// The light of one group in one pass.
pub(super) struct GroupLight {
    /// The traced photons where a key shows them.
    pub(super) physical: Option<KeyPhotons>,
    /// Flux of all its photons, watts, which the other keys share out.
    pub(super) total: DVec3,
    /// How many they are.
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
    /// RGB flux in watts.
    pub(super) flux: Vec<Vec3>,
    /// Which traced photon each is, where they shall stay in place until the next key; else empty.
    pub(super) origin: Vec<u32>,
    /// How far the photons' ways to this key bow from the straight ones at half-time; empty where the method bows none.
    pub(super) bows: Vec<Vec2>,
}

/// Which of a group's points at a key each photon goes to.
#[derive(Clone, Debug, Default)]
pub(super) struct Partners {
    /// Photon k goes to point `order[k]`, as the points are drawn; absent where to point k.
    pub(super) order: Option<Vec<u32>>,
    /// See [`KeyPhotons::bows`].
    pub(super) bows: Vec<Vec2>,
}

impl Partners {
    /// The points as they are drawn, each in the row of its photon.
    pub(super) fn arrange(&self, points: KeyPhotons) -> KeyPhotons {
        let mut arranged = match &self.order {
            Some(order) => points.permuted(order),
            None => points,
        };
        arranged.bows.clone_from(&self.bows);
        arranged
    }
}

impl KeyPhotons {
    /// Row k of the result is row `order[k]` of this, not yet paired.
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
            bows: Vec::new(),
        }
    }
}
