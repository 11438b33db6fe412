//! The runs: each parameter varied alone over its range, which gives the error that it causes; then settings in which all
//! parameters cause about the same error.

use glam::Vec2;

use super::probes::{Probes, TrackError};
use super::setting::{Parameter, Refinement, Setting};
use crate::clock::fastest;
use crate::pareto::Candidate;
use crate::slope::slope;
use lightloom_core::engine::MovingSegment;
use lightloom_core::flow::{FlowSettings, fit_segment};
use lightloom_core::project::Project;
use lightloom_core::{Progress, Result};

/// Target errors of the balanced settings.
const AIMS: [f64; 6] = [3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4];
/// Share of the target error for each of four parameters: independent errors add as squares.
const SHARE: f64 = 0.5;
/// A parameter that causes less than this share of the project's error is finer than necessary.
const LEAN: f64 = 0.25;

/// Ratio of two errors that look the same.
pub(super) const SAME: f64 = 1.05;

/// A setting and its measured error and cost.
pub(super) struct Run {
    pub(super) setting: Setting,
    pub(super) why: Variation,
    /// Seconds of the fit.
    pub(super) seconds: f64,
    pub(super) tracks: Vec<Vec2>,
    /// Distance from the reference.
    pub(super) error: TrackError,
}

/// The reason why a setting is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Variation {
    /// It is the project's own.
    Own,
    /// One parameter differs from the project's own.
    Alone(Parameter),
    /// All parameters cause about the same error.
    Balanced,
}

/// The measurements of the section.
pub(super) struct Measured {
    pub(super) project: Project,
    pub(super) runs: Vec<Run>,
    /// By parameter, from coarse to fine: the run, and its distance from the run with the parameter at its finest.
    pub(super) alone: Vec<(Parameter, Vec<(usize, TrackError)>)>,
    pub(super) reference: Setting,
    pub(super) reference_seconds: f64,
    /// Its distance from a reference of half the steps and cells.
    pub(super) uncertainty: TrackError,
    pub(super) probes: usize,
    pub(super) walls: bool,
}

/// The photons and the reference for which settings are compared.
pub(super) struct Trial<'a> {
    pub(super) photons: &'a MovingSegment,
    pub(super) flow: &'a FlowSettings,
    pub(super) probes: Probes,
    pub(super) finer: Refinement,
    /// Runs that take fewer seconds are timed twice.
    pub(super) again: f64,
    pub(super) progress: &'a Progress,
}

impl Trial<'_> {
    pub(super) fn measure(&self, project: &Project) -> Result<Measured> {
        let photons = self.photons.source.len();
        let own = Setting::of(self.flow, self.photons.extent, photons.min(self.finer.most_guides));
        let reference = own.reference(self.finer, photons);
        let sweeps = Parameter::ALL.map(|parameter| (parameter, parameter.sweep(own, &reference)));
        let settings = sweeps.iter().flat_map(|(_, sweep)| sweep).chain([&reference]);
        self.progress.begin("flow", settings.map(Setting::work).sum());
        let (exact, reference_seconds) = self.fit(reference)?;
        let uncertainty = TrackError::between(&self.fit(reference.half())?.0, &exact);
        let mut runs = vec![self.run(own, Variation::Own, &exact)?];
        let mut alone = Vec::new();
        for (parameter, sweep) in sweeps {
            let mut rows = Vec::new();
            for setting in sweep {
                rows.push(self.row(setting, Variation::Alone(parameter), &mut runs, &exact)?);
            }
            alone.push((parameter, since_finest(&rows, &runs)));
        }
        for setting in balanced(own, &alone, &runs).into_iter().chain([lean(own, &alone, &runs)]) {
            self.row(setting, Variation::Balanced, &mut runs, &exact)?;
        }
        let (probes, walls) = (self.probes.count(), !self.photons.walls.is_empty());
        let project = project.clone();
        Ok(Measured { project, runs, alone, reference, reference_seconds, uncertainty, probes, walls })
    }

    /// The index of a setting in `runs`, where it is appended if it is new.
    fn row(&self, setting: Setting, why: Variation, runs: &mut Vec<Run>, exact: &[Vec2]) -> Result<usize> {
        if let Some(known) = runs.iter().position(|run| run.setting == setting) {
            return Ok(known);
        }
        runs.push(self.run(setting, why, exact)?);
        Ok(runs.len() - 1)
    }

    fn run(&self, setting: Setting, why: Variation, exact: &[Vec2]) -> Result<Run> {
        let (tracks, seconds) = self.fit(setting)?;
        let error = TrackError::between(&tracks, exact);
        Ok(Run { setting, why, seconds, tracks, error })
    }

    /// Tracks of the probes, and the seconds of the fit.
    fn fit(&self, setting: Setting) -> Result<(Vec<Vec2>, f64)> {
        let (flow, progress) = (setting.apply(self.flow), self.progress.inner());
        let fit = || fit_segment(&self.photons.segment(&flow), &progress);
        let ((fields, _), seconds) = fastest(2, self.again, fit)?;
        let tracks = self.probes.tracks(&fields, &progress)?;
        self.progress.advance(setting.work());
        Ok((tracks, seconds))
    }
}

