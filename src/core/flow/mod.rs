//! The vector field (Sec. 3): photons flow from one key frame to the next.
//!
//! At each time step the field is fitted to the directions in which the photons should go (`guidance`, `fit`), then
//! carries them on (`advect`); a `fade` lets them leave it so that each arrives exactly. The fields are kept
//! (`trajectory`), and carry the photons of all later passes. Methods to compare with need no field: [`Movement`] names
//! them, `path` holds their ways, and [`Mover`] is either.
//!
//! # The fade, measured
//!
//! 40 000 photons, 64 x 64 cells, 30 steps, transport matching, joint fit; the paper's fade (tau 0.85) / the default. peak: 99.9 % fastest
//! photon over the mean straight speed; dispersion: neighbour-velocity variance over mean square, largest of the run;
//! field: share of the motion that the field steers; wander: distance from the straight ways over their length.
//!
//! | gamma | peak | dispersion | field | wander |
//! |---|---|---|---|---|
//! | caustic to flower (straight lines: 1.7) | | | | |
//! | 0 | 16.7 / 2.7 | .095 / .015 | .86 / .58 | .21 / .14 |
//! | 0.25 | 12.3 / 2.5 | .301 / .021 | .92 / .60 | .09 / .06 |
//! | 0.5 | 12.2 / 2.5 | .337 / .021 | .92 / .60 | .08 / .05 |
//! | 1 | 12.0 / 2.4 | .334 / .021 | .92 / .61 | .07 / .05 |
//! | letter C to letter S in one place (straight lines: 3.3) | | | | |
//! | 0 | 56.3 / 4.6 | .130 / .054 | .79 / .45 | .39 / .18 |
//! | 0.25 | 27.0 / 4.4 | .264 / .062 | .88 / .53 | .18 / .12 |
//! | 0.5 | 29.6 / 4.2 | .366 / .066 | .90 / .56 | .15 / .10 |
//! | 1 | 32.9 / 4.2 | .356 / .068 | .89 / .57 | .15 / .09 |
//!
//! No fade can go below the straight lines: a photon has to be there in time. Tried and left: 1 - s = (1-t)^q for all
//! (less wander at a higher peak); no speed limit (letters at gamma 0: 6.1 even with the fade from 0.2 to 0.8); a limit
//! that acts below 1.2 times a photon's own straight speed (letters 3.5, but long ways leave the flow at once and tear).

pub mod assembly;
pub mod bending;
pub mod fade;
pub mod field;
pub mod fit;
pub mod flux;
pub mod guidance;
pub mod metric;
pub mod movement;
pub mod path;
pub mod settings;
pub mod turbulence;

mod advect;
mod lines;
mod local;
mod mover;
mod obstacles;
mod report;
mod stage;
mod trajectory;
mod walker;
mod walled;

use std::sync::Arc;

use glam::Vec2;

pub use fade::Fade;
pub use movement::Movement;
pub use mover::{Carriage, Mover};
pub use obstacles::Obstacles;
pub use path::{Paths, watch_paths};
pub use report::FlowReport;
pub use settings::{FitKind, FlowSettings, GridSize};
pub use trajectory::{Astray, Carrier, Fields, spatial_order};
pub use turbulence::{Turbulence, TurbulenceSettings};

use self::advect::Swarm;
use self::field::Grid;
use self::fit::{Blend, FitSettings, Fitter, Steering};
use self::lines::Lines;
use self::report::{Moving as _, Observer};
use crate::constraint::{ActiveLine, ActiveWall};
use crate::{Error, Progress, Result};

/// Conjugate gradients with multigrid need some ten iterations; a solve that needs this many has failed.
const MAX_ITERATIONS: usize = 500;

/// Is shown the step and the positions of the guide photons there.
pub type Tracks<'a> = &'a mut dyn FnMut(usize, &[Vec2]);

/// Shows the photons at some moments while the fields are fitted to them.
pub struct Moments<'a> {
    /// Times within 0..=1, rising.
    pub times: &'a [f64],
    /// Is shown the index of a time and the positions of the guide photons then: those to which a [`Carrier`] of the
    /// same photons would carry them.
    pub show: Tracks<'a>,
}

/// What lies between two key frames: where the photons come from, where they go, and how.
#[derive(Clone, Copy, Debug)]
pub struct Course<'a> {
    /// Positions of n photons at the begin, plane units.
    pub source: &'a [Vec2],
    /// Where the photon of the same row ends, n points.
    pub target: &'a [Vec2],
    /// Size of the plane; its longer side is 1.
    pub extent: Vec2,
    /// How they flow.
    pub settings: &'a FlowSettings,
    /// Directed lines, Term (6).
    pub lines: &'a [ActiveLine],
    /// Walls.
    pub walls: &'a [ActiveWall],
    /// Which segment of the animation this is, from 0: what changes in time by itself goes on from the segment before.
    pub number: usize,
}

impl<'a> Course<'a> {
    /// The first segment of an animation, with nothing drawn.
    pub fn new(source: &'a [Vec2], target: &'a [Vec2], extent: Vec2, settings: &'a FlowSettings) -> Self {
        Self { source, target, extent, settings, lines: &[], walls: &[], number: 0 }
    }
}

