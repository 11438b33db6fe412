//! The fields of a segment that meets half way, interpolated in time.

use std::sync::Arc;

use crate::bridge::CellVelocities;
use crate::constraint::VisibilityGraph;
use crate::flow::field::Field;
use crate::flow::step::StageVelocity;
use crate::flow::turbulence::Turbulence;
use crate::flow::walls::{Obstacles, SUBSTEPS};
use crate::{Progress, Result};

/// The fields that carry the light of both key frames to the meeting at t = 1/2, where photons of all passes are paired.
///
/// Step n of the first half has the field fitted at its begin; step n of the second half that fitted at its end, where the
/// light that moves backward comes from. It stays within a step, so that guide photons and those of later passes move alike;
/// extrapolated from the last two fits, light that fills cracks would swing.
#[derive(serde::Deserialize, serde::Serialize)]
pub struct MeetingFields {
    /// By half, from its key frame to the meeting.
    halves: [Vec<Field>; 2],
    /// The planned velocities near walls, by half and step; empty where no wall stands.
    planned: [Vec<CellVelocities>; 2],
    /// What directed lines change about the fields, by half and step; empty where no wall stands.
    lines: [Vec<Option<Field>>; 2],
    steps: usize,
    mean_way: f32,
    hold: f32,
    turbulence: Option<Turbulence>,
    obstacles: Option<Arc<Obstacles>>,
}

impl MeetingFields {
    /// No fields yet of `steps` steps, an even number.
    pub(super) fn new(
        steps: usize,
        mean_way: f32,
        turbulence: Option<Turbulence>,
        obstacles: Option<Arc<Obstacles>>,
    ) -> Self {
        Self {
            halves: Default::default(),
            planned: Default::default(),
            lines: Default::default(),
            steps,
            mean_way,
            hold: 0.0,
            turbulence,
            obstacles,
        }
    }

    /// Given fields, half of them of the first half and half of the second, by rising time, without walls. None where a field is
    /// missing.
    pub fn from_nodes(mut nodes: Vec<Field>, steps: usize, mean_way: f32) -> Option<Self> {
        if steps == 0 || nodes.len() != steps || !steps.is_multiple_of(2) {
            return None;
        }
        let mut second = nodes.split_off(steps / 2);
        second.reverse();
        Some(Self { halves: [nodes, second], ..Self::new(steps, mean_way, None, None) })
    }

    /// The same fields with this turbulence in place of any other.
    #[must_use]
    pub fn with_turbulence(self, turbulence: Option<Turbulence>) -> Self {
        Self { turbulence, ..self }
    }

    /// The same fields of light whose pieces of about this size, plane units, hold together; 0 until set: no diffusion.
    #[must_use]
    pub fn with_hold(self, hold: f32) -> Self {
        Self { hold, ..self }
    }

    /// Size of the pieces of light that hold together, plane units.
    pub fn hold(&self) -> f32 {
        self.hold
    }

    /// Appends the next field of a half; where walls stand, with the planned velocities and what directed lines change.
    pub(super) fn push(
        &mut self,
        half: usize,
        field: Field,
        beside_walls: Option<(CellVelocities, Option<Field>)>,
    ) {
        if let Some((planned, lines)) = beside_walls {
            self.planned[half].push(planned);
            self.lines[half].push(lines);
        }
        self.halves[half].push(field);
    }

    /// Time steps of the whole segment, an even number.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Moves of the photons over the segment, each of which meets no wall: several for each step where walls stand.
    pub fn moves(&self) -> usize {
        self.obstacles.as_ref().map_or(self.steps, |obstacles| obstacles.steps())
    }

    /// The fields with their times, rising.
    pub fn nodes(&self) -> impl DoubleEndedIterator<Item = (f64, &Field)> {
        let time = |n: usize| n as f64 / self.steps as f64;
        let [first, second] = &self.halves;
        let forward = first.iter().enumerate().map(move |(n, field)| (time(n), field));
        let backward = second.iter().enumerate().rev().map(move |(n, field)| (1.0 - time(n), field));
        forward.chain(backward)
    }

    /// The mean way of the light at its initial velocity, plane units.
    pub fn mean_way(&self) -> f32 {
        self.mean_way
    }

    pub(super) fn set_mean_way(&mut self, way: f32) {
        self.mean_way = way;
    }

    /// The turbulence that is added to the fields.
    pub fn turbulence(&self) -> Option<&Turbulence> {
        self.turbulence.as_ref()
    }

    /// The walls; none where none stands at any time.
    pub(in crate::flow) fn obstacles(&self) -> Option<&Arc<Obstacles>> {
        self.obstacles.as_ref()
    }

    /// The walls at the meeting; none where none stands.
    pub fn walls_at_meeting(&self) -> Option<Arc<VisibilityGraph>> {
        self.obstacles.as_ref()?.shared_graph(self.steps / 2 * SUBSTEPS)
    }

    /// All walls that stand at any time; none where there is none.
    ///
    /// # Errors
    /// `Limit` for walls of too many corners; `Cancelled`.
    pub(super) fn walls_at_any_time(&self, progress: &Progress) -> Result<Option<Arc<VisibilityGraph>>> {
        self.obstacles.as_ref().map_or(Ok(None), |obstacles| obstacles.graph_of_all(progress))
    }

    /// The planned velocities of step `done` of a half, forward in time; none where no wall stands.
    pub(super) fn planned(&self, half: usize, done: usize) -> Option<&CellVelocities> {
        self.planned[half].get(done)
    }

    /// What directed lines change about the field of step `done` of a half; none where none acts, or no wall stands.
    pub(super) fn lines(&self, half: usize, done: usize) -> Option<&Field> {
        self.lines[half].get(done)?.as_ref()
    }

    /// The length of a step of a half; negative in the second, which runs against time.
    pub(super) fn signed_step(&self, half: usize) -> f32 {
        (if half == 0 { 1.0 } else { -1.0 }) / self.steps as f32
    }

    /// Begin, middle and end of the step after `done` steps of a half.
    fn step_times(&self, half: usize, done: usize) -> [f64; 3] {
        [0.0, 0.5, 1.0].map(|x| {
            let since = (done as f64 + x) / self.steps as f64;
            if half == 0 { since } else { 1.0 - since }
        })
    }

    /// The turbulence at time `t`: fields whose velocities add up.
    pub fn noise(&self, t: f64) -> Vec<Field> {
        self.turbulence.as_ref().map_or_else(Vec::new, |turbulence| turbulence.at(t))
    }

    /// The fields whose velocities add up at time `t`, clipped to 0..=1: the fitted field first, then the turbulence.
    pub fn at(&self, t: f64) -> Vec<Field> {
        let t = t.clamp(0.0, 1.0);
        let half = usize::from(t > 0.5);
        let since = if half == 0 { t } else { 1.0 - t } * self.steps as f64;
        let done = (since as usize).min(self.steps / 2 - 1);
        if done >= self.halves[half].len() {
            return Vec::new();
        }
        std::iter::once(self.halves[half][done].clone()).chain(self.noise(t)).collect()
    }

    /// The velocities at the begin, middle and end of the step after `done` steps of a half, forward in time.
    pub(super) fn step(&self, half: usize, done: usize) -> [StageVelocity; 3] {
        let field = &self.halves[half][done];
        self.step_times(half, done).map(|t| StageVelocity { field: field.clone(), noise: self.noise(t) })
    }
}