/// The distance of each of these runs from the last.
fn since_finest(rows: &[usize], runs: &[Run]) -> Vec<(usize, TrackError)> {
    let Some(&finest) = rows.last() else { return Vec::new() };
    let error = |row: usize| TrackError::between(&runs[row].tracks, &runs[finest].tracks);
    rows.iter().map(|&row| (row, error(row))).collect()
}

/// For each target error, every parameter at the coarsest value whose error is no more than its share. Targets that need
/// more than one parameter at its finest are out of range.
fn balanced(own: Setting, alone: &[(Parameter, Vec<(usize, TrackError)>)], runs: &[Run]) -> Vec<Setting> {
    let turned = |aim: f64| {
        let (mut setting, mut finest) = (own, 0);
        for (parameter, rows) in alone {
            let enough = rows.iter().position(|(_, error)| error.rms <= SHARE * aim)?;
            // Row 0 is the project's own.
            finest += usize::from(enough + 1 == rows.len() && rows[enough].0 > 0);
            setting = setting.with(*parameter, &runs[rows[enough].0].setting);
        }
        (finest <= 1).then_some(setting)
    };
    let mut settings: Vec<Setting> = AIMS.into_iter().filter_map(turned).collect();
    settings.dedup();
    settings
}

/// The project's setting with each parameter as coarse as possible without a visible change of the error.
fn lean(own: Setting, alone: &[(Parameter, Vec<(usize, TrackError)>)], runs: &[Run]) -> Setting {
    alone.iter().fold(own, |setting, (parameter, rows)| {
        let before = rows.iter().find(|(row, _)| *row == 0).map_or(0.0, |(_, error)| error.rms);
        let limit = before.max(LEAN * runs[0].error.rms);
        let enough = rows.iter().find(|(_, error)| error.rms <= limit);
        enough.map_or(setting, |(row, _)| setting.with(*parameter, &runs[*row].setting))
    })
}

impl Measured {
    pub(super) fn own(&self) -> &Run {
        // It is measured first.
        &self.runs[0]
    }

    pub(super) fn candidates(&self) -> Vec<Candidate> {
        self.runs.iter().map(|run| Candidate { price: run.seconds, error: run.error.rms }).collect()
    }

    /// Estimated error of the reference. If errors fall like h^p, that of h is 1/(2^p - 1) of its distance from the
    /// result of 2 h; p is the least of the orders found, clamped to 1..=2.
    pub(super) fn reference_error(&self) -> f64 {
        let orders = [Parameter::Steps, Parameter::Grid]
            .map(|parameter| self.order(parameter).unwrap_or(1.0).clamp(1.0, 2.0));
        self.uncertainty.rms / (2_f64.powf(orders[0].min(orders[1])) - 1.0)
    }

    /// Order of convergence of a parameter, between the two finest values that are at most half of the finest value of all,
    /// from which the error is measured.
    pub(super) fn order(&self, parameter: Parameter) -> Option<f64> {
        let (_, rows) = self.alone.iter().find(|(other, _)| *other == parameter)?;
        let point = |&(row, error): &(usize, TrackError)| (parameter.of(&self.runs[row].setting), error.rms);
        let points: Vec<(f64, f64)> = rows.iter().map(point).collect();
        let (finest, _) = *points.last()?;
        let coarse = points.iter().filter(|(value, _)| 2.0 * value <= finest).count();
        slope(&points[coarse.checked_sub(2)?..coarse]).map(|slope| -slope)
    }
}
