//! The tracks of photons from a key frame to the meeting.

use glam::Vec2;
use rayon::prelude::*;

use super::fields::MeetingFields;
use super::wall_motion::WallMotion;
use crate::flow::step::{CHUNK, StageVelocity};
use crate::{Error, Progress, Result};

/// Photons that are stepped together: their evaluations overlap in the processor's pipeline.
const BATCH: usize = 16;

/// Positions of photons at every step from a key frame to the meeting at t = 1/2: forward from the earlier one, or
/// backward from the later one.
#[derive(Clone, Debug)]
pub struct HalfTracks {
    /// By step, from the key frame on.
    steps: Vec<Vec<Vec2>>,
}

impl HalfTracks {
    /// Carries photons from the key frame of `half` (0: the earlier, 1: the later) to the meeting.
    ///
    /// # Errors
    /// `Numeric` with the count when photons are no longer finite; `Cancelled`.
    pub fn new(fields: &MeetingFields, half: usize, photons: &[Vec2], progress: &Progress) -> Result<Self> {
        let mut steps = Vec::with_capacity(fields.steps() / 2 + 1);
        steps.push(photons.to_vec());
        for done in 0..fields.steps() / 2 {
            progress.check()?;
            let mut next = steps[done].clone();
            advance(fields, half, done, &mut next, progress)?;
            steps.push(next);
        }
        Ok(Self { steps })
    }

    /// Positions at the meeting.
    pub fn end(&self) -> &[Vec2] {
        self.steps.last().map_or(&[], Vec::as_slice)
    }

    /// Positions after `done` steps from the key frame.
    pub fn after(&self, done: usize) -> &[Vec2] {
        &self.steps[done]
    }

    /// Steps from the key frame to the meeting.
    pub fn count(&self) -> usize {
        self.steps.len() - 1
    }

    /// The photons in another order: row k of the result is row `order[k]` of this.
    #[must_use]
    pub fn permuted(&self, order: &[u32]) -> Self {
        let permute = |at: &Vec<Vec2>| order.iter().map(|&row| at[row as usize]).collect();
        Self { steps: self.steps.par_iter().map(permute).collect() }
    }
}

/// Advances photons by one step of a half, after `done` steps of it.
///
/// # Errors
/// `Numeric` with the count when photons are no longer finite; `Cancelled`.
pub(super) fn advance(
    fields: &MeetingFields,
    half: usize,
    done: usize,
    photons: &mut [Vec2],
    progress: &Progress,
) -> Result<()> {
    let velocities = fields.step(half, done);
    // Velocities are forward in time; the second half runs against it.
    let sign = if half == 0 { 1.0 } else { -1.0 };
    let h = sign / fields.steps() as f32;
    let walls = WallMotion::new(fields, half, done);
    let lost = photons
        .par_chunks_mut(CHUNK)
        .map(|photons| {
            progress.check()?;
            match &walls {
                Some(walls) => photons.iter_mut().for_each(|p| match walls.is_far(*p) {
                    true => [*p] = runge_kutta(&velocities, h, [*p]),
                    false => *p = walls.advance(&velocities, h, *p, 1.0),
                }),
                None => {
                    let (batches, rest) = photons.as_chunks_mut::<BATCH>();
                    batches.iter_mut().for_each(|batch| *batch = runge_kutta(&velocities, h, *batch));
                    rest.iter_mut().for_each(|p| [*p] = runge_kutta(&velocities, h, [*p]));
                }
            }
            Ok(photons.iter().filter(|p| !p.is_finite()).count())
        })
        .try_reduce(|| 0, |a, b| Ok(a + b))?;
    if lost == 0 {
        return Ok(());
    }
    let what = format!(
        "{lost} of {} photons are no longer finite after {} steps; take more steps or a larger alpha",
        photons.len(),
        done + 1
    );
    Err(Error::Numeric { stage: "advect", what })
}

/// One step of the classical Runge-Kutta method of order 4.
#[inline(always)]
fn runge_kutta<const N: usize>([begin, middle, end]: &[StageVelocity; 3], h: f32, c: [Vec2; N]) -> [Vec2; N] {
    let moved = |k: [Vec2; N], by: f32| std::array::from_fn(|i| c[i] + by * k[i]);
    let k1: [Vec2; N] = begin.velocities(c);
    let k2 = middle.velocities(moved(k1, 0.5 * h));
    let k3 = middle.velocities(moved(k2, 0.5 * h));
    let k4 = end.velocities(moved(k3, h));
    std::array::from_fn(|i| c[i] + (h / 6.0) * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
}
