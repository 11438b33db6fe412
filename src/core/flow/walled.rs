//! Photons on their way where walls stand: beside what every swarm knows of them, where they are and which way they go.

use glam::Vec2;
use rayon::prelude::*;

use super::advect::{CHUNK, Step};
use super::fade::Fade;
use super::obstacles::{Obstacles, Route, State};
use super::trajectory::Astray;
use super::walker::{Motion, Photon, Walker};
use crate::constraint::Detour;
use crate::constraint::detour::Sight;
use crate::{Progress, Result};

/// What walls add to a swarm, column by column.
pub(super) struct Walled<'a> {
    obstacles: &'a Obstacles,
    /// Where each photon began the current step.
    from: Vec<Vec2>,
    /// Where it ends it; before the first step, where it stands.
    at: Vec<Vec2>,
    routes: Vec<Route>,
    /// How they leave the field, and the mean way that its limit is told in.
    fade: (Fade, f32),
    /// Whether the ways are known.
    ready: bool,
    step: usize,
    /// Photons that crossed a wall though they were not shut off, over all steps.
    crossings: usize,
}

/// The columns of a swarm that the photons of a step are written to.
pub(super) struct Columns<'a> {
    pub(super) guidance: &'a mut [Vec2],
    pub(super) curve: &'a mut [[Vec2; 3]],
    pub(super) targets: &'a [Vec2],
    pub(super) per_limit: &'a [f32],
}

/// What a step did to the photons.
#[derive(Clone, Copy, Default)]
struct Toll {
    lost: usize,
    crossings: usize,
}

impl<'a> Walled<'a> {
    /// Photons at `source`.
    pub(super) fn new(obstacles: &'a Obstacles, source: &[Vec2], fade: (Fade, f32)) -> Self {
        let routes = vec![Route::NEW; source.len()];
        let (from, at) = (source.to_vec(), source.to_vec());
        Self { obstacles, from, at, routes, fade, ready: false, step: 0, crossings: 0 }
    }

    /// Finds the ways to `targets`, and one over the speed at which each photon leaves the field; once.
    pub(super) fn set_out(
        &mut self,
        targets: &[Vec2],
        per_limit: &mut Vec<f32>,
        progress: &Progress,
    ) -> Result<()> {
        if std::mem::replace(&mut self.ready, true) {
            return Ok(());
        }
        self.obstacles.set_out(0, &self.at, targets, &mut self.routes, progress)?;
        let (fade, mean) = self.fade;
        let limit = |length| 1.0 / fade.speed_limit(length, mean).max(f32::MIN_POSITIVE);
        *per_limit = self.obstacles.lengths(&self.routes, &self.at, targets).into_iter().map(limit).collect();
        Ok(())
    }

    /// Photons that are shut off from their target, and those that crossed a wall all the same, so far.
    pub(super) fn astray(&self) -> Astray {
        let passes = |route: &&Route| route.state == State::Passes;
        Astray { unreachable: self.routes.iter().filter(passes).count(), crossings: self.crossings }
    }

    /// Moves all photons through `step`; returns how many are no longer finite.
    pub(super) fn advance(&mut self, step: &Step, columns: Columns, progress: &Progress) -> Result<usize> {
        if step.number > 0 && self.obstacles.changes(step.number) {
            self.obstacles.set_out(step.number, &self.at, columns.targets, &mut self.routes, progress)?;
        }
        self.step = step.number;
        let detour = self.obstacles.detour(step.number);
        let columns = (
            columns.guidance.par_chunks_mut(CHUNK),
            columns.curve.par_chunks_mut(CHUNK),
            columns.targets.par_chunks(CHUNK),
            columns.per_limit.par_chunks(CHUNK),
            self.from.par_chunks_mut(CHUNK),
            self.at.par_chunks_mut(CHUNK),
            self.routes.par_chunks_mut(CHUNK),
        );
        let toll = columns
            .into_par_iter()
            .map(|(guidance, curve, targets, per_limit, from, at, routes)| {
                progress.check()?;
                let (mut toll, mut sight) = (Toll::default(), Sight::default());
                for i in 0..at.len() {
                    let photon = Photon { at: at[i], target: targets[i], per_limit: per_limit[i] };
                    from[i] = at[i];
                    let v = photon.guidance(step);
                    (guidance[i], curve[i], at[i]) =
                        match through(step, detour, &photon, &mut routes[i], &mut sight) {
                            Motion::Curve(curve) => (v, curve, photon.end_of(step, &curve)),
                            Motion::Line(to) => (v, [Vec2::ZERO; 3], to),
                        };
                    toll.lost += usize::from(!at[i].is_finite());
                    let through = detour.is_some_and(|detour| detour.barriers().blocks(from[i], at[i]));
                    toll.crossings += usize::from(through && routes[i].state != State::Passes);
                }
                Ok(toll)
            })
            .try_reduce(Toll::default, |a, b| {
                Ok(Toll { lost: a.lost + b.lost, crossings: a.crossings + b.crossings })
            })?;
        self.crossings += toll.crossings;
        Ok(toll.lost)
    }

    /// The place of photon `i` at the share `x` of the step, where it is not on its cubic.
    #[inline]
    pub(super) fn place(&self, i: usize, x: f32) -> Option<Vec2> {
        if x <= 0.0 {
            Some(self.from[i])
        } else if x >= 1.0 {
            Some(self.at[i])
        } else {
            self.routes[i].line.then(|| self.from[i].lerp(self.at[i], x))
        }
    }

    /// What photon `i` moves by over the step, where it moves along a line.
    #[inline]
    pub(super) fn line(&self, i: usize) -> Option<Vec2> {
        self.routes[i].line.then(|| self.at[i] - self.from[i])
    }

    /// Guidance at the end of the step, `time_left` before t = 1: along the way, fast enough to be there in time.
    pub(super) fn guidance(&self, targets: &[Vec2], time_left: f32, out: &mut [Vec2]) {
        let detour = self.obstacles.detour(self.step);
        let columns = (out.par_iter_mut(), self.routes.par_iter(), self.at.par_iter(), targets.par_iter());
        columns.into_par_iter().for_each(|(out, route, &c, &b)| {
            *out = route.guidance(detour, c, b, time_left);
        });
    }
}

fn through(
    step: &Step,
    detour: Option<&Detour>,
    photon: &Photon,
    route: &mut Route,
    sight: &mut Sight,
) -> Motion {
    match detour {
        Some(detour) => Walker { step, detour }.step(photon, route, sight),
        None => {
            route.line = false;
            Motion::Curve(photon.curve(step))
        }
    }
}
