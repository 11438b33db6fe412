//! What exactness of the flow costs: the error of the tracks against a fine reference, over the seconds of the fit.
//!
//! Each knob (`knob`) is turned alone through its range, which tells what error it causes; then some settings in which all
//! knobs cause about the same. Errors are distances between tracks of the same photons (`probes`).

mod drawn;
mod knob;
mod listed;
mod probes;
mod words;

use glam::Vec2;

use super::{Section, nothing_moves};
use crate::chapter::Chapter;
use crate::pareto::Offer;
use crate::workbench::{Workbench, fastest};
use knob::{Finer, Knob, Setting};
use lightloom_core::engine::MovingSegment;
use lightloom_core::flow::{FlowSettings, fit_segment};
use lightloom_core::project::Project;
use lightloom_core::{Progress, Result};
use probes::{Apart, Probes};

/// Errors for which all knobs are balanced.
const AIMS: [f64; 6] = [3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4];
/// Of four independent errors of this share of the whole, the root of the sum of squares is the whole.
const SHARE: f64 = 0.5;
/// A knob that causes less than this share of the project's error is finer than it needs to be.
const LEAN: f64 = 0.25;

pub(crate) const SECTION: Section = Section { name: "flow", needless, measure, seconds: [13.0, 180.0] };

fn needless(project: &Project) -> Option<&'static str> {
    let other = (!project.fits()).then_some("the method fits no fields, so its tracks are exact");
    nothing_moves(project).or(other)
}

/// One setting, measured.
struct Run {
    setting: Setting,
    why: Why,
    /// Seconds of the fit.
    seconds: f64,
    tracks: Vec<Vec2>,
    /// From the reference.
    error: Apart,
}

/// Why a setting is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Why {
    /// It is the project's.
    Own,
    /// The project's with one knob turned.
    Alone(Knob),
    /// All knobs cause about the same error.
    Balanced,
}

/// All that was measured.
struct Measured {
    project: Project,
    runs: Vec<Run>,
    /// Of each knob, from coarse to fine: the run, and how far it is from that with the knob at its finest.
    alone: Vec<(Knob, Vec<(usize, Apart)>)>,
    reference: Setting,
    reference_seconds: f64,
    /// How far a reference of half the steps and cells is from it.
    doubt: Apart,
    probes: usize,
    walls: bool,
}

fn measure(bench: &mut Workbench, progress: &Progress) -> Result<Chapter> {
    let photons = bench.first_move(progress)?;
    let (project, again) = (bench.project.clone(), bench.pick(0.2, 1.0));
    let finer = finer(bench, !photons.walls.is_empty());
    let probes = Probes::new(&photons);
    let trial = Trial { photons: &photons, flow: &project.flow, probes, finer, again, progress };
    Ok(trial.measure(&project)?.chapter())
}

/// What a reference may cost: around walls photons cost most, and a fit about three times as much.
fn finer(bench: &Workbench, walls: bool) -> Finer {
    let free = Finer { steps: 3, cells: 3, guides: 4, most_guides: usize::MAX };
    match walls {
        false => bench.pick(free, Finer { steps: 4, cells: 4, ..free }),
        true => bench.pick(
            Finer { steps: 2, cells: 2, guides: 1, most_guides: 10_000 },
            Finer { steps: 2, guides: 2, ..free },
        ),
    }
}

/// Photons on which settings are tried.
struct Trial<'a> {
    photons: &'a MovingSegment,
    flow: &'a FlowSettings,
    probes: Probes,
    finer: Finer,
    /// What took fewer seconds is timed twice.
    again: f64,
    progress: &'a Progress,
}

