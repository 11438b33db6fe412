//! The fit of both halves of a segment, step by step from its key frames to the meeting.

use std::sync::Arc;

use glam::Vec2;
use rayon::prelude::*;
use serde::Serialize;

use super::fields::MeetingFields;
use super::leading_fit::LeadingFit;
use super::segment::MeetingSegment;
use super::tracks::advance;
use crate::bridge::{Bridge, BridgeSettings, CellVelocities, WallsFrom};
use crate::constraint::VisibilityGraph;
use crate::flow::field::{Field, Grid};
use crate::flow::fit::{DirectedLines, FitReport, LineTerm};
use crate::flow::fit_segment::fit_settings;
use crate::flow::observer::FitStatistics;
use crate::flow::report::FlowReport;
use crate::flow::turbulence::Turbulence;
use crate::flow::walls::{Obstacles, SUBSTEPS};
use crate::{Progress, Result};

/// Cells of the plan for each cell of the field.
const PLAN_CELLS: f32 = 1.5;
/// Limits of the cells of a plan along the longer side.
const FINEST: usize = 192;
const FINEST_WITH_WALLS: usize = 128;
const COARSEST: usize = 32;
/// Length over which a liquid is smooth, over that of the pieces that stay together.
const LIQUID: f64 = 0.6;
/// Relative residual of the solver from which on plans beside walls take their usual sweeps, and the least share of these.
const SOLVED: f32 = 1e-4;
const FEWEST_SWEEPS: f32 = 0.3;
/// Steps before the meeting with the plan of the step before them: the time left would make any rest of an error fast.
const UNPLANNED: usize = 2;

/// The flow of a segment that meets half way, before its photons are paired.
pub struct MeetingFit {
    /// The fields.
    pub fields: MeetingFields,
    /// The figures of the fits; those of the motion are in the [`meeting_report`](super::meeting_report).
    pub fits: FlowReport,
    /// The figures of the plans.
    pub plan: BridgeReport,
}

/// Figures of the plans of a segment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, serde::Deserialize)]
pub struct BridgeReport {
    /// Cells along the longer side.
    pub cells: usize,
    /// Misplaced share of the light after the first plan, the worst of all groups.
    pub error: f64,
    /// Share of the light of the earlier and of the later key frame that walls shut off from the other.
    pub shut_off: [f64; 2],
    /// Seconds of all plans, and of all fits.
    pub seconds: [f64; 2],
}

/// Fits the fields that carry the light of both key frames to their meeting.
///
/// # Errors
/// `Value` when there are no photons or one is not finite; `Numeric` when the solver fails or a photon is lost; `Limit`
/// for walls of too many corners; `Cancelled`.
pub fn fit_meeting(segment: &MeetingSegment, progress: &Progress) -> Result<MeetingFit> {
    fit_meeting_with(segment, |plan| plan, progress)
}

/// As [`fit_meeting`] with other cells or sweeps of the plan, which `refine` sets: for those who measure what they are worth.
///
/// # Errors
/// As [`fit_meeting`].
pub fn fit_meeting_with(
    segment: &MeetingSegment,
    refine: impl FnOnce(BridgeSettings) -> BridgeSettings + Send,
    progress: &Progress,
) -> Result<MeetingFit> {
    // Inside the thread pool the many small parallel loops need not wake it up each time.
    rayon::scope(|_| fit_in_pool(segment, refine, progress))
}

fn fit_in_pool(
    segment: &MeetingSegment,
    refine: impl FnOnce(BridgeSettings) -> BridgeSettings,
    progress: &Progress,
) -> Result<MeetingFit> {
    let MeetingSegment { extent, settings, number, walls, .. } = *segment;
    let guides = segment.guides()?;
    let even = (settings.steps as usize).next_multiple_of(2);
    let (obstacles, steps) = Obstacles::new(walls, (even, SUBSTEPS), extent, &progress.inner())?;
    let obstacles = obstacles.map(Arc::new);
    let turbulence = settings.turbulence.as_ref().and_then(|noise| Turbulence::new(noise, extent, number));
    let fields = MeetingFields::new(steps, 0.0, turbulence, obstacles.clone()).with_hold(settings.hold);
    let standing = obstacles.as_deref().map_or_else(Vec::new, standing);
    let fitter = MeetingFitter::new(segment, (fields, &standing), guides, refine)?;
    fitter.run(segment, progress)
}

