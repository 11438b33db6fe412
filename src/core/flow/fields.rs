//! The fitted fields of one segment, interpolated in time.

use std::sync::Arc;

use glam::Vec2;

use super::fade::{Fade, PlainFade};
use super::field::Field;
use super::guidance::guidance;
use super::step::{StageVelocity, Step};
use super::turbulence::Turbulence;
use super::walls::{Obstacles, SUBSTEPS};
use crate::{Progress, Result};

/// The fields fitted between two key frames, which carry the photons of all passes.
///
/// Between fits the field is extrapolated from the last two, u(t) = u_n + (t - t_n)/h (u_n - u_(n-1)): second order in h
/// at one fit per step, and known before the next fit, so that guide photons and those of later passes move alike.
#[derive(serde::Deserialize, serde::Serialize)]
pub struct Fields {
    nodes: Vec<Field>,
    steps: usize,
    /// Photon steps per field.
    substeps: usize,
    #[serde(with = "PlainFade")]
    fade: Fade,
    mean_straight: f32,
    turbulence: Option<Turbulence>,
    obstacles: Option<Arc<Obstacles>>,
}

impl Fields {
    /// Given fields: `nodes[n]` is the field at t = n / `steps`.
    ///
    /// # Panics
    /// When there is no step, or a field is missing before the fade has ended.
    pub fn from_nodes(nodes: Vec<Field>, steps: usize, fade: Fade, mean_straight: f32) -> Self {
        let fields = Self::from_spaced_nodes(nodes, [steps, 1], fade, mean_straight);
        fields.unwrap_or_else(|| panic!("a field for every step until the fade ends"))
    }

    /// Fields that are given, not fitted: `nodes[n]` is the field at t = n `substeps` / `steps`. None where a field is
    /// missing before the fade has ended.
    pub fn from_spaced_nodes(
        nodes: Vec<Field>,
        [steps, substeps]: [usize; 2],
        fade: Fade,
        mean_straight: f32,
    ) -> Option<Self> {
        if steps == 0 || substeps == 0 || !steps.is_multiple_of(substeps) {
            return None;
        }
        let fields = Self { nodes, steps, substeps, ..Self::new(steps, fade, mean_straight, None, None) };
        let count = fields.nodes.len();
        let whole = count >= steps / substeps || fields.node_time(count) >= fade.end();
        (count > 0 && whole).then_some(fields)
    }

    pub(super) fn new(
        steps: usize,
        fade: Fade,
        mean_straight: f32,
        turbulence: Option<Turbulence>,
        obstacles: Option<Arc<Obstacles>>,
    ) -> Self {
        let substeps = if obstacles.is_some() { SUBSTEPS } else { 1 };
        Self {
            nodes: Vec::new(),
            steps: steps * substeps,
            substeps,
            fade,
            mean_straight,
            turbulence,
            obstacles,
        }
    }

    /// The same fields with this turbulence in place of any other.
    pub fn with_turbulence(self, turbulence: Option<Turbulence>) -> Self {
        Self { turbulence, ..self }
    }

    /// Appends the next field.
    pub(super) fn push(&mut self, field: Field) {
        self.nodes.push(field);
    }

    /// Time steps of the photons; several for each field where walls stand, so that paths turn smoothly.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Time steps of the photons for each field.
    pub fn substeps(&self) -> usize {
        self.substeps
    }

    /// The fields in order of time, see [`Self::node_time`], until the fade ends: all photons go straight from there on.
    pub fn nodes(&self) -> &[Field] {
        &self.nodes
    }

    /// The time of field `n`.
    pub fn node_time(&self, n: usize) -> f64 {
        self.time(n * self.substeps)
    }

    /// Whether a field is fitted at the begin of step `n`.
    pub(super) fn is_fitted_at(&self, n: usize) -> bool {
        n.is_multiple_of(self.substeps)
    }

    /// The fade.
    pub fn fade(&self) -> Fade {
        self.fade
    }

    /// The mean straight distance |b - a| of the guide photons; mean path length where walls stand.
    pub fn mean_straight(&self) -> f32 {
        self.mean_straight
    }

