//! Photons carried one step along the field: classical Runge-Kutta of order 4 in the guidance v (see
//! [`guidance`](super::guidance)), with a cubic in time kept of each, so that they can be asked for between the steps.

use std::array::from_fn;

use glam::Vec2;
use rayon::prelude::*;

use super::fade::{Fade, ease};
use super::guidance::position;
use super::obstacles::Obstacles;
use super::report::Moving;
use super::stage::Stage;
use super::trajectory::Astray;
use super::walled::{Columns, Walled};
use crate::{Error, Progress, Result};

/// Photons per parallel task: fits the L1 cache beside the coefficients around them.
pub(super) const CHUNK: usize = 2048;

/// Photons that take their step side by side, so that the processor need not wait for any one of them.
const ABREAST: usize = 16;

/// What moves the photons from `start` to `start + length`: the field and the fade at the three times that RK4 asks for.
/// Blended once per step, so that a photon pays for one field where it would for two.
pub(super) struct Step {
    /// Number of the step, from 0.
    pub number: usize,
    /// Steps that follow.
    pub left: usize,
    /// Time at the begin.
    pub start: f64,
    /// Duration.
    pub length: f64,
    /// The field and its rate at begin, middle and end; nothing once the fade has ended and all go straight.
    pub stages: Option<[Stage; 3]>,
}

/// Photons on their way, column by column.
pub(super) struct Swarm<'a> {
    targets: &'a [Vec2],
    /// One over the speed at which each leaves the field.
    per_limit: Vec<f32>,
    /// Guidance at the begin of the step.
    guidance: Vec<Vec2>,
    /// Its cubic over the step: v(x) = guidance + x (k0 + x (k1 + x k2)), x in 0..=1.
    curve: Vec<[Vec2; 3]>,
    start: f64,
    length: f64,
    /// Where walls stand.
    walled: Option<Walled<'a>>,
}

impl<'a> Swarm<'a> {
    /// Photons at `source`, bound for `targets`, both n points, which leave the field by `fade`.
    pub(super) fn new(
        source: &[Vec2],
        targets: &'a [Vec2],
        (fade, mean_straight): (Fade, f32),
        obstacles: Option<&'a Obstacles>,
    ) -> Self {
        let walled = obstacles.map(|obstacles| Walled::new(obstacles, source, (fade, mean_straight)));
        Self { walled, ..Self::free(source, targets, &fade, mean_straight) }
    }

    /// Finds the ways around walls, if it was not done before: needed before anything is asked of a swarm at its start.
    ///
    /// # Errors
    /// `Cancelled`.
    pub(super) fn set_out(&mut self, progress: &Progress) -> Result<()> {
        match &mut self.walled {
            Some(walled) => walled.set_out(self.targets, &mut self.per_limit, progress),
            None => Ok(()),
        }
    }

    fn free(source: &[Vec2], targets: &'a [Vec2], fade: &Fade, mean_straight: f32) -> Self {
        let ways = source.par_iter().zip(targets);
        let per_limit = ways
            .clone()
            .map(|(&a, &b)| 1.0 / fade.speed_limit(a.distance(b), mean_straight).max(f32::MIN_POSITIVE));
        Self {
            targets,
            per_limit: per_limit.collect(),
            guidance: ways.map(|(&a, &b)| b - a).collect(),
            curve: vec![[Vec2::ZERO; 3]; source.len()],
            start: 0.0,
            length: 0.0,
            walled: None,
        }
    }

    /// Photons that walls did not keep.
    pub(super) fn astray(&self) -> Astray {
        self.walled.as_ref().map_or(Astray::default(), Walled::astray)
    }