impl Trial<'_> {
    fn measure(&self, project: &Project) -> Result<Measured> {
        let photons = self.photons.source.len();
        let own = Setting::of(self.flow, self.photons.extent, photons.min(self.finer.most_guides));
        let reference = own.reference(self.finer, photons);
        let sweeps = Knob::ALL.map(|knob| (knob, knob.sweep(own, &reference)));
        let settings = sweeps.iter().flat_map(|(_, sweep)| sweep).chain([&reference]);
        self.progress.begin("flow", settings.map(Setting::work).sum());
        let (exact, reference_seconds) = self.fit(reference)?;
        let doubt = Apart::between(&self.fit(reference.half())?.0, &exact);
        let mut runs = vec![self.run(own, Why::Own, &exact)?];
        let mut alone = Vec::new();
        for (knob, sweep) in sweeps {
            let mut rows = Vec::new();
            for setting in sweep {
                rows.push(self.row(setting, Why::Alone(knob), &mut runs, &exact)?);
            }
            alone.push((knob, since_finest(&rows, &runs)));
        }
        for setting in balanced(own, &alone, &runs).into_iter().chain([lean(own, &alone, &runs)]) {
            self.row(setting, Why::Balanced, &mut runs, &exact)?;
        }
        let (probes, walls) = (self.probes.count(), !self.photons.walls.is_empty());
        let project = project.clone();
        Ok(Measured { project, runs, alone, reference, reference_seconds, doubt, probes, walls })
    }

    /// The row of a setting in `runs`; measures it if it is not there.
    fn row(&self, setting: Setting, why: Why, runs: &mut Vec<Run>, exact: &[Vec2]) -> Result<usize> {
        if let Some(known) = runs.iter().position(|run| run.setting == setting) {
            return Ok(known);
        }
        runs.push(self.run(setting, why, exact)?);
        Ok(runs.len() - 1)
    }

    fn run(&self, setting: Setting, why: Why, exact: &[Vec2]) -> Result<Run> {
        let (tracks, seconds) = self.fit(setting)?;
        let error = Apart::between(&tracks, exact);
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

/// How far each of these runs is from the last.
fn since_finest(rows: &[usize], runs: &[Run]) -> Vec<(usize, Apart)> {
    let Some(&finest) = rows.last() else { return Vec::new() };
    let apart = |row: usize| Apart::between(&runs[row].tracks, &runs[finest].tracks);
    rows.iter().map(|&row| (row, apart(row))).collect()
}

/// For each aim, every knob at the coarsest that alone causes no more than its share of it. Aims that need more than one
/// knob at its finest are beyond what is measured.
fn balanced(own: Setting, alone: &[(Knob, Vec<(usize, Apart)>)], runs: &[Run]) -> Vec<Setting> {
    let turned = |aim: f64| {
        let (mut setting, mut finest) = (own, 0);
        for (knob, rows) in alone {
            let enough = rows.iter().position(|(_, apart)| apart.rms <= SHARE * aim)?;
            // Row 0 is the project's own.
            finest += usize::from(enough + 1 == rows.len() && rows[enough].0 > 0);
            setting = setting.with(*knob, &runs[rows[enough].0].setting);
        }
        (finest <= 1).then_some(setting)
    };
    let mut settings: Vec<Setting> = AIMS.into_iter().filter_map(turned).collect();
    settings.dedup();
    settings
}

/// The project's setting, with each knob coarser as long as it causes no more than before, or too little to be seen.
fn lean(own: Setting, alone: &[(Knob, Vec<(usize, Apart)>)], runs: &[Run]) -> Setting {
    alone.iter().fold(own, |setting, (knob, rows)| {
        let before = rows.iter().find(|(row, _)| *row == 0).map_or(0.0, |(_, apart)| apart.rms);
        let limit = before.max(LEAN * runs[0].error.rms);
        let enough = rows.iter().find(|(_, apart)| apart.rms <= limit);
        enough.map_or(setting, |(row, _)| setting.with(*knob, &runs[*row].setting))
    })
}

impl Measured {
    fn own(&self) -> &Run {
        // It is measured first.
        &self.runs[0]
    }

    fn offers(&self) -> Vec<Offer> {
        self.runs.iter().map(|run| Offer { price: run.seconds, error: run.error.rms }).collect()
    }
}
