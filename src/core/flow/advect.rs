//! Photons carried one step along the field: classical Runge-Kutta of order 4 in the guidance v (see
//! [`guidance`](super::guidance)), with a cubic in time kept of each, so that they can be asked for between the steps.

use glam::Vec2;
use rayon::prelude::*;

use super::fade::{Fade, ease};
use super::field::Field;
use super::guidance::position;
use super::report::Moving;
use crate::{Error, Progress, Result};

/// Photons per parallel task: fits the L1 cache beside the coefficients around them.
const CHUNK: usize = 2048;

/// What moves the photons from `start` to `start + length`: the field and the fade at the three times that RK4 asks for.
/// Blended once per step, so that a photon pays for one field where it would for two.
pub(super) struct Step {
    /// Time at the begin.
    pub start: f64,
    /// Duration.
    pub length: f64,
    /// Field and (1-s)/(1-t) at begin, middle and end; nothing once the fade has ended and all go straight.
    pub stages: Option<[(Field, f32); 3]>,
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
}

impl<'a> Swarm<'a> {
    /// Photons at `source`, bound for `targets`, both n points.
    pub(super) fn new(source: &[Vec2], targets: &'a [Vec2], fade: &Fade, mean_straight: f32) -> Self {
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
        }
    }

    /// From the end of the step before through the next.
    ///
    /// # Errors
    /// `Numeric` with the count when photons are no longer finite, `Cancelled`.
    pub(super) fn advance(&mut self, step: &Step, progress: &Progress) -> Result<()> {
        (self.start, self.length) = (step.start, step.length);
        let columns = (
            self.guidance.par_chunks_mut(CHUNK),
            self.curve.par_chunks_mut(CHUNK),
            self.targets.par_chunks(CHUNK),
            self.per_limit.par_chunks(CHUNK),
        );
        let lost = columns
            .into_par_iter()
            .map(|(guidance, curve, targets, per_limit)| {
                progress.check()?;
                let mut lost = 0;
                for i in 0..guidance.len() {
                    let [k0, k1, k2] = curve[i];
                    guidance[i] += k0 + k1 + k2;
                    curve[i] = step.curve(targets[i], guidance[i], per_limit[i]);
                    lost += usize::from(!curve[i].iter().all(|k| k.is_finite()));
                }
                Ok(lost)
            })
            .try_reduce(|| 0, |a, b| Ok(a + b))?;
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

    /// Guidance v of Eq. (2) at `t`, which lies in the current step.
    pub(super) fn guidance(&self, t: f64, out: &mut [Vec2]) {
        let x = self.place_in_step(t);
        self.each(out, |_, v0, [k0, k1, k2]| v0 + x * (k0 + x * (k1 + x * k2)));
    }

    /// Share of the field, 1 - s, of each photon with guidance `v`, where `share` is that of the time.
    pub(super) fn shares(&self, share: f32, v: &[Vec2]) -> Vec<f32> {
        v.par_iter().zip(&self.per_limit).map(|(v, per_limit)| share * ease(v.length() * per_limit)).collect()
    }

    fn place_in_step(&self, t: f64) -> f32 {
        if self.length > 0.0 { ((t - self.start) / self.length) as f32 } else { 0.0 }
    }

    fn each(&self, out: &mut [Vec2], value: impl Fn(Vec2, Vec2, [Vec2; 3]) -> Vec2 + Sync) {
        let columns = (
            out.par_chunks_mut(CHUNK),
            self.targets.par_chunks(CHUNK),
            self.guidance.par_chunks(CHUNK),
            self.curve.par_chunks(CHUNK),
        );
        columns.into_par_iter().for_each(|(out, targets, guidance, curve)| {
            for i in 0..out.len() {
                out[i] = value(targets[i], guidance[i], curve[i]);
            }
        });
    }
}

impl Moving for Swarm<'_> {
    fn positions(&self, t: f64, out: &mut [Vec2]) {
        let x = self.place_in_step(t);
        self.each(out, |target, v0, [k0, k1, k2]| {
            position(target, v0 + x * (k0 + x * (k1 + x * k2)), t as f32)
        });
    }

    /// c' = v - (1-t) v'.
    fn velocities(&self, t: f64, out: &mut [Vec2]) {
        let x = self.place_in_step(t);
        let slope = if self.length > 0.0 { ((1.0 - t) / self.length) as f32 } else { 0.0 };
        self.each(out, |_, v0, [k0, k1, k2]| {
            let v = v0 + x * (k0 + x * (k1 + x * k2));
            v - slope * (k0 + x * (2.0 * k1 + x * (3.0 * k2)))
        });
    }
}

impl Step {
    /// The cubic of one photon. Its coefficients are those of RK4's own continuous extension of order 3 (Hairer,
    /// Norsett, Wanner, Solving Ordinary Differential Equations I, II.6), which costs no fifth evaluation.
    #[inline(always)]
    fn curve(&self, target: Vec2, v: Vec2, per_limit: f32) -> [Vec2; 3] {
        let Some([begin, middle, end]) = &self.stages else {
            return [Vec2::ZERO; 3];
        };
        let (t, h) = (self.start as f32, self.length as f32);
        let slope = |(field, rate): &(Field, f32), v: Vec2, t: f32| {
            let u = field.velocity(position(target, v, t));
            (v - u) * (h * rate * ease(v.length() * per_limit))
        };
        let k1 = slope(begin, v, t);
        let k2 = slope(middle, v + 0.5 * k1, t + 0.5 * h);
        let k3 = slope(middle, v + 0.5 * k2, t + 0.5 * h);
        let k4 = slope(end, v + k3, t + h);
        [k1, k2 + k3 - 1.5 * k1 - 0.5 * k4, (2.0 / 3.0) * (k1 - k2 - k3 + k4)]
    }
}
