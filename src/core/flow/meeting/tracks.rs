//! The tracks of photons from a key frame to the meeting.

use glam::Vec2;
use rayon::prelude::*;

use super::fields::MeetingFields;
use super::runge_kutta::runge_kutta;
use super::walks::Walks;
use super::wall_motion::WallMotion;
use crate::flow::step::{CHUNK, StageVelocity};
use crate::flow::walls::SUBSTEPS;
use crate::{Error, Progress, Result};

/// Photons that are stepped together: their evaluations overlap in the processor's pipeline.
const BATCH: usize = 16;

/// Positions of photons at every step from a key frame to the meeting at t = 1/2: forward from the earlier one, or
/// backward from the later one.
#[derive(Clone, Debug)]
pub struct HalfTracks {
    /// By step, from the key frame on.
    steps: Vec<Vec<Vec2>>,
    /// By step.
    walks: Vec<Walks>,
}

impl HalfTracks {
    /// Carries photons from the key frame of `half` (0: the earlier, 1: the later) to the meeting.
    ///
    /// # Errors
    /// `Numeric` with the count when photons are no longer finite; `Cancelled`.
    pub fn new(fields: &MeetingFields, half: usize, photons: &[Vec2], progress: &Progress) -> Result<Self> {
        let mut steps = Vec::with_capacity(fields.steps() / 2 + 1);
        let mut walks = Vec::with_capacity(fields.steps() / 2);
        steps.push(photons.to_vec());
        for done in 0..fields.steps() / 2 {
            progress.check()?;
            let mut next = steps[done].clone();
            walks.push(advance(fields, half, done, &mut next, progress)?);
            steps.push(next);
        }
        Ok(Self { steps, walks })
    }

    /// Positions at the meeting.
    pub fn end(&self) -> &[Vec2] {
        self.steps.last().map_or(&[], Vec::as_slice)
    }

    /// Positions after `done` steps from the key frame.
    pub fn after(&self, done: usize) -> &[Vec2] {
        &self.steps[done]
    }

    /// The photons that walk along walls in the step after `done` steps.
    pub(super) fn walks(&self, done: usize) -> &Walks {
        &self.walks[done]
    }

    /// Steps from the key frame to the meeting.
    pub fn count(&self) -> usize {
        self.steps.len() - 1
    }

    /// The photons in another order: row k of the result is row `order[k]` of this.
    #[must_use]
    pub fn permuted(&self, order: &[u32]) -> Self {
        let permute = |at: &Vec<Vec2>| order.iter().map(|&row| at[row as usize]).collect();
        Self {
            steps: self.steps.par_iter().map(permute).collect(),
            walks: self.walks.par_iter().map(|walks| walks.permuted(order)).collect(),
        }
    }
}

/// Advances photons by one step of a half, after `done` steps of it. Returns those that walk along walls.
///
/// # Errors
/// `Numeric` with the count when photons are no longer finite; `Cancelled`.
pub(super) fn advance(
    fields: &MeetingFields,
    half: usize,
    done: usize,
    photons: &mut [Vec2],
    progress: &Progress,
) -> Result<Walks> {
    let stages = fields.step(half, done);
    let h = fields.signed_step(half);
    let walls = WallMotion::new(fields, half, done);
    let chunks = photons.par_chunks_mut(CHUNK).enumerate();
    let step = |(chunk, photons): (usize, &mut [Vec2])| {
        progress.check()?;
        let walks = match &walls {
            Some(walls) => beside(walls, (&stages, h), (chunk * CHUNK, photons)),
            None => {
                free(&stages, h, photons);
                Vec::new()
            }
        };
        Ok((walks, photons.iter().filter(|p| !p.is_finite()).count()))
    };
    let done_chunks: Vec<(Vec<Walk>, usize)> = chunks.map(step).collect::<Result<_>>()?;
    let lost: usize = done_chunks.iter().map(|(_, lost)| lost).sum();
    if lost == 0 {
        let walks = done_chunks.into_iter().flat_map(|(walks, _)| walks);
        return Ok(if walls.is_some() { Walks::new(photons.len(), walks) } else { Walks::default() });
    }
    let what = format!(
        "{lost} of {} photons are no longer finite after {} steps; take more steps or a larger alpha",
        photons.len(),
        done + 1
    );
    Err(Error::Numeric { stage: "advect", what })
}

/// The row of a photon that walks along walls, and where it is after each substep.
type Walk = (usize, [Vec2; SUBSTEPS]);

/// Advances photons by one step where no wall stands.
fn free(stages: &[StageVelocity; 3], h: f32, photons: &mut [Vec2]) {
    let (batches, rest) = photons.as_chunks_mut::<BATCH>();
    batches.iter_mut().for_each(|batch| *batch = alone(stages, h, *batch));
    rest.iter_mut().for_each(|p| [*p] = alone(stages, h, [*p]));
}

#[inline(always)]
fn alone<const N: usize>(stages: &[StageVelocity; 3], h: f32, c: [Vec2; N]) -> [Vec2; N] {
    runge_kutta(h, c, |stage, p| stages[stage].velocities(p)).0
}

/// Advances photons, the first of them in row `first`, by one step beside walls.
fn beside(
    walls: &WallMotion,
    (stages, h): (&[StageVelocity; 3], f32),
    (first, photons): (usize, &mut [Vec2]),
) -> Vec<Walk> {
    let mut walks = Vec::new();
    for (number, batch) in photons.chunks_mut(BATCH).enumerate() {
        // The last batch is filled up with its first photon.
        let before: [Vec2; BATCH] = std::array::from_fn(|i| batch[if i < batch.len() { i } else { 0 }]);
        let (after, meets) = walls.step(stages, h, before);
        for (i, p) in batch.iter_mut().enumerate() {
            *p = after[i];
            if meets[i] {
                let places = walls.walk(stages, h, before[i]);
                *p = places[SUBSTEPS - 1];
                walks.push((first + number * BATCH + i, places));
            }
        }
    }
    walks
}