    /// The walls; none where none stands at any time.
    pub(super) fn obstacles(&self) -> Option<&Arc<Obstacles>> {
        self.obstacles.as_ref()
    }

    /// The turbulence that is added to the fields.
    pub fn turbulence(&self) -> Option<&Turbulence> {
        self.turbulence.as_ref()
    }

    /// The turbulence at time `t`: fields whose velocities add up.
    pub fn noise(&self, t: f64) -> Vec<Field> {
        self.turbulence.as_ref().map_or_else(Vec::new, |turbulence| turbulence.at(t))
    }

    /// The speed that speed limits are relative to: that of the straight paths and the turbulence together, so that photons
    /// which rest may be stirred, too.
    pub(super) fn reference_speed(&self) -> f32 {
        match &self.turbulence {
            Some(turbulence) => self.mean_straight.hypot(turbulence.speed()),
            None => self.mean_straight,
        }
    }

    /// Time at the begin of step `n`.
    pub(super) fn time(&self, n: usize) -> f64 {
        n as f64 / self.steps as f64
    }

    /// Whether a field acts in step `n`: from the end of the fade on all photons go straight.
    fn acts_in(&self, n: usize) -> bool {
        n / self.substeps < self.nodes.len() && self.time(n) < self.fade.end()
    }

    /// The field at the fraction `x` of step `n`, in which one must act.
    fn field(&self, n: usize, x: f32) -> Field {
        let (node, part) = (n / self.substeps, n % self.substeps);
        let (now, before) = (&self.nodes[node], &self.nodes[node.saturating_sub(1)]);
        let since = (part as f32 + x) / self.substeps as f32;
        let mut field = now.clone();
        Field::blend(now, 1.0 + since, before, -since, &mut field);
        field
    }

    /// The fields whose velocities add up at time `t`, clipped to 0..=1: the fitted field first, then the turbulence. Empty
    /// once the fade has ended.
    pub fn at(&self, t: f64) -> Vec<Field> {
        let t = t.clamp(0.0, 1.0);
        let n = self.step_of(t);
        if !self.acts_in(n) || t >= self.fade.end() {
            return Vec::new();
        }
        let x = (t * self.steps as f64 - n as f64) as f32;
        std::iter::once(self.field(n, x)).chain(self.noise(t)).collect()
    }

    /// Guidance v of Eq. (2) at time `t` < 1 for photons at `positions` bound for `targets`, row by row; along the paths
    /// around walls where they stand. Plane units per unit of t.
    ///
    /// # Errors
    /// `Cancelled`.
    ///
    /// # Panics
    /// When the columns differ in length.
    pub fn guidance(
        &self,
        t: f64,
        positions: &[Vec2],
        targets: &[Vec2],
        progress: &Progress,
    ) -> Result<Vec<Vec2>> {
        assert_eq!(positions.len(), targets.len(), "each photon has one target");
        match &self.obstacles {
            None => Ok(guidance(positions, targets, t as f32)),
            Some(obstacles) => {
                let columns = (positions, targets);
                obstacles.guidance(self.step_of(t.clamp(0.0, 1.0)), (1.0 - t) as f32, columns, progress)
            }
        }
    }

    /// The number of the step at time `t`, 0..=1.
    pub(super) fn step_of(&self, t: f64) -> usize {
        ((t * self.steps as f64) as usize).min(self.steps - 1)
    }

    /// Step `n`, whose field must be known unless the fade has ended.
    pub(super) fn step(&self, n: usize) -> Step {
        let (start, end) = (self.time(n), self.time(n + 1));
        let time = |x: f32| start + f64::from(x) * (end - start);
        let stages = [0.0, 0.5, 1.0];
        let velocities = self
            .acts_in(n)
            .then(|| stages.map(|x| StageVelocity { field: self.field(n, x), noise: self.noise(time(x)) }));
        let rates = stages.map(|x| self.fade.rate(time(x)));
        Step { number: n, left: self.steps - 1 - n, start, length: end - start, velocities, rates }
    }
}