/// The walls by the time from which they stand.
fn standing(obstacles: &Obstacles) -> Vec<WallsFrom<'_>> {
    let steps = obstacles.steps() as f64;
    let mut walls = Vec::new();
    for (step, graph) in obstacles.epochs() {
        let barriers = graph.map(VisibilityGraph::barriers);
        walls.push(WallsFrom { time: step as f64 / steps, barriers });
    }
    walls
}

/// The state of a fit between steps.
struct MeetingFitter<'a> {
    fields: MeetingFields,
    /// By group.
    bridges: Vec<Bridge<'a>>,
    halves: [Half<'a>; 2],
    grid: Grid,
    statistics: FitStatistics,
    plan: BridgeReport,
}

/// One half between steps.
struct Half<'a> {
    /// 0 for that of the earlier key frame, 1 for that of the later.
    side: usize,
    /// Guide photons by group.
    photons: Vec<Vec<Vec2>>,
    fit: LeadingFit,
    lines: DirectedLines<'a>,
}

/// The fit of one step of a half.
struct FittedStep {
    field: Field,
    beside_walls: Option<(CellVelocities, Option<Field>)>,
    time: f64,
    report: FitReport,
    /// What the field was fitted to.
    positions: Vec<Vec2>,
    velocities: Vec<Vec2>,
}

