//! Photons integrated in their guidance v, see [`guidance`](super::guidance), step by step. The cubic of each over the
//! current step gives positions and velocities at any time within it.

use glam::Vec2;
use rayon::prelude::*;

use super::fade::{Fade, ease};
use super::guidance::position;
use super::observer::{Kinematics, Steering};
use super::step::{CHUNK, Step};
use super::walls::{Columns, Obstacles, WallColumns, WallViolations};
use crate::{Error, Progress, Result};

/// Photons that are stepped together: their evaluations overlap in the processor's pipeline.
const BATCH: usize = 16;

/// The photons of one pass on the way through a segment, in columns.
pub(super) struct GuidedPhotons<'a> {
    targets: &'a [Vec2],
    /// One over the speed at which each leaves the field.
    inverse_speed_limits: Vec<f32>,
    /// Guidance at the begin of the step.
    guidance: Vec<Vec2>,
    /// Its cubic over the step: v(x) = guidance + x (k0 + x (k1 + x k2)), x in 0..=1.
    curve: Vec<[Vec2; 3]>,
    start: f64,
    length: f64,
    /// Further columns where walls stand.
    walls: Option<WallColumns<'a>>,
}

impl<'a> GuidedPhotons<'a> {
    /// Photons at `source` bound for `targets`, row by row, that leave the field by `fade`. Speed limits are relative to
    /// `reference_speed`.
    pub(super) fn new(
        source: &[Vec2],
        targets: &'a [Vec2],
        (fade, reference_speed): (Fade, f32),
        obstacles: Option<&'a Obstacles>,
    ) -> Self {
        let walls = obstacles.map(|obstacles| WallColumns::new(obstacles, source, (fade, reference_speed)));
        Self { walls, ..Self::free(source, targets, &fade, reference_speed) }
    }

    /// Finds the paths around walls unless they are known. Required before guidance at the start is read.
    ///
    /// # Errors
    /// `Cancelled`.
    pub(super) fn find_paths(&mut self, progress: &Progress) -> Result<()> {
        match &mut self.walls {
            Some(walls) => walls.find_paths(self.targets, &mut self.inverse_speed_limits, progress),
            None => Ok(()),
        }
    }

    /// Photons without walls.
    fn free(source: &[Vec2], targets: &'a [Vec2], fade: &Fade, reference_speed: f32) -> Self {
        let pairs = source.par_iter().zip(targets);
        let inverse_speed_limits = pairs
            .clone()
            .map(|(&a, &b)| 1.0 / fade.speed_limit(a.distance(b), reference_speed).max(f32::MIN_POSITIVE));
        Self {
            targets,
            inverse_speed_limits: inverse_speed_limits.collect(),
            guidance: pairs.map(|(&a, &b)| b - a).collect(),
            curve: vec![[Vec2::ZERO; 3]; source.len()],
            start: 0.0,
            length: 0.0,
            walls: None,
        }
    }

    /// Unreachable targets and wall crossings so far.
    pub(super) fn wall_violations(&self) -> WallViolations {
        self.walls.as_ref().map_or(WallViolations::default(), WallColumns::violations)
    }

    /// Advances all photons through the next step.
    ///
    /// # Errors
    /// `Numeric` with the count when photons are no longer finite, `Cancelled`.
    pub(super) fn advance(&mut self, step: &Step, progress: &Progress) -> Result<()> {
        (self.start, self.length) = (step.start, step.length);
        self.find_paths(progress)?;
        let lost = match &mut self.walls {
            None => self.advance_free(step, progress)?,
            Some(walls) => {
                let columns = Columns {
                    guidance: &mut self.guidance,
                    curve: &mut self.curve,
                    targets: self.targets,
                    inverse_speed_limits: &self.inverse_speed_limits,
                };
                walls.advance(step, columns, progress)?
            }
        };
        if lost == 0 {
            return Ok(());
        }
        let what = format!(
            "{lost} of {} photons are no longer finite at t = {:.4}; take more steps or a larger alpha",
            self.targets.len(),
            step.start + step.length
        );
        Err(Error::Numeric { stage: "advect", what })
    }

