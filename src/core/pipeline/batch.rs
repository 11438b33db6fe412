//! One pass's photons on their way from key to key, group by group.

use glam::Vec2;

use super::supply::{KeyPhotons, PassLight, Supplies};
use crate::flow::spatial_order;
use crate::matching::{Matching, Method, TransportMap, transport_map};
use crate::photon::Tracer;
use crate::{Progress, Result};

/// The photons of one pass: where they are now, and the light they share.
pub(super) struct Batch<'a> {
    supplies: &'a Supplies,
    light: PassLight,
    pass: u64,
    method: Method,
    extent: Vec2,
    key: usize,
    /// The photons of each group at the key they stand at.
    pub(super) at: Vec<KeyPhotons>,
}

impl<'a> Batch<'a> {
    /// The photons of `pass` at the first key.
    pub(super) fn start(
        supplies: &'a Supplies,
        tracer: Option<&Tracer>,
        method: Method,
        extent: Vec2,
        (pass, count): (u64, usize),
        progress: &Progress,
    ) -> Result<Self> {
        let light = supplies.light(tracer, pass, count, progress)?;
        let first = |group| {
            let at = supplies.key(0, group, &light, pass);
            match method {
                // Neighbours on the plane become neighbours in memory: a step reads each coefficient of the field once.
                Method::Transport => at.permuted(&spatial_order(&at.positions)),
                Method::Given => at,
            }
        };
        let at = (0..light.groups()).map(first).collect();
        Ok(Self { supplies, light, pass, method, extent, key: 0, at })
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

    /// Where the photons of all groups shall go: row k of each is where photon k goes.
    pub(super) fn next(&self, maps: &[Option<TransportMap>], progress: &Progress) -> Result<Vec<KeyPhotons>> {
        let next = |group: usize| self.pair(group, self.next_points(group), maps[group].as_ref(), progress);
        (0..self.at.len()).map(next).collect()
    }

    /// Pairs the photons of a group with its points of the next key: row k of the result is where photon k shall go.
    /// `map` is absent where rows are paired as given, where the group rests, and where the first pass had no photon of it.
    pub(super) fn pair(
        &self,
        group: usize,
        next: KeyPhotons,
        map: Option<&TransportMap>,
        progress: &Progress,
    ) -> Result<KeyPhotons> {
        let at = &self.at[group];
        if self.rests(group) {
            return Ok(at.in_place(&next));
        }
        if self.method == Method::Given || at.positions.is_empty() {
            return Ok(next);
        }
        let (from, to) = (&at.positions, &next.positions);
        let own = match map {
            Some(_) => None,
            None => Some(transport_map(from, to, self.extent, progress)?),
        };
        let Some(map) = map.or(own.as_ref()) else { return Ok(next) };
        let matching = Matching::new(from, to, map, self.supplies.seed(), self.pass, progress)?;
        Ok(next.permuted(&matching.target_of))
    }

    /// Moves on: the photons stand at the next key now.
    pub(super) fn arrive(&mut self, next: Vec<KeyPhotons>) {
        self.at = next;
        self.key += 1;
    }
}
