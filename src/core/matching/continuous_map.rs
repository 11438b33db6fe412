//! The continuous maps of all methods behind one interface.

use std::sync::Arc;

use glam::Vec2;
use rayon::prelude::*;

use super::bijection::{Matching, mean_square_distance};
use super::dual::dual_bound;
use super::stylized::StylizedMap;
use super::transport_map::{TransportMap, transport_map};
use super::wall_map::WallMap;
use crate::constraint::VisibilityGraph;
use crate::constraint::visibility::SearchBuffers;
use crate::{Progress, Result};

/// Photons per parallel task; fixed, so that sums come out the same on any number of threads.
const CHUNK: usize = 4096;

/// The continuous map from one key to the next: photons of all passes are paired near it, and so move together.
#[derive(Clone, serde::Deserialize, serde::Serialize)]
pub enum ContinuousMap {
    /// The optimal transport map between the densities.
    Transport(TransportMap),
    /// The map around walls, with the graph of those walls.
    Walls(WallMap, Arc<VisibilityGraph>),
    /// The optimal transport map between points that are near each other, beside the walls of this graph.
    Beside(TransportMap, Arc<VisibilityGraph>),
    /// The thin-plate warp of the 2016 method.
    Stylized(StylizedMap),
}

/// The pairing of the photons of one pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Pairing {
    /// The bijection.
    pub matching: Matching,
    /// Offset of each photon's path from the straight one at t = 1/2, plane units, one per source row; empty where all
    /// paths are straight.
    pub midpoint_offsets: Vec<Vec2>,
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
                Ok(Pairing { matching, midpoint_offsets: Vec::new() })
            }
            Self::Walls(map, graph) => {
                let matching = Matching::around_walls(source, target, (map, graph), seed, pass, progress)?;
                Ok(Pairing { matching, midpoint_offsets: Vec::new() })
            }
            Self::Beside(map, graph) => {
                let matching = Matching::beside_walls(source, target, (map, graph), seed, pass, progress)?;
                Ok(Pairing { matching, midpoint_offsets: Vec::new() })
            }
            Self::Stylized(map) => {
                let (matching, midpoint_offsets) = map.pair(source, target, progress)?;
                Ok(Pairing { matching, midpoint_offsets })
            }
        }
    }

    /// Mean squared path length of points paired row by row, plane units squared. Pairs that no path connects count as
    /// straight.
    pub fn cost(&self, source: &[Vec2], targets: &[Vec2]) -> f64 {
        let (Self::Walls(_, graph) | Self::Beside(_, graph)) = self else {
            return mean_square_distance(source, targets.iter().copied());
        };
        let squares = source.par_chunks(CHUNK).zip(targets.par_chunks(CHUNK)).map(|(source, targets)| {
            let mut buffers = SearchBuffers::default();
            let square = |(&a, &b): (&Vec2, &Vec2)| {
                let length = graph.distance(a, b, &mut buffers);
                f64::from(if length.is_finite() { length } else { a.distance(b) }).powi(2)
            };
            source.iter().zip(targets).map(square).sum::<f64>()
        });
        squares.collect::<Vec<_>>().iter().sum::<f64>() / source.len().max(1) as f64
    }

    /// A lower bound of the mean squared distance of any bijection between these points, where the map provides one;
    /// around walls that of straight paths.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn lower_bound(&self, source: &[Vec2], target: &[Vec2], progress: &Progress) -> Result<Option<f64>> {
        match self {
            Self::Transport(map) | Self::Beside(map, _) => {
                dual_bound(map, source, target, progress).map(Some)
            }
            Self::Walls(_, graph) => {
                let map = transport_map(source, target, graph.extent(), progress)?;
                dual_bound(&map, source, target, progress).map(Some)
            }
            Self::Stylized(_) => Ok(None),
        }
    }
}