    /// From the end of the step before through the next.
    ///
    /// # Errors
    /// `Numeric` with the count when photons are no longer finite, `Cancelled`.
    pub(super) fn advance(&mut self, step: &Step, progress: &Progress) -> Result<()> {
        (self.start, self.length) = (step.start, step.length);
        self.set_out(progress)?;
        let lost = match &mut self.walled {
            None => self.advance_free(step, progress)?,
            Some(walled) => {
                let columns = Columns {
                    guidance: &mut self.guidance,
                    curve: &mut self.curve,
                    targets: self.targets,
                    per_limit: &self.per_limit,
                };
                walled.advance(step, columns, progress)?
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

    /// Moves all photons through `step` where no wall stands; returns how many are no longer finite.
    fn advance_free(&mut self, step: &Step, progress: &Progress) -> Result<usize> {
        let columns = (
            self.guidance.par_chunks_mut(CHUNK),
            self.curve.par_chunks_mut(CHUNK),
            self.targets.par_chunks(CHUNK),
            self.per_limit.par_chunks(CHUNK),
        );
        columns
            .into_par_iter()
            .map(|(guidance, curve, targets, per_limit)| {
                progress.check()?;
                for (v, [k0, k1, k2]) in guidance.iter_mut().zip(&*curve) {
                    *v += *k0 + *k1 + *k2;
                }
                let (groups, rest) = curve.as_chunks_mut::<ABREAST>();
                let of_group =
                    guidance.as_chunks().0.iter().zip(targets.as_chunks().0).zip(per_limit.as_chunks().0);
                for (curves, ((&v, &targets), &per_limit)) in groups.iter_mut().zip(of_group) {
                    *curves = step.curves(targets, v, per_limit);
                }
                let first = guidance.len() - rest.len();
                for (i, curve) in rest.iter_mut().enumerate().map(|(i, curve)| (first + i, curve)) {
                    *curve = step.curve(targets[i], guidance[i], per_limit[i]);
                }
                let finite = |curve: &&[Vec2; 3]| curve.iter().all(|k| k.is_finite());
                Ok(curve.iter().filter(|curve| !finite(curve)).count())
            })
            .try_reduce(|| 0, |a, b| Ok(a + b))
    }

    /// Guidance v of Eq. (2) at `t`, which lies in the current step; where walls stand, at its end.
    pub(super) fn guidance(&self, t: f64, out: &mut [Vec2]) {
        if let Some(walled) = &self.walled {
            return walled.guidance(self.targets, (1.0 - t) as f32, out);
        }
        let x = self.place_in_step(t);
        self.each(out, |_, _, v0, [k0, k1, k2]| v0 + x * (k0 + x * (k1 + x * k2)));
    }

    /// Share of the field, 1 - s, of each photon with guidance `v`, where `share` is that of the time.
    pub(super) fn shares(&self, share: f32, v: &[Vec2]) -> Vec<f32> {
        v.par_iter().zip(&self.per_limit).map(|(v, per_limit)| share * ease(v.length() * per_limit)).collect()
    }

    fn place_in_step(&self, t: f64) -> f32 {
        if self.length > 0.0 { ((t - self.start) / self.length) as f32 } else { 0.0 }
    }

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

impl Moving for Swarm<'_> {
    fn positions(&self, t: f64, out: &mut [Vec2]) {
        let x = self.place_in_step(t);
        let place = |i| self.walled.as_ref().and_then(|walled| walled.place(i, x));
        self.each(out, |i, target, v0, [k0, k1, k2]| {
            place(i).unwrap_or_else(|| position(target, v0 + x * (k0 + x * (k1 + x * k2)), t as f32))
        });
    }

    /// c' = v - (1-t) v'.
    fn velocities(&self, t: f64, out: &mut [Vec2]) {
        let x = self.place_in_step(t);
        let slope = if self.length > 0.0 { ((1.0 - t) / self.length) as f32 } else { 0.0 };
        let per_length = if self.length > 0.0 { (1.0 / self.length) as f32 } else { 0.0 };
        let line = |i| self.walled.as_ref().and_then(|walled| walled.line(i));
        self.each(out, |i, _, v0, [k0, k1, k2]| {
            let v = v0 + x * (k0 + x * (k1 + x * k2));
            let curved = v - slope * (k0 + x * (2.0 * k1 + x * (3.0 * k2)));
            line(i).map_or(curved, |way| way * per_length)
        });
    }
}

impl Step {
    /// Time at its end, the begin of the next.
    pub(super) fn end(&self) -> f64 {
        self.start + self.length
    }

    /// The cubics of some photons. Their coefficients are those of RK4's own continuous extension of order 3 (Hairer,
    /// Norsett, Wanner, Solving Ordinary Differential Equations I, II.6), which costs no fifth evaluation.
    #[inline(always)]
    pub(super) fn curves<const N: usize>(
        &self,
        targets: [Vec2; N],
        v: [Vec2; N],
        per_limit: [f32; N],
    ) -> [[Vec2; 3]; N] {
        let Some([begin, middle, end]) = &self.stages else {
            return [[Vec2::ZERO; 3]; N];
        };
        let (t, h) = (self.start as f32, self.length as f32);
        let slopes = |stage: &Stage, v: [Vec2; N], t: f32| -> [Vec2; N] {
            let u: [Vec2; N] = stage.velocities(from_fn(|i| position(targets[i], v[i], t)));
            from_fn(|i| (v[i] - u[i]) * (h * stage.rate * ease(v[i].length() * per_limit[i])))
        };
        let k1 = slopes(begin, v, t);
        let k2 = slopes(middle, from_fn(|i| v[i] + 0.5 * k1[i]), t + 0.5 * h);
        let k3 = slopes(middle, from_fn(|i| v[i] + 0.5 * k2[i]), t + 0.5 * h);
        let k4 = slopes(end, from_fn(|i| v[i] + k3[i]), t + h);
        from_fn(|i| {
            let (k1, k2, k3, k4) = (k1[i], k2[i], k3[i], k4[i]);
            [k1, k2 + k3 - 1.5 * k1 - 0.5 * k4, (2.0 / 3.0) * (k1 - k2 - k3 + k4)]
        })
    }

    /// The cubic of one photon.
    #[inline(always)]
    pub(super) fn curve(&self, target: Vec2, v: Vec2, per_limit: f32) -> [Vec2; 3] {
        let [curve] = self.curves([target], [v], [per_limit]);
        curve
    }
}
