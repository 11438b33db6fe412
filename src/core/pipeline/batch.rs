//! One pass's photons on their way from key to key, group by group.

use glam::Vec2;

use super::light::{KeyPhotons, Partners, PassLight};
use super::mover::Kind;
use super::supply::Supplies;
use crate::flow::spatial_order;
use crate::matching::{ANCHORS, ContinuousMap, Method};
use crate::project::Project;
use crate::{Progress, Result};

/// The photons of one pass: where they are now, and the light they share.
pub(super) struct Batch<'a> {
    supplies: &'a Supplies,
    light: PassLight,
    pass: u64,
    project: &'a Project,
    extent: Vec2,
    /// Most anchors of a map around walls.
    anchors: usize,
    key: usize,
    /// The photons of each group at the key they stand at.
    pub(super) at: Vec<KeyPhotons>,
}

impl<'a> Batch<'a> {
    /// The photons of `pass`, whose light is `light`, at the first key.
    pub(super) fn start(
        supplies: &'a Supplies,
        light: PassLight,
        pass: u64,
        project: &'a Project,
        extent: Vec2,
    ) -> Self {
        let first = |group| {
            let at = supplies.key(0, group, &light, pass);
            match project.matching {
                // Neighbours on the plane become neighbours in memory: a step reads each coefficient of the field once.
                Method::Transport => at.permuted(&spatial_order(&at.positions)),
                Method::Given => at,
            }
        };
        let at = (0..light.groups.len()).map(first).collect();
        Self { supplies, light, pass, project, extent, anchors: ANCHORS, key: 0, at }
    }

    /// The same, matched around walls by no more than `anchors` anchors.
    pub(super) fn with_anchors(self, anchors: usize) -> Self {
        Self { anchors, ..self }
    }

    /// What the photons of the pass are made from.
    pub(super) fn supplies(&self) -> &'a Supplies {
        self.supplies
    }

    /// The light that the groups share.
    pub(super) fn light(&self) -> &PassLight {
        &self.light
    }

    /// Whether the photons of a group stay in place until the next key.
    pub(super) fn rests(&self, group: usize) -> bool {
        self.supplies.rests(self.key, group)
    }

    /// The flux that all photons should have at the key they stand at; watts.
    pub(super) fn asked(&self) -> f64 {
        self.supplies.asked(self.key, &self.light)
    }

    /// The same at the next key.
    pub(super) fn asked_next(&self) -> f64 {
        self.supplies.asked(self.key + 1, &self.light)
    }

    /// The points of the next key for a group, not yet paired.
    pub(super) fn next_points(&self, group: usize) -> KeyPhotons {
        self.supplies.key(self.key + 1, group, &self.light, self.pass)
    }

    /// Where the light of a group goes that shows `points` at the next key; none where rows are paired as given, where the
    /// group rests, and where there is no photon of it.
    pub(super) fn map(
        &self,
        group: usize,
        points: &[Vec2],
        progress: &Progress,
    ) -> Result<Option<ContinuousMap>> {
        let from = &self.at[group].positions;
        if self.rests(group) || from.is_empty() {
            return Ok(None);
        }
        let kind = Kind::of(self.project, self.key, self.extent);
        kind.map((from, points), (self.extent, self.anchors), progress)
    }

    /// Where the photons of all groups shall go: row k of each is where photon k goes.
    pub(super) fn next(
        &self,
        maps: &[Option<ContinuousMap>],
        progress: &Progress,
    ) -> Result<Vec<KeyPhotons>> {
        let next = |group: usize| self.pair(group, self.next_points(group), maps[group].as_ref(), progress);
        (0..self.at.len()).map(next).collect()
    }

    /// Pairs the photons of a group with its points of the next key: row k of the result is where photon k shall go.
    fn pair(
        &self,
        group: usize,
        next: KeyPhotons,
        map: Option<&ContinuousMap>,
        progress: &Progress,
    ) -> Result<KeyPhotons> {
        Ok(self.partners(group, &next.positions, map, progress)?.arrange(next))
    }

    /// Which of its `points` at the next key each photon of a group goes to. `map` is absent where rows are paired as
    /// given, where the group rests, and where the first pass had no photon of it.
    pub(super) fn partners(
        &self,
        group: usize,
        points: &[Vec2],
        map: Option<&ContinuousMap>,
        progress: &Progress,
    ) -> Result<Partners> {
        let at = &self.at[group];
        if self.rests(group) {
            return Ok(Partners { order: Some(at.origin.clone()), bows: Vec::new() });
        }
        if at.positions.is_empty() {
            return Ok(Partners::default());
        }
        let own = match map {
            Some(_) => None,
            None => self.map(group, points, progress)?,
        };
        let Some(map) = map.or(own.as_ref()) else { return Ok(Partners::default()) };
        let paired = map.pair(&at.positions, points, self.supplies.seed(), self.pass, progress)?;
        Ok(Partners { order: Some(paired.matching.target_of), bows: paired.midpoint_offsets })
    }

    /// Moves on: the photons stand at the next key now.
    pub(super) fn arrive(&mut self, next: Vec<KeyPhotons>) {
        self.at = next;
        self.key += 1;
    }
}
