//! Photons carried along a fitted flow, observed independently of the numbers that the flow reports.

use glam::Vec2;
use rayon::prelude::*;

use super::case::{EnergyOf, Input, Limits, Measured};
use crate::effort::Effort;
use lightloom_core::constraint::{ActiveLine, ActiveWall};
use lightloom_core::flow::{
    FieldTrajectories, FitKind, FlowReport, FlowSettings, GridSize, GuideTracks, Segment, Trajectories as _,
    fit_tracks,
};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::{Progress, Result};

/// Photons, their targets, and the settings and constraints of their flow.
pub(super) struct FlowCase {
    pub(super) source: Vec<Vec2>,
    pub(super) target: Vec<Vec2>,
    pub(super) extent: Vec2,
    pub(super) settings: FlowSettings,
    pub(super) lines: Vec<ActiveLine>,
    pub(super) walls: Vec<ActiveWall>,
}

/// Most iterations of a solve. Measured for alpha 1e-1 to 1e-5 are 6 to 17, whatever the grid; at 60 a step of the default
/// grid still takes less than half a second.
pub(super) const ITERATIONS: usize = 60;

impl FlowCase {
    /// The plain case: a disc to a ring, both potentials at once, the default fade.
    pub(super) fn new(effort: Effort) -> Self {
        let count = effort.pick(2000, 100_000);
        let settings = FlowSettings {
            fit: FitKind::Joint,
            grid: GridSize::Longer(effort.pick(32, 128)),
            steps: effort.pick(8, 20),
            alpha: 1e-3,
            ..FlowSettings::default()
        };
        let (source, target) = (disc([0.3, 0.4], 0.2, count), ring(count));
        Self { source, target, extent: Vec2::ONE, settings, lines: Vec::new(), walls: Vec::new() }
    }
}

impl Input for FlowCase {
    fn limits(&self) -> Limits {
        let tolerance = f64::from(self.settings.tolerance);
        Limits {
            // The fade hands each photon to b - (1 - t) v, which is b at t = 1.
            endpoint_error: Some(0.0),
            solver_error: Some(tolerance),
            iterations: Some(ITERATIONS),
            // E(u) <= E(0) for the minimiser of E, and so |u - v| <= |v|; the solver stops short of it by its tolerance.
            energy: Some(1.0 + tolerance),
            crossings: Some(0),
            unreachable: Some([0, 0]),
            ..Limits::FINITE
        }
    }

    fn check(&self) -> Result<()> {
        self.settings.check("flow")
    }

    /// Fits, follows the guide photons and as many photons of a later pass, and checks where they went.
    fn run(&self, progress: &Progress) -> Result<Measured> {
        let Self { source, target, extent, settings, lines, walls } = self;
        let segment = Segment { lines, walls, ..Segment::new(source, target, *extent, settings) };
        let mut guides = CrossingObserver::new(walls);
        let GuideTracks { fields, report, positions, .. } = fit_tracks(&segment, progress)?;
        positions.iter().for_each(|positions| guides.observe(positions));
        let mut later = CrossingObserver::new(walls);
        let beside =
            |points: &[Vec2]| points.iter().map(|p| *p + Vec2::new(0.003, -0.002)).collect::<Vec<_>>();
        let (source, target) = (beside(source), beside(target));
        let mut carrier = FieldTrajectories::new(&fields, &source, &target);
        let mut positions = vec![Vec2::ZERO; source.len()];
        for n in 0..=fields.steps() {
            carrier.positions_at(n as f64 / fields.steps() as f64, &mut positions, progress)?;
            later.observe(&positions);
        }
        let arrived = positions.iter().zip(&target).map(|(c, b)| f64::from(c.distance(*b)));
        let violations = carrier.wall_violations();
        let measured = Measured {
            finite: guides.finite && later.finite,
            endpoint_error: Some(arrived.fold(report.endpoint_error, f64::max)),
            // Unreachable photons may go through a wall; all others that do have crossed it, as have those the flow counts.
            crossings: Some(
                report.wall_crossings
                    + violations.crossings
                    + guides.crossed().saturating_sub(report.unreachable)
                    + later.crossed().saturating_sub(violations.unreachable),
            ),
            ..of_report(&report)
        };
        Ok(Measured { unreachable: Some(report.unreachable.max(violations.unreachable)), ..measured })
    }
}

