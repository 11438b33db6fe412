//! The variants of the matching, and the cost of each.

use std::sync::Arc;

use glam::Vec2;

use super::points::Points;
use crate::clock::fastest;
use lightloom_core::constraint::VisibilityGraph;
use lightloom_core::engine::MovingSegment;
use lightloom_core::flow::MotionMethod;
use lightloom_core::matching::{
    ContinuousMap, MapSettings, Matching, MatchingMethod, SWEEPS, StylizedMap, TransportMap, WallMap,
    mean_square_distance, transport_map, transport_map_with,
};
use lightloom_core::project::Project;
use lightloom_core::{Progress, Result};

/// What takes fewer seconds is timed twice.
const AGAIN: f64 = 0.3;
const LATTICES: [usize; 5] = [32, 64, 128, 256, 512];
const ITERATIONS: [usize; 6] = [0, 1, 2, 5, 10, 40];
const SWEPT: [usize; 6] = [0, 1, 2, 3, 12, 24];
const SWEPT_HALVES: [usize; 4] = [0, 1, 6, 24];

/// A variant of the matching.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Variant {
    /// Along the transport map, as in projects without walls.
    Straight,
    /// Along the map around the walls.
    Around,
    /// Row by row, as given by the files.
    Given,
    /// The method of Günther et al. 2016.
    Stylized,
    /// As `Straight`, with this many lattice cells along the longer side.
    Lattice(usize),
    /// As `Straight`, with this many iterations of the map.
    Iterations(usize),
    /// As `Straight`, with this many sweeps.
    Sweeps(usize),
    /// Bisection and this many sweeps, without a map.
    Halves(usize),
}

/// A measured pairing.
pub(super) struct Matched {
    pub(super) variant: Variant,
    /// Seconds of the map, which all passes share.
    pub(super) map_seconds: f64,
    /// Seconds of the bijection.
    pub(super) pair_seconds: f64,
    /// Mean squared length of the paths.
    pub(super) cost: f64,
}

/// The points and the maps that several variants share.
pub(super) struct Variants<'a> {
    points: &'a Points,
    progress: Progress,
    seed: u64,
    /// The default transport map, and its seconds.
    straight: (TransportMap, f64),
    /// The map around walls and its seconds; none where no wall affects the matching.
    around: Option<(ContinuousMap, f64)>,
}

impl Variant {
    /// The variant of a project.
    pub(super) fn of(project: &Project, walls: bool) -> Self {
        match (project.matching, project.method) {
            (MatchingMethod::Given, _) => Self::Given,
            (MatchingMethod::Transport, MotionMethod::Stylized) => Self::Stylized,
            (MatchingMethod::Transport, MotionMethod::Flow | MotionMethod::Guided) if walls => Self::Around,
            (MatchingMethod::Transport, MotionMethod::Flow | MotionMethod::Guided | MotionMethod::Linear) => {
                Self::Straight
            }
        }
    }

    /// All variants, the project's `own` first, with lattices of at most `cells` cells.
    pub(super) fn list(own: Self, walls: bool, cells: usize) -> Vec<Self> {
        let walls = walls.then_some(Self::Around);
        let mut list: Vec<Self> = [own, Self::Straight, Self::Stylized].into_iter().chain(walls).collect();
        list.extend(LATTICES.into_iter().filter(|lattice| *lattice <= cells).map(Self::Lattice));
        list.extend(ITERATIONS.map(Self::Iterations));
        list.extend(SWEPT.map(Self::Sweeps));
        list.extend(SWEPT_HALVES.map(Self::Halves));
        let mut seen = Vec::new();
        list.retain(|variant| {
            !seen.contains(variant) && {
                seen.push(*variant);
                true
            }
        });
        list
    }

    /// Its name and its value.
    pub(super) fn describe(self) -> (&'static str, Option<usize>) {
        match self {
            Self::Straight => ("transport", None),
            Self::Around => ("transport around walls", None),
            Self::Given => ("rows as given", None),
            Self::Stylized => ("stylized (2016)", None),
            Self::Lattice(cells) => ("lattice", Some(cells)),
            Self::Iterations(count) => ("iterations", Some(count)),
            Self::Sweeps(count) => ("sweeps", Some(count)),
            Self::Halves(count) => ("no map, sweeps", Some(count)),
        }
    }
}