impl<'a> MeetingFitter<'a> {
    fn new(
        segment: &MeetingSegment<'a>,
        (fields, standing): (MeetingFields, &[WallsFrom<'a>]),
        photons: Vec<[Vec<Vec2>; 2]>,
        refine: impl FnOnce(BridgeSettings) -> BridgeSettings,
    ) -> Result<Self> {
        let MeetingSegment { extent, settings, lines, .. } = *segment;
        let fit = fit_settings(settings, extent);
        let longer = fit.grid.cells.into_iter().max().unwrap_or(COARSEST);
        let plan = BridgeSettings {
            extent,
            cells: ((longer as f32 * PLAN_CELLS) as usize)
                .clamp(COARSEST, if standing.is_empty() { FINEST } else { FINEST_WITH_WALLS }),
            steps: fields.steps(),
            hold: settings.hold,
            density: settings.density,
            sweeps: match standing.is_empty() {
                true => 1.0,
                false => (SOLVED / settings.tolerance).sqrt().clamp(FEWEST_SWEEPS, 1.0),
            },
        };
        let plan = refine(plan);
        let liquid = LIQUID * f64::from(settings.hold);
        let widths = lines.iter().map(|line| line.width);
        let line_width = (settings.beta > 0.0).then(|| widths.reduce(f32::min)).flatten();
        let bridges = photons.iter().map(|_| Bridge::new(plan, standing)).collect();
        let (earlier, later) = photons.into_iter().map(|[earlier, later]| (earlier, later)).unzip();
        let half = |side: usize, photons: Vec<Vec<Vec2>>| {
            let lines = DirectedLines::new(lines, settings.beta, fit.grid);
            Ok(Half { side, photons, fit: LeadingFit::new(fit, liquid, line_width)?, lines })
        };
        Ok(Self {
            fields,
            bridges,
            halves: [half(0, earlier)?, half(1, later)?],
            grid: fit.grid,
            statistics: FitStatistics::default(),
            plan: BridgeReport { cells: plan.cells, ..BridgeReport::default() },
        })
    }

    fn run(mut self, segment: &MeetingSegment, progress: &Progress) -> Result<MeetingFit> {
        let half = self.fields.steps() / 2;
        progress.begin("plan", 1);
        self.renew(0, progress)?;
        progress.begin("fit", half as u64);
        for done in 0..half {
            if done > 0 && done + UNPLANNED < half {
                self.renew(done, progress)?;
            }
            self.fit(done, segment.extent, progress)?;
            self.advance(done, progress)?;
            progress.advance(1);
        }
        Ok(MeetingFit { fields: self.fields, fits: self.statistics.report(), plan: self.plan })
    }

    /// Makes the plans of all groups anew.
    fn renew(&mut self, done: usize, progress: &Progress) -> Result<()> {
        let start = std::time::Instant::now();
        let [earlier, later] = self.halves.each_ref().map(|half| &half.photons);
        let bridges = self.bridges.par_iter_mut().zip(earlier).zip(later);
        bridges.try_for_each(|((bridge, a), b)| bridge.renew(done, [a, b], progress))?;
        if done == 0 {
            for bridge in &self.bridges {
                self.plan.error = self.plan.error.max(bridge.error());
                let shut_off = bridge.shut_off();
                self.plan.shut_off = [0, 1].map(|side| self.plan.shut_off[side].max(shut_off[side]));
            }
            let counts = earlier.iter().map(Vec::len);
            let sum: f32 =
                self.bridges.iter().zip(counts.clone()).map(|(b, count)| b.mean_speed() * count as f32).sum();
            self.fields.set_mean_way(sum / counts.sum::<usize>().max(1) as f32);
        }
        self.plan.seconds[0] += start.elapsed().as_secs_f64();
        Ok(())
    }

    /// Fits the fields of one step of both halves to the planned velocities, and keeps them.
    fn fit(&mut self, done: usize, extent: Vec2, progress: &Progress) -> Result<()> {
        let start = std::time::Instant::now();
        let Self { fields, bridges, grid, halves: [earlier, later], .. } = self;
        let (plan, grid) = ((&*fields, &**bridges), *grid);
        let places = |photons: &[Vec2]| one_in_each_place(photons, grid, extent);
        let (earlier, later) = rayon::join(
            || earlier.fit(plan, done, places, progress),
            || later.fit(plan, done, places, progress),
        );
        for (side, step) in [earlier?, later?].into_iter().enumerate() {
            let FittedStep { field, beside_walls, time, report, positions, velocities } = step;
            self.statistics.fitted((&field, &self.fields.noise(time)), &report, &positions, &velocities);
            self.fields.push(side, field, beside_walls);
        }
        self.plan.seconds[1] += start.elapsed().as_secs_f64();
        Ok(())
    }

    /// Advances the photons of both halves by one step.
    fn advance(&mut self, done: usize, progress: &Progress) -> Result<()> {
        for Half { side, photons, .. } in &mut self.halves {
            for photons in photons {
                advance(&self.fields, *side, done, photons, progress)?;
            }
        }
        Ok(())
    }
}

impl Half<'_> {
    /// Fits the field of one step to the planned velocities, at those `places` of photons that count.
    fn fit(
        &mut self,
        (fields, bridges): (&MeetingFields, &[Bridge]),
        done: usize,
        places: impl Fn(&[Vec2]) -> Vec<Vec2>,
        progress: &Progress,
    ) -> Result<FittedStep> {
        let side = self.side;
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let (mut positions, mut velocities) = (Vec::new(), Vec::new());
        for (bridge, photons) in bridges.iter().zip(&self.photons) {
            let first = positions.len();
            positions.extend(places(photons));
            velocities.extend(positions[first..].iter().map(|&p| sign * bridge.velocity(side, p)));
        }
        let steps = fields.steps();
        let time = if side == 0 { done as f64 } else { (steps - done) as f64 } / steps as f64;
        let lines = &mut self.lines;
        let rows = lines.act_at(time).then(|| lines.rows(time, &positions, &velocities));
        let lines = rows.as_ref().map(|(rows, mask)| LineTerm { rows, mask });
        let part = 2.0 * done as f64 / steps as f64;
        let (field, pull, report) = self.fit.fit(part, (&positions, &velocities), lines, progress)?;
        drop(rows);
        // One plan stands beside walls for all groups that share the field: that of the first, whose walls are the same.
        let walls = fields.obstacles().is_some();
        let beside_walls = walls.then(|| (bridges[0].velocities(side, sign), pull));
        Ok(FittedStep { field, beside_walls, time, report, positions, velocities })
    }
}

/// The first photon in each quarter of a cell of the fit: even weight over the lit area, or thin light would be dragged along
/// by the bright.
fn one_in_each_place(photons: &[Vec2], grid: Grid, extent: Vec2) -> Vec<Vec2> {
    let [width, height] = grid.cells.map(|cells| 2 * cells);
    let mut taken = vec![false; width * height];
    let scale = Vec2::new(width as f32, height as f32) / extent;
    let first = |p: &&Vec2| {
        let place = **p * scale;
        let column = (place.x.max(0.0) as usize).min(width - 1);
        let row = (place.y.max(0.0) as usize).min(height - 1);
        !std::mem::replace(&mut taken[row * width + column], true)
    };
    photons.iter().filter(first).copied().collect()
}