/// The numbers that the flow reports.
fn of_report(report: &FlowReport) -> Measured {
    let numbers = [report.divergence_rms, report.curl_rms, report.peak_speed_ratio, report.dispersion];
    Measured {
        finite: numbers.into_iter().all(f64::is_finite),
        endpoint_error: Some(report.endpoint_error),
        solver_error: Some(report.solver_error),
        iterations: Some(report.solver_iterations),
        condition: Some(report.solver_condition).filter(|condition| *condition > 0.0),
        energy: Some(report.fit_residual),
        energy_of: EnergyOf::Misfit,
        ..Measured::default()
    }
}

/// An observer of photons from step to step.
pub(super) struct CrossingObserver<'a> {
    walls: &'a [ActiveWall],
    before: Vec<Vec2>,
    crossed: Vec<bool>,
    finite: bool,
}

impl<'a> CrossingObserver<'a> {
    pub(super) fn new(walls: &'a [ActiveWall]) -> Self {
        Self { walls, before: Vec::new(), crossed: Vec::new(), finite: true }
    }

    pub(super) fn observe(&mut self, positions: &[Vec2]) {
        self.finite &= positions.iter().all(|p| p.is_finite());
        if self.finite && !self.walls.is_empty() && !self.before.is_empty() {
            let edges = || self.walls.iter().flat_map(|wall| wall.points.windows(2));
            self.crossed.resize(positions.len(), false);
            self.crossed.par_iter_mut().zip(&self.before).zip(positions).for_each(|((crossed, &a), &b)| {
                *crossed |= a != b && edges().any(|wall| crosses([a, b], [wall[0], wall[1]]));
            });
        }
        self.before = positions.to_vec();
    }

    /// Whether all positions so far were.
    pub(super) fn is_finite(&self) -> bool {
        self.finite
    }

    /// Number of photons that went through a wall in any step.
    pub(super) fn crossed(&self) -> usize {
        self.crossed.iter().filter(|crossed| **crossed).count()
    }
}

/// Whether two line segments cross: the ends of each lie on both sides of the other, by exact predicates.
fn crosses(path: [Vec2; 2], wall: [Vec2; 2]) -> bool {
    let parts = |[p, q]: [Vec2; 2], [a, b]: [Vec2; 2]| {
        let at = |p: Vec2| robust::Coord { x: f64::from(p.x), y: f64::from(p.y) };
        let side = |r: Vec2| robust::orient2d(at(p), at(q), at(r));
        let [a, b] = [side(a), side(b)];
        a.min(b) < 0.0 && a.max(b) > 0.0
    };
    let [low, high] = [wall[0].min(wall[1]), wall[0].max(wall[1])];
    let apart = path[0].max(path[1]).cmplt(low).any() || path[0].min(path[1]).cmpgt(high).any();
    !apart && parts(wall, path) && parts(path, wall)
}

/// `count` points spread evenly over a disc.
pub(super) fn disc(centre: [f32; 2], radius: f32, count: usize) -> Vec<Vec2> {
    let golden = 2.399_963_2_f32;
    let at = |i: usize| {
        ((i as f32 + 0.5) / count as f32).sqrt()
            * Vec2::from_angle((i as f32 * golden) % std::f32::consts::TAU)
    };
    (0..count).map(|i| Vec2::from(centre) + radius * at(i)).collect()
}

/// `count` points on a ring around the middle of the plane's upper right, in the order of [`disc`].
fn ring(count: usize) -> Vec<Vec2> {
    let to_ring = |p: Vec2| Vec2::new(0.6, 0.6) + (0.2 + 0.5 * p.length()) * p.normalize_or(Vec2::X);
    disc([0.0; 2], 0.2, count).into_iter().map(to_ring).collect()
}

/// `count` points anywhere on the unit square, the same for the same seed.
pub(super) fn cloud(seed: u64, count: usize) -> Vec<Vec2> {
    let mut random = Stream::new(seed, Purpose::Trace, 0, 0);
    (0..count).map(|_| Vec2::new(random.f32(), random.f32())).collect()
}