    /// [`Self::advance`] without walls; returns the number of photons that are no longer finite.
    fn advance_free(&mut self, step: &Step, progress: &Progress) -> Result<usize> {
        let columns = (
            self.guidance.par_chunks_mut(CHUNK),
            self.curve.par_chunks_mut(CHUNK),
            self.targets.par_chunks(CHUNK),
            self.inverse_speed_limits.par_chunks(CHUNK),
        );
        columns
            .into_par_iter()
            .map(|(guidance, curve, targets, inverse_speed_limits)| {
                progress.check()?;
                for (v, [k0, k1, k2]) in guidance.iter_mut().zip(&*curve) {
                    *v += *k0 + *k1 + *k2;
                }
                let (groups, rest) = curve.as_chunks_mut::<BATCH>();
                let of_group = guidance
                    .as_chunks()
                    .0
                    .iter()
                    .zip(targets.as_chunks().0)
                    .zip(inverse_speed_limits.as_chunks().0);
                for (curves, ((&v, &targets), &inverse_speed_limits)) in groups.iter_mut().zip(of_group) {
                    *curves = step.curves(targets, v, inverse_speed_limits);
                }
                let first = guidance.len() - rest.len();
                for (i, curve) in rest.iter_mut().enumerate().map(|(i, curve)| (first + i, curve)) {
                    *curve = step.curve(targets[i], guidance[i], inverse_speed_limits[i]);
                }
                let finite = |curve: &&[Vec2; 3]| curve.iter().all(|k| k.is_finite());
                Ok(curve.iter().filter(|curve| !finite(curve)).count())
            })
            .try_reduce(|| 0, |a, b| Ok(a + b))
    }

    /// Guidance v of Eq. (2) at `t`, which lies in the current step; where walls stand, at its end.
    pub(super) fn guidance(&self, t: f64, out: &mut [Vec2]) {
        if let Some(walls) = &self.walls {
            return walls.guidance(self.targets, (1.0 - t) as f32, out);
        }
        let x = self.fraction_of_step(t);
        self.each(out, |_, _, v0, [k0, k1, k2]| v0 + x * (k0 + x * (k1 + x * k2)));
    }

    /// Velocities, guidance and field weights at the begin of the current step.
    pub(super) fn steering(&self, step: &Step, fade: &Fade) -> Steering {
        let t = step.start;
        let zero = || vec![Vec2::ZERO; self.targets.len()];
        let (mut velocities, mut guidance) = (zero(), zero());
        self.velocities(t, &mut velocities);
        self.guidance(t, &mut guidance);
        let share = fade.share(t) as f32;
        let mut at = zero();
        self.positions(t, &mut at);
        let fitted =
            |p: Vec2| step.velocities.as_ref().map_or(Vec2::ZERO, |[begin, ..]| begin.field.velocity(p));
        let limits = guidance.par_iter().zip(&at).zip(&self.inverse_speed_limits);
        let field_shares =
            limits.map(|((v, &p), limit)| share * ease(v.length().max(fitted(p).length()) * limit)).collect();
        Steering { velocities, guidance, field_shares }
    }

    fn fraction_of_step(&self, t: f64) -> f32 {
        if self.length > 0.0 { ((t - self.start) / self.length) as f32 } else { 0.0 }
    }

    /// Writes `value(row, target, guidance, curve)` for each photon.
    fn each(&self, out: &mut [Vec2], value: impl Fn(usize, Vec2, Vec2, [Vec2; 3]) -> Vec2 + Sync) {
        let columns = (
            out.par_chunks_mut(CHUNK),
            self.targets.par_chunks(CHUNK),
            self.guidance.par_chunks(CHUNK),
            self.curve.par_chunks(CHUNK),
        );
        columns.into_par_iter().enumerate().for_each(|(chunk, (out, targets, guidance, curve))| {
            for i in 0..out.len() {
                out[i] = value(chunk * CHUNK + i, targets[i], guidance[i], curve[i]);
            }
        });
    }
}

impl Kinematics for GuidedPhotons<'_> {
    fn positions(&self, t: f64, out: &mut [Vec2]) {
        let x = self.fraction_of_step(t);
        let at_wall = |i| self.walls.as_ref().and_then(|walls| walls.position(i, x));
        self.each(out, |i, target, v0, [k0, k1, k2]| {
            at_wall(i).unwrap_or_else(|| position(target, v0 + x * (k0 + x * (k1 + x * k2)), t as f32))
        });
    }

    /// c' = v - (1-t) v'.
    fn velocities(&self, t: f64, out: &mut [Vec2]) {
        let x = self.fraction_of_step(t);
        let slope = if self.length > 0.0 { ((1.0 - t) / self.length) as f32 } else { 0.0 };
        let per_length = if self.length > 0.0 { (1.0 / self.length) as f32 } else { 0.0 };
        let displacement = |i| self.walls.as_ref().and_then(|walls| walls.displacement(i));
        self.each(out, |i, _, v0, [k0, k1, k2]| {
            let v = v0 + x * (k0 + x * (k1 + x * k2));
            let curved = v - slope * (k0 + x * (2.0 * k1 + x * (3.0 * k2)));
            displacement(i).map_or(curved, |moved: Vec2| moved * per_length)
        });
    }
}
