//! The continuous map of either method behind one interface.

use glam::Vec2;

use super::bijection::Matching;
use super::dual::dual_bound;
use super::stylized::StylizedMap;
use super::transport_map::TransportMap;
use crate::{Progress, Result};

/// Where the light of one key goes at the next: it makes the photons of every pass move together.
#[derive(Clone, Debug)]
pub enum ContinuousMap {
    /// The optimal map between the densities.
    Transport(TransportMap),
    /// The thin-plate warp of the method before.
    Stylized(StylizedMap),
}

/// The photons of one pass, paired.
#[derive(Clone, Debug, PartialEq)]
pub struct Pairing {
    /// Who goes where.
    pub matching: Matching,
    /// How far each photon's way bows from the straight one at half-time, plane units, one per source row; empty where
    /// the method bows none.
    pub bows: Vec<Vec2>,
}

impl ContinuousMap {
    /// Pairs `source` with `target`, as many points, near this map. Deterministic in (seed, pass).
    ///
    /// # Errors
    /// `Value` when the counts differ, a set is empty or a point is not finite; `Cancelled`.
    pub fn pair(
        &self,
        source: &[Vec2],
        target: &[Vec2],
        seed: u64,
        pass: u64,
        progress: &Progress,
    ) -> Result<Pairing> {
        match self {
            Self::Transport(map) => {
                let matching = Matching::new(source, target, map, seed, pass, progress)?;
                Ok(Pairing { matching, bows: Vec::new() })
            }
            Self::Stylized(map) => {
                let (matching, bows) = map.pair(source, target, progress)?;
                Ok(Pairing { matching, bows })
            }
        }
    }

    /// A lower bound of the mean squared distance of any bijection between these points, where the map has one to tell.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn lower_bound(&self, source: &[Vec2], target: &[Vec2], progress: &Progress) -> Result<Option<f64>> {
        match self {
            Self::Transport(map) => dual_bound(map, source, target, progress).map(Some),
            Self::Stylized(_) => Ok(None),
        }
    }
}
