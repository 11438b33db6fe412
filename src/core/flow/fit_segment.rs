//! The fields of a segment, fitted step by step while the guide photons move along them.

use std::sync::Arc;

use glam::Vec2;

use super::field::{Field, Grid};
use super::fields::Fields;
use super::fit::{Blend, DirectedLines, FitReport, FitSettings, Fitter, LineTerm, NoPenetrationRows};
use super::guidance;
use super::observer::{FitStatistics, Kinematics as _, Observer};
use super::photons::GuidedPhotons;
use super::report::FlowReport;
use super::segment::{Segment, check_photons, guide_rows};
use super::settings::{FitKind, FlowSettings};
use super::turbulence::Turbulence;
use super::walls::Obstacles;
use crate::{Progress, Result};

/// Limit of solver iterations: with multigrid some ten suffice; a solve that needs this many has failed.
const MAX_ITERATIONS: usize = 500;

/// Receives an index and the positions of the guide photons.
type ShowPositions<'a> = &'a mut dyn FnMut(usize, &[Vec2]);

/// Positions of the guide photons at chosen times, shown while the fields are fitted.
pub struct Snapshots<'a> {
    /// Times within 0..=1, ascending.
    pub times: &'a [f64],
    /// Receives the index of a time and the positions then, those of the [`FieldTrajectories`](super::FieldTrajectories)
    /// of the same photons.
    pub show: ShowPositions<'a>,
}

/// A fitted segment with the tracks of its guide photons.
pub struct GuideTracks {
    /// The fields.
    pub fields: Fields,
    /// Their report.
    pub report: FlowReport,
    /// Rows of the segment that are guide photons.
    pub rows: Vec<usize>,
    /// Positions of the guide photons at the begin of each step, and at the end.
    pub positions: Vec<Vec<Vec2>>,
}

/// Fits the fields that carry the photons of a segment, row by row.
///
/// The fields are fitted to at most `settings.guides` photons, evenly spaced rows: a field of 128 x 128 cells is
/// determined by some 100 000.
///
/// # Errors
/// `Value` when there are no photons, the columns differ in length or hold a number that is not finite; `Numeric` when the
/// solver fails or a photon is lost; `Cancelled`.
pub fn fit_segment(segment: &Segment, progress: &Progress) -> Result<(Fields, FlowReport)> {
    fit(segment, None, None, progress)
}

/// As [`fit_segment`], with the tracks of the guide photons.
///
/// # Errors
/// As [`fit_segment`].
pub fn fit_tracks(segment: &Segment, progress: &Progress) -> Result<GuideTracks> {
    let mut positions = Vec::new();
    let mut keep = |_: usize, at: &[Vec2]| positions.push(at.to_vec());
    let (fields, report) = fit(segment, Some(&mut keep), None, progress)?;
    let rows = guide_rows(segment.source.len(), segment.settings.guides as usize);
    Ok(GuideTracks { fields, report, rows, positions })
}

/// As [`fit_segment`], with snapshots of the guide photons: where all photons are guides, a second pass through the fields
/// is saved.
///
/// # Errors
/// As [`fit_segment`].
pub fn fit_with_snapshots(
    segment: &Segment,
    snapshots: Option<Snapshots>,
    progress: &Progress,
) -> Result<(Fields, FlowReport)> {
    fit(segment, None, snapshots, progress)
}