impl<'a> Variants<'a> {
    /// Computes the maps that several variants share.
    ///
    /// # Errors
    /// `Cancelled`.
    pub(super) fn new(
        points: &'a Points,
        photons: &MovingSegment,
        seed: u64,
        progress: &Progress,
    ) -> Result<Self> {
        let (progress, Points { source, target, extent, .. }) = (progress.inner(), points);
        let straight = fastest(2, AGAIN, || transport_map(source, target, *extent, &progress))?;
        let walls = photons.matched_walls();
        let around = || {
            fastest(2, AGAIN, || {
                let graph = Arc::new(VisibilityGraph::new(&walls, *extent, &progress)?);
                let map = WallMap::new(source, target, &graph, &progress)?;
                Ok(ContinuousMap::Walls(map, graph))
            })
        };
        let around = if walls.is_empty() { None } else { Some(around()?) };
        Ok(Self { points, progress, seed, straight, around })
    }

    /// Pairs the points and times it.
    ///
    /// # Errors
    /// `Cancelled`.
    pub(super) fn measure(&self, variant: Variant) -> Result<Matched> {
        let (straight, known) = &self.straight;
        let map_with = |settings: MapSettings| {
            let Points { source, target, extent, .. } = self.points;
            fastest(2, AGAIN, || transport_map_with(source, target, *extent, &settings, &self.progress))
        };
        let ((matching, pair_seconds), map_seconds) = match variant {
            Variant::Given => ((self.points.given(), 0.0), 0.0),
            Variant::Straight => (self.pair(Some(straight), SWEEPS)?, *known),
            Variant::Sweeps(count) => (self.pair(Some(straight), count)?, *known),
            Variant::Halves(count) => (self.pair(None, count)?, 0.0),
            Variant::Lattice(cells) => {
                let (map, seconds) = map_with(MapSettings { cells: Some(cells), ..MapSettings::default() })?;
                (self.pair(Some(&map), SWEEPS)?, seconds)
            }
            Variant::Iterations(iterations) => {
                let settings = MapSettings { iterations, tolerance: 0.0, ..MapSettings::default() };
                let (map, seconds) = map_with(settings)?;
                (self.pair(Some(&map), SWEEPS)?, seconds)
            }
            Variant::Stylized => {
                let Points { source, target, .. } = self.points;
                let (map, seconds) = fastest(2, AGAIN, || StylizedMap::new(source, target, &self.progress))?;
                (self.pair_by(&ContinuousMap::Stylized(map))?, seconds)
            }
            Variant::Around => match &self.around {
                Some((map, seconds)) => (self.pair_by(map)?, *seconds),
                None => (self.pair(Some(straight), SWEEPS)?, *known),
            },
        };
        Ok(Matched { variant, map_seconds, pair_seconds, cost: self.cost(&matching) })
    }

    fn pair(&self, map: Option<&TransportMap>, sweeps: usize) -> Result<(Matching, f64)> {
        let Points { source, target, .. } = self.points;
        fastest(2, AGAIN, || Matching::swept(source, target, map, sweeps, (self.seed, 0), &self.progress))
    }

    fn pair_by(&self, map: &ContinuousMap) -> Result<(Matching, f64)> {
        let Points { source, target, .. } = self.points;
        fastest(2, AGAIN, || Ok(map.pair(source, target, self.seed, 0, &self.progress)?.matching))
    }

    /// Mean squared length of the paths, around walls where there are any.
    fn cost(&self, matching: &Matching) -> f64 {
        let Points { source, target, .. } = self.points;
        let targets: Vec<Vec2> = matching.target_of.iter().map(|&row| target[row as usize]).collect();
        match &self.around {
            Some((map, _)) => map.cost(source, &targets),
            None => mean_square_distance(source, targets.iter().copied()),
        }
    }

    /// Whether walls affect the matching.
    pub(super) fn walls(&self) -> bool {
        self.around.is_some()
    }
}
