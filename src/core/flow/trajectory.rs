//! The fields of a segment, kept, and the photons of any pass carried along them.

use std::sync::Arc;

use glam::Vec2;

use super::advect::{Step, Swarm};
use super::fade::Fade;
use super::field::Field;
use super::guidance::guidance;
use super::obstacles::Obstacles;
use super::report::Moving as _;
use super::stage::Stage;
use super::turbulence::Turbulence;
use crate::{Progress, Result};

/// The fields fitted between two key frames: all that moves photons, whatever pass they are from.
///
/// Between the times of the fits the field goes on as it did between the last two,
/// u(t) = u_n + (t - t_n)/h (u_n - u_(n-1)): second order in h at one fit per step, and known before the next fit, so that
/// the photons which are fitted to and those of later passes move alike.
pub struct Fields {
    nodes: Vec<Field>,
    steps: usize,
    /// Steps for which a field serves.
    substeps: usize,
    fade: Fade,
    mean_straight: f32,
    turbulence: Option<Turbulence>,
    obstacles: Option<Arc<Obstacles>>,
}

impl Fields {
    /// Fields that are given, not fitted: `nodes[n]` is the field at t = n / `steps`.
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

    pub(super) fn push(&mut self, field: Field) {
        self.nodes.push(field);
    }

    /// Time steps of the photons; where walls stand, several for each field, so that ways turn smoothly around them.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Time steps of the photons for each field.
    pub fn substeps(&self) -> usize {
        self.substeps
    }

    /// The fields in the order of time, see [`Self::node_time`]. They end where the fade ends before t = 1: all photons go
    /// straight from there on.
    pub fn nodes(&self) -> &[Field] {
        &self.nodes
    }

    /// When field `n` was fitted.
    pub fn node_time(&self, n: usize) -> f64 {
        self.time(n * self.substeps)
    }

    /// Whether a field is fitted at the begin of step `n`.
    pub(super) fn is_fitted_at(&self, n: usize) -> bool {
        n.is_multiple_of(self.substeps)
    }

    /// How the photons leave the field.
    pub fn fade(&self) -> Fade {
        self.fade
    }

    /// The mean straight way |b - a| of the photons that were fitted to.
    pub fn mean_straight(&self) -> f32 {
        self.mean_straight
    }

    /// The walls; none where none ever stands.
    pub fn obstacles(&self) -> Option<&Arc<Obstacles>> {
        self.obstacles.as_ref()
    }

    /// The turbulence that is added to the fields, where there is any.
    pub fn turbulence(&self) -> Option<&Turbulence> {
        self.turbulence.as_ref()
    }

    /// The turbulence at time `t`: fields whose velocities add up.
    pub fn noise(&self, t: f64) -> Vec<Field> {
        self.turbulence.as_ref().map_or_else(Vec::new, |turbulence| turbulence.at(t))
    }

    /// The speed that every speed limit is measured in: that of the straight ways and of the turbulence together, so
    /// that it may also stir photons which have nowhere to go.
    pub(super) fn pace(&self) -> f32 {
        match &self.turbulence {
            Some(turbulence) => self.mean_straight.hypot(turbulence.speed()),
            None => self.mean_straight,
        }
    }

    /// Begin of step `n`.
    pub(super) fn time(&self, n: usize) -> f64 {
        n as f64 / self.steps as f64
    }

    /// Whether a field acts in step `n`: from the end of the fade on all photons go straight.
    fn acts_in(&self, n: usize) -> bool {
        n / self.substeps < self.nodes.len() && self.time(n) < self.fade.end()
    }

    /// The field at the share `x` of step `n`, in which one must act.
    fn field(&self, n: usize, x: f32) -> Field {
        let (node, part) = (n / self.substeps, n % self.substeps);
        let (now, before) = (&self.nodes[node], &self.nodes[node.saturating_sub(1)]);
        let since = (part as f32 + x) / self.substeps as f32;
        let mut field = now.clone();
        Field::blend(now, 1.0 + since, before, -since, &mut field);
        field
    }

    /// Everything that moves photons at time `t`, clipped to 0..=1: the fitted field first, then the turbulence, whose
    /// velocities add up. Empty once the fade has ended and all go straight.
    pub fn at(&self, t: f64) -> Vec<Field> {
        let t = t.clamp(0.0, 1.0);
        let n = self.step_of(t);
        if !self.acts_in(n) || t >= self.fade.end() {
            return Vec::new();
        }
        let x = (t * self.steps as f64 - n as f64) as f32;
        std::iter::once(self.field(n, x)).chain(self.noise(t)).collect()
    }

    /// Guidance v of Eq. (2) at time `t` < 1 for photons at `positions`, bound for `targets` row by row: where walls stand,
    /// along the ways around them. Plane units per unit of t.
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

