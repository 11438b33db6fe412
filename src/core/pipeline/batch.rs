//! One pass's photons on their way from key to key.

use super::supply::{KeyPhotons, PassLight, Supplies};
use crate::flow::spatial_order;
use crate::matching::{ContinuousMap, Method};
use crate::photon::Tracer;
use crate::{Progress, Result};

/// The photons of one pass: where they are now, and the light they share.
pub(super) struct Batch<'a> {
    supplies: &'a Supplies,
    light: PassLight,
    pass: u64,
    count: usize,
    method: Method,
    key: usize,
    /// The photons at the key they stand at.
    pub(super) at: KeyPhotons,
}

impl<'a> Batch<'a> {
    /// The photons of `pass` at the first key.
    pub(super) fn start(
        supplies: &'a Supplies,
        tracer: Option<&Tracer>,
        method: Method,
        pass: u64,
        count: usize,
        progress: &Progress,
    ) -> Result<Self> {
        let light = supplies.light(tracer, pass, count, progress)?;
        let mut at = supplies.key(0, &light, pass, count);
        if method == Method::Transport {
            // Neighbours on the plane become neighbours in memory: a step reads each coefficient of the field once.
            at = at.permuted(&spatial_order(&at.positions));
        }
        Ok(Self { supplies, light, pass, count, method, key: 0, at })
    }

    /// The points of the next key, not yet paired.
    pub(super) fn next_points(&self) -> KeyPhotons {
        self.supplies.key(self.key + 1, &self.light, self.pass, self.count)
    }

    /// Pairs the photons with the points of the next key: row k of the result is where photon k shall go.
    /// `map` is absent where rows are paired as given.
    pub(super) fn pair(
        &self,
        next: KeyPhotons,
        map: Option<&ContinuousMap>,
        progress: &Progress,
    ) -> Result<KeyPhotons> {
        match (self.method, map) {
            (Method::Transport, Some(map)) => {
                let (from, seed) = (&self.at.positions, self.supplies.seed());
                let paired = map.pair(from, &next.positions, seed, self.pass, progress)?;
                Ok(KeyPhotons { bows: paired.bows, ..next.permuted(&paired.matching.target_of) })
            }
            _ => Ok(next),
        }
    }

    /// Moves on: the photons stand at the next key now.
    pub(super) fn arrive(&mut self, next: KeyPhotons) {
        self.at = next;
        self.key += 1;
    }
}

impl KeyPhotons {
    /// Row k of the result is row `order[k]` of this, not yet paired.
    fn permuted(&self, order: &[u32]) -> Self {
        Self {
            positions: order.iter().map(|&i| self.positions[i as usize]).collect(),
            flux: order.iter().map(|&i| self.flux[i as usize]).collect(),
            bows: Vec::new(),
        }
    }
}