/// `show_step` receives the number of each step with the positions at its begin, then those at the end.
fn fit(
    segment: &Segment,
    mut show_step: Option<ShowPositions>,
    mut snapshots: Option<Snapshots>,
    progress: &Progress,
) -> Result<(Fields, FlowReport)> {
    let Segment { source, target, extent, settings, .. } = *segment;
    check_photons(source, target)?;
    let guides = guide_rows(source.len(), settings.guides as usize);
    let [source, target] =
        [source, target].map(|column| guides.iter().map(|&i| column[i]).collect::<Vec<_>>());
    let mut fields = empty_fields(segment, &source, &target, progress)?;
    let obstacles = fields.obstacles().cloned();
    let mut stepper = StepFitter::new(segment, obstacles.clone())?;
    let fade = (settings.fade, fields.reference_speed());
    let mut photons = GuidedPhotons::new(&source, &target, fade, obstacles.as_deref());
    photons.find_paths(progress)?;
    let mut observer = Observer::new(&source, &target, extent);
    let mut fits = FitStatistics::default();
    let mut positions = source.clone();
    let mut guidance = vec![Vec2::ZERO; source.len()];
    photons.guidance(0.0, &mut guidance);
    let steps = fields.steps();
    progress.begin("fit", steps as u64);
    for n in 0..steps {
        if let Some(show) = &mut show_step {
            show(n, &positions);
        }
        if let Some((field, report)) = stepper.fit(n, &fields, &positions, &guidance, progress)? {
            fits.fitted((&field, &fields.noise(fields.time(n))), &report, &positions, &guidance);
            fields.push(field);
        }
        let step = fields.step(n);
        photons.advance(&step, progress)?;
        if fields.is_fitted_at(n) || Observer::awaits(step.start, step.length) {
            observer.stepped(&photons, step.start, step.length);
            observer.steered(&photons.steering(&step, &settings.fade));
        }
        if let Some(Snapshots { times, show }) = &mut snapshots {
            for (i, &time) in times.iter().enumerate().filter(|(_, time)| fields.step_of(**time) == n) {
                photons.positions(time, &mut positions);
                show(i, &positions);
            }
        }
        let end = fields.time(n + 1);
        photons.positions(end, &mut positions);
        photons.guidance(end, &mut guidance);
        progress.advance(1);
    }
    if let Some(show) = &mut show_step {
        show(steps, &positions);
    }
    let report = observer.finish(&positions, fields.turbulence(), photons.wall_violations(), fits.report());
    Ok((fields, report))
}

/// Fields with the walls and the turbulence of a segment, before the first fit.
fn empty_fields(segment: &Segment, source: &[Vec2], target: &[Vec2], progress: &Progress) -> Result<Fields> {
    let Segment { extent, settings, number, walls, .. } = *segment;
    let turbulence = settings.turbulence.as_ref().and_then(|noise| Turbulence::new(noise, extent, number));
    let (obstacles, steps) = Obstacles::new(walls, (settings.steps as usize, 1), extent, &progress.inner())?;
    let mean_length = match &obstacles {
        None => guidance::mean_straight(source, target),
        Some(obstacles) => obstacles.mean_path_length(source, target, progress)?,
    };
    Ok(Fields::new(steps, settings.fade, mean_length, turbulence, obstacles.map(Arc::new)))
}

/// The fits of the steps of a segment, with its lines and walls.
struct StepFitter<'a> {
    fitter: Fitter,
    grid: Grid,
    lines: DirectedLines<'a>,
    obstacles: Option<Arc<Obstacles>>,
}

impl<'a> StepFitter<'a> {
    fn new(segment: &Segment<'a>, obstacles: Option<Arc<Obstacles>>) -> Result<Self> {
        let fit_settings = fit_settings(segment.settings, segment.extent);
        let grid = fit_settings.grid;
        let lines = DirectedLines::new(segment.lines, segment.settings.beta, grid);
        Ok(Self { fitter: Fitter::new(fit_settings)?, grid, lines, obstacles })
    }

    /// The field of step `n`; none where the step has no field of its own.
    fn fit(
        &mut self,
        n: usize,
        fields: &Fields,
        positions: &[Vec2],
        guidance: &[Vec2],
        progress: &Progress,
    ) -> Result<Option<(Field, FitReport)>> {
        if let Some(obstacles) = self.obstacles.as_ref().filter(|obstacles| obstacles.changes(n)) {
            let (positions, normals, weight) = obstacles.no_penetration(n, self.grid);
            let rows = NoPenetrationRows { positions: &positions, normals: &normals, weight };
            self.fitter.set_no_penetration((!positions.is_empty()).then_some(rows));
        }
        let t = fields.time(n);
        if t >= fields.fade().end() || !fields.is_fitted_at(n) {
            return Ok(None);
        }
        if !self.lines.act_at(t) {
            return self.fitter.fit(positions, guidance, progress).map(Some);
        }
        let (rows, mask) = self.lines.rows(t, positions, guidance);
        let lines = LineTerm { rows: &rows, mask };
        self.fitter.fit_with(positions, guidance, Some(lines), progress).map(Some)
    }
}

pub(super) fn fit_settings(settings: &FlowSettings, extent: Vec2) -> FitSettings {
    FitSettings {
        grid: Grid { cells: settings.grid.cells(extent).map(|n| n as usize), extent },
        gamma: settings.gamma.into(),
        alpha: settings.alpha.into(),
        blend: match settings.fit {
            FitKind::Joint => Blend::Joint,
            FitKind::Separate => Blend::Separate,
        },
        tolerance: settings.tolerance.into(),
        max_iterations: MAX_ITERATIONS,
    }
}