/// Fits the fields that carry photons along a course, row by row.
///
/// The fields are fitted to at most `settings.guides` photons, taken evenly from all: a field of 128 x 128 cells is determined
/// by some 100 000. `tracks` is shown the positions of these guides at the begin of each step and at the end.
///
/// # Errors
/// `Value` when there are no photons, the columns differ in length or hold a number that is not finite; `Numeric` when the
/// solver fails or a photon is lost; `Cancelled`.
pub fn fit_segment(
    course: &Course,
    progress: &Progress,
    tracks: Option<Tracks>,
) -> Result<(Fields, FlowReport)> {
    fit_moments(course, progress, tracks, None)
}

/// As [`fit_segment`], and shows the guides at any moments: where all photons are guides, a second way through the fields
/// is spared.
///
/// # Errors
/// As [`fit_segment`].
pub fn fit_moments(
    course: &Course,
    progress: &Progress,
    mut tracks: Option<Tracks>,
    mut moments: Option<Moments>,
) -> Result<(Fields, FlowReport)> {
    let Course { source, target, extent, settings, number, lines, walls } = *course;
    check_photons(source, target)?;
    let guides = guide_rows(source.len(), settings.guides as usize);
    let source: Vec<Vec2> = guides.iter().map(|&i| source[i]).collect();
    let target: Vec<Vec2> = guides.iter().map(|&i| target[i]).collect();
    let turbulence = settings.turbulence.as_ref().and_then(|noise| Turbulence::new(noise, extent, number));
    let (obstacles, steps) = Obstacles::new(walls, settings.steps as usize, extent, &progress.inner())?;
    let mean_way = match &obstacles {
        None => guidance::mean_straight(&source, &target),
        Some(obstacles) => obstacles.mean_way(&source, &target, progress)?,
    };
    let mut fields = Fields::new(steps, settings.fade, mean_way, turbulence, obstacles.map(Arc::new));
    let obstacles = fields.obstacles().cloned();
    let fit_settings = fit_settings(settings, extent);
    let grid = fit_settings.grid;
    let mut fitter = Fitter::new(fit_settings)?;
    let mut lines = Lines::new(lines, settings.beta, grid);
    let mut swarm = Swarm::new(&source, &target, (settings.fade, fields.pace()), obstacles.as_deref());
    swarm.set_out(progress)?;
    let mut observer = Observer::new(&source, &target, extent);
    let mut positions = source.clone();
    let mut directions = vec![Vec2::ZERO; source.len()];
    swarm.guidance(0.0, &mut directions);
    let steps = fields.steps();
    progress.begin("fit", steps as u64);
    for n in 0..steps {
        let t = fields.time(n);
        if let Some(show) = &mut tracks {
            show(n, &positions);
        }
        if let Some(obstacles) = obstacles.as_ref().filter(|obstacles| obstacles.changes(n)) {
            obstacles.wall_in(n, &mut fitter, grid);
        }
        if t < settings.fade.end() && fields.is_fitted_at(n) {
            let (field, fit) = if lines.pull(t) {
                let (rows, mask) = lines.rows(t, &positions, &directions);
                let steering = Steering { rows: &rows, mask };
                fitter.fit_with(&positions, &directions, Some(steering), progress)?
            } else {
                fitter.fit(&positions, &directions, progress)?
            };
            observer.fitted((&field, &fields.noise(t)), &fit, &positions, &directions);
            fields.push(field);
        }
        let step = fields.step(n);
        swarm.advance(&step, progress)?;
        if fields.is_fitted_at(n) || Observer::awaits(step.start, step.length) {
            observer.stepped(&swarm, step.start, step.length);
            observer.steered(&swarm, step.start, &settings.fade);
        }
        if let Some(Moments { times, show }) = &mut moments {
            for (i, &time) in times.iter().enumerate().filter(|(_, time)| fields.step_of(**time) == n) {
                swarm.positions(time, &mut positions);
                show(i, &positions);
            }
        }
        let end = fields.time(n + 1);
        swarm.positions(end, &mut positions);
        swarm.guidance(end, &mut directions);
        progress.advance(1);
    }
    if let Some(show) = &mut tracks {
        show(steps, &positions);
    }
    let report = observer.finish(&positions, fields.turbulence(), swarm.astray());
    Ok((fields, report))
}

/// `count` rows of `all` at even distances; all of them where there are no more.
fn guide_rows(all: usize, count: usize) -> Vec<usize> {
    let count = count.min(all);
    (0..count).map(|i| (i as u128 * all as u128 / count as u128) as usize).collect()
}

fn fit_settings(settings: &FlowSettings, extent: Vec2) -> FitSettings {
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

fn check_photons(source: &[Vec2], target: &[Vec2]) -> Result<()> {
    if source.is_empty() {
        return Err(Error::value(
            "flow",
            "there are no photons to move; check that light reaches the receiver",
        ));
    }
    if source.len() != target.len() {
        let what = format!("{} photons but {} targets; each photon needs one", source.len(), target.len());
        return Err(Error::value("flow", what));
    }
    match source.iter().zip(target).position(|(a, b)| !(a.is_finite() && b.is_finite())) {
        Some(row) => Err(Error::value("flow", format!("photon {row} has a position that is not finite"))),
        None => Ok(()),
    }
}
