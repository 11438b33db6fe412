//! The continuous map of either method behind one interface.

use std::sync::Arc;

use glam::Vec2;
use rayon::prelude::*;

use super::around::AroundMap;
use super::bijection::{Matching, mean_square_distance};
use super::dual::dual_bound;
use super::stylized::StylizedMap;
use super::transport_map::{TransportMap, transport_map};
use crate::constraint::Detour;
use crate::constraint::detour::Sight;
use crate::{Progress, Result};

/// Photons per parallel task; fixed, so that sums come out the same on any number of threads.
const CHUNK: usize = 4096;

/// Where the light of one key goes at the next: it makes the photons of every pass move together.
#[derive(Clone)]
pub enum ContinuousMap {
    /// The optimal map between the densities.
    Transport(TransportMap),
    /// The map around walls, and those walls.
    Around(AroundMap, Arc<Detour>),
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
            Self::Around(map, detour) => {
                let matching = Matching::around(source, target, (map, detour), seed, pass, progress)?;
                Ok(Pairing { matching, bows: Vec::new() })
            }
            Self::Stylized(map) => {
                let (matching, bows) = map.pair(source, target, progress)?;
                Ok(Pairing { matching, bows })
            }
        }
    }

    /// Mean squared length of the ways of points that are paired row by row, plane units squared. Pairs that no way
    /// connects count as straight.
    pub fn cost(&self, source: &[Vec2], targets: &[Vec2]) -> f64 {
        let Self::Around(_, detour) = self else {
            return mean_square_distance(source, targets.iter().copied());
        };
        let squares = source.par_chunks(CHUNK).zip(targets.par_chunks(CHUNK)).map(|(source, targets)| {
            let mut sight = Sight::default();
            let square = |(&a, &b): (&Vec2, &Vec2)| {
                let way = detour.distance(a, b, &mut sight);
                f64::from(if way.is_finite() { way } else { a.distance(b) }).powi(2)
            };
            source.iter().zip(targets).map(square).sum::<f64>()
        });
        squares.collect::<Vec<_>>().iter().sum::<f64>() / source.len().max(1) as f64
    }

    /// A lower bound of the mean squared distance of any bijection between these points, where the map has one to tell.
    /// Around walls it is that of straight ways.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn lower_bound(&self, source: &[Vec2], target: &[Vec2], progress: &Progress) -> Result<Option<f64>> {
        match self {
            Self::Transport(map) => dual_bound(map, source, target, progress).map(Some),
            Self::Around(_, detour) => {
                let map = transport_map(source, target, detour.extent(), progress)?;
                dual_bound(&map, source, target, progress).map(Some)
            }
            Self::Stylized(_) => Ok(None),
        }
    }
}