    /// The step that a photon is in at time `t`, 0..=1.
    pub(super) fn step_of(&self, t: f64) -> usize {
        ((t * self.steps as f64) as usize).min(self.steps - 1)
    }

    /// Step `n`, whose field must be there unless the fade has ended.
    pub(super) fn step(&self, n: usize) -> Step {
        let (start, end) = (self.time(n), self.time(n + 1));
        let stages = self.acts_in(n).then(|| {
            [0.0, 0.5, 1.0].map(|x| {
                let t = start + f64::from(x) * (end - start);
                Stage { field: self.field(n, x), noise: self.noise(t), rate: self.fade.rate(t) }
            })
        });
        Step { number: n, left: self.steps - 1 - n, start, length: end - start, stages }
    }
}

/// Steps of the photons for each field where walls stand.
pub(super) const SUBSTEPS: usize = 4;

/// Photons that walls did not keep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Astray {
    /// Whose target no way reaches: they go straight.
    pub unreachable: usize,
    /// That crossed a wall though a way leads around it; 0 unless the program is wrong.
    pub crossings: usize,
}

impl Astray {
    /// Both together.
    pub fn plus(self, other: Self) -> Self {
        Self {
            unreachable: self.unreachable + other.unreachable,
            crossings: self.crossings + other.crossings,
        }
    }
}

/// Photons of one pass on their way along the fields. Its memory is 36 bytes a photon, whatever the number of frames.
///
/// Rows keep their order. Photons in the order of [`spatial_order`] move faster: neighbours read the same coefficients.
pub struct Carrier<'a> {
    fields: &'a Fields,
    source: &'a [Vec2],
    targets: &'a [Vec2],
    swarm: Swarm<'a>,
    /// Steps begun; the swarm is in the last of them.
    begun: usize,
}

impl<'a> Carrier<'a> {
    /// Photons at `source`, each bound for the target in the same row.
    ///
    /// # Panics
    /// When the columns differ in length.
    pub fn new(fields: &'a Fields, source: &'a [Vec2], targets: &'a [Vec2]) -> Self {
        assert_eq!(source.len(), targets.len(), "each photon has one target");
        let fade = (fields.fade, fields.pace());
        let swarm = Swarm::new(source, targets, fade, fields.obstacles.as_deref());
        Self { fields, source, targets, swarm, begun: 0 }
    }

    /// Carries the photons into step `n` (clipped to the last), whose times are n/steps to (n+1)/steps; back to the start first if they are
    /// beyond.
    ///
    /// # Errors
    /// `Numeric` with the count when photons are no longer finite, `Cancelled`.
    pub fn advance_to(&mut self, n: usize, progress: &Progress) -> Result<()> {
        let n = n.min(self.fields.steps - 1);
        if self.begun > n + 1 {
            *self = Self::new(self.fields, self.source, self.targets);
        }
        while self.begun <= n {
            self.swarm.advance(&self.fields.step(self.begun), progress)?;
            self.begun += 1;
        }
        Ok(())
    }

    /// Positions at time `t`, clipped to 0..=1. Ascending times cost one way through the fields in all; at t = 1 each photon
    /// is at its target.
    ///
    /// # Errors
    /// As [`Self::advance_to`].
    ///
    /// # Panics
    /// When `out` has not one place for each photon.
    pub fn positions_at(&mut self, t: f64, out: &mut [Vec2], progress: &Progress) -> Result<()> {
        let t = self.enter(t, out.len(), progress)?;
        self.swarm.positions(t, out);
        Ok(())
    }

    /// Photons so far whose target no way around the walls reaches, and those that crossed a wall though one did.
    pub fn astray(&self) -> Astray {
        self.swarm.astray()
    }

    fn enter(&mut self, t: f64, places: usize, progress: &Progress) -> Result<f64> {
        assert_eq!(places, self.targets.len(), "one place for each photon");
        let t = t.clamp(0.0, 1.0);
        self.advance_to(self.fields.step_of(t), progress)?;
        Ok(t)
    }
}

/// Rows in an order (Morton's) in which neighbours in the plane are mostly neighbours in memory; equal places keep their order.
pub fn spatial_order(points: &[Vec2]) -> Vec<u32> {
    let mut keyed: Vec<(u32, u32)> = points.iter().zip(0..).map(|(&p, i)| (morton(p), i)).collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, i)| i).collect()
}

/// Bits of the cell in x and y, of 1024 each, in turn; what lies outside counts as on the border.
fn morton(p: Vec2) -> u32 {
    let spread = |x: f32| {
        let mut bits = (x * 1024.0).clamp(0.0, 1023.0) as u32;
        bits = (bits | bits << 8) & 0x00ff_00ff;
        bits = (bits | bits << 4) & 0x0f0f_0f0f;
        bits = (bits | bits << 2) & 0x3333_3333;
        (bits | bits << 1) & 0x5555_5555
    };
    spread(p.x) | spread(p.y) << 1
}
