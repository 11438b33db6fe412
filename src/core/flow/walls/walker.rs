//! One photon through one step where walls stand.
//!
//! A photon that sees its target moves as without walls, unless that would carry it through one. Otherwise the step is
//! split (Strang 1968): half the guidance, the field, the other half of the guidance. Guidance advances along the path
//! around the walls; with the length L of the path ahead, L' = -s L / (1-t), so that half a step leaves
//! L ((1-t_m)/(1-t))^s, exactly, and at t = 1 nothing. The field slides along walls.

use arrayvec::ArrayVec;
use glam::Vec2;

use super::moves::slide;
use super::path_state::{PathState, PathStatus};
use crate::constraint::visibility::SearchBuffers;
use crate::constraint::{VisibilityGraph, WallPath};
use crate::flow::fade::ease;
use crate::flow::guidance::position;
use crate::flow::step::{StageVelocity, Step};

/// Bisections in the search for the last visible point, to 1/64 of a leg.
const BISECTIONS: usize = 6;
/// Limit of corners passed in one step.
const TURNS: usize = 8;

/// The context of one step.
pub(super) struct Walker<'a> {
    pub(super) step: &'a Step,
    pub(super) graph: &'a VisibilityGraph,
}

/// A photon at the begin of a step.
pub(super) struct Photon {
    /// Its position.
    pub(super) at: Vec2,
    /// Its target.
    pub(super) target: Vec2,
    /// One over the speed at which it leaves the field.
    pub(super) inverse_limit: f32,
}

/// The path of a photon over one step.
pub(super) enum StepPath {
    /// The cubic of its guidance.
    Cubic([Vec2; 3]),
    /// A straight line to this point.
    Line(Vec2),
}

/// A point on the way through a step, and the path from there.
#[derive(Clone, Copy)]
struct Waypoint {
    at: Vec2,
    path: WallPath,
    /// Whether the field led here, not the path.
    by_field: bool,
}

/// The points of a step in order.
type Waypoints = ArrayVec<Waypoint, { TURNS + 4 }>;

impl Photon {
    /// Guidance straight to the target, Eq. (2).
    pub(super) fn guidance(&self, step: &Step) -> Vec2 {
        (self.target - self.at) / (1.0 - step.start) as f32
    }

    /// The cubic as without walls.
    pub(super) fn curve(&self, step: &Step) -> [Vec2; 3] {
        step.curve(self.target, self.guidance(step), self.inverse_limit)
    }

    /// The end of that cubic.
    pub(super) fn end_of(&self, step: &Step, curve: &[Vec2; 3]) -> Vec2 {
        let v = self.guidance(step) + (curve[0] + (curve[1] + curve[2]));
        position(self.target, v, step.end() as f32)
    }
}

impl Walker<'_> {
    /// Advances the photon through the step; `state` becomes that of its end.
    pub(super) fn advance(
        &self,
        photon: &Photon,
        state: &mut PathState,
        buffers: &mut SearchBuffers,
    ) -> StepPath {
        let taken = match state.status {
            PathStatus::Unreachable => StepPath::Cubic(photon.curve(self.step)),
            PathStatus::Waiting => {
                StepPath::Line(slide(self.graph.barriers(), photon.at, self.drift(photon, photon.at, 0.0)))
            }
            PathStatus::Following => self.follow(photon, state, buffers),
        };
        state.on_line = matches!(taken, StepPath::Line(_));
        taken
    }

    /// The step of a photon that follows its path. Invariant: the photon sees the next point of its path, and has fewer
    /// corners ahead than steps left, one for each. So a wall is never crossed: where nothing better is found the photon
    /// rests, or goes to the next corner at once.
    fn follow(&self, photon: &Photon, state: &mut PathState, buffers: &mut SearchBuffers) -> StepPath {
        let (c, b) = (photon.at, photon.target);
        if state.path.is_straight()
            && let Some(taken) = self.smooth(photon, state, buffers)
        {
            return taken;
        }
        if self.step.left == 0 {
            return StepPath::Line(self.graph.next_point(state.path, b));
        }
        if self.graph.corners_ahead(state.path) >= self.step.left {
            let corner = self.graph.next_point(state.path, b);
            state.path = self.graph.after_corner(state.path);
            return StepPath::Line(corner);
        }
        for by_field in [true, false] {
            let (end, path) = self.split(photon, state.path, by_field, buffers);
            if self.holds(c, end, path, b) {
                state.path = path;
                return StepPath::Line(end);
            }
        }
        StepPath::Line(c)
    }

    /// Whether the invariant holds for a move from `c` to `end` that goes on by `path`.
    fn holds(&self, c: Vec2, end: Vec2, path: WallPath, b: Vec2) -> bool {
        let barriers = self.graph.barriers();
        !barriers.blocks(c, end)
            && !barriers.blocks(end, self.graph.next_point(path, b))
            && self.graph.corners_ahead(path) < self.step.left
    }

    /// The step as without walls, if it meets none and the target stays visible or a path to it is found.
    fn smooth(
        &self,
        photon: &Photon,
        state: &mut PathState,
        buffers: &mut SearchBuffers,
    ) -> Option<StepPath> {
        let (c, b) = (photon.at, photon.target);
        let curve = photon.curve(self.step);
        if !curve.iter().all(|k| k.is_finite()) {
            return Some(StepPath::Cubic(curve));
        }
        let end = photon.end_of(self.step, &curve);
        let barriers = self.graph.barriers();
        if barriers.blocks(c, end) {
            return None;
        }
        if barriers.blocks(end, b) {
            let path = self.graph.path(end, b, buffers)?;
            if self.step.left == 0 || self.graph.corners_ahead(path) >= self.step.left {
                return None;
            }
            state.path = path;
        }
        // Between its ends the curve may bulge through a wall that the chord misses.
        let bulges = barriers.may_touch(c, end, 0.25 * c.distance(end));
        Some(if bulges { StepPath::Line(end) } else { StepPath::Cubic(curve) })
    }

    /// Half the guidance, the field if `by_field`, half the guidance; returns the end and the path from there.
    fn split(
        &self,
        photon: &Photon,
        path: WallPath,
        by_field: bool,
        buffers: &mut SearchBuffers,
    ) -> (Vec2, WallPath) {
        let mut waypoints: Waypoints = ArrayVec::new();
        waypoints.push(Waypoint { at: photon.at, path, by_field: false });
        self.follow_path(photon, &mut waypoints, [0.0, 0.5]);
        if by_field {
            self.slide_on(photon, &mut waypoints, buffers);
        }
        self.follow_path(photon, &mut waypoints, [0.5, 1.0]);
        self.farthest(photon.at, &waypoints)
    }

    /// The last point on the way through the step that is visible from its begin `c`: the chord must not cut a corner.
    /// Between two waypoints it is found by bisection, or photons would gather at corners.
    fn farthest(&self, c: Vec2, waypoints: &Waypoints) -> (Vec2, WallPath) {
        let barriers = self.graph.barriers();
        let last = waypoints.iter().rposition(|waypoint| !barriers.blocks(c, waypoint.at)).unwrap_or(0);
        let Waypoint { at, path, .. } = waypoints[last];
        // From points that the field only passes through, no path may be known.
        let Some(next) = waypoints.get(last + 1).filter(|next| !next.by_field) else { return (at, path) };
        let (mut seen, mut hidden) = (0.0, 1.0);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (seen + hidden);
            if barriers.blocks(c, at.lerp(next.at, middle)) { hidden = middle } else { seen = middle }
        }
        // On the leg after a corner the path is the one from that corner on.
        (at.lerp(next.at, seen), path)
    }

    /// Moves by the field, if a path leads on from there.
    fn slide_on(&self, photon: &Photon, waypoints: &mut Waypoints, buffers: &mut SearchBuffers) {
        let Some(&Waypoint { at: c, path, .. }) = waypoints.last() else { return };
        let length = self.graph.length(path, c, photon.target);
        let end = slide(self.graph.barriers(), c, self.drift(photon, c, length));
        if let Some(path) = self.graph.updated(path, end, photon.target, buffers) {
            let _ = waypoints.try_push(Waypoint { at: end, path, by_field: true });
        }
    }

    /// Advances along the path from the fraction `from` to the fraction `to` of the step.
    fn follow_path(&self, photon: &Photon, waypoints: &mut Waypoints, [from, to]: [f64; 2]) {
        let Some(&Waypoint { at: mut c, mut path, .. }) = waypoints.last() else { return };
        let b = photon.target;
        let length = self.graph.length(path, c, b);
        let (start, step) = (self.step.start, self.step.length);
        let fitted = self.step.velocities.as_ref().map(|[begin, ..]| begin.field.velocity(photon.at));
        let share = |x: f64| self.field_share(photon, (length, fitted.unwrap_or_default()), x);
        let guided = 1.0 - 0.5 * (share(from) + share(to));
        let left = ((1.0 - start - to * step).max(0.0) / (1.0 - start - from * step)).powf(f64::from(guided));
        let mut distance = length * (1.0 - left as f32);
        while distance > 0.0 {
            let next = self.graph.next_point(path, b);
            let leg = c.distance(next);
            if distance < leg || path.is_straight() {
                c = if distance < leg { c + (next - c) * (distance / leg) } else { b };
                let _ = waypoints.try_push(Waypoint { at: c, path, by_field: false });
                return;
            }
            (distance, c, path) = (distance - leg, next, self.graph.after_corner(path));
            if waypoints.len() >= TURNS
                || waypoints.try_push(Waypoint { at: c, path, by_field: false }).is_err()
            {
                return;
            }
        }
    }

    /// Weight of the field, 1 - s, at the fraction `x` of the step (0, 1/2 or 1) for a photon with `length` of its path
    /// ahead in a field of velocity `fitted`.
    fn field_share(&self, photon: &Photon, (length, fitted): (f32, Vec2), x: f64) -> f32 {
        if self.step.velocities.is_none() {
            return 0.0;
        }
        let time_left = (1.0 - self.step.start - x * self.step.length) as f32;
        // At t = 1 the speed has no limit, and the fade none either.
        if time_left <= 0.0 {
            return 0.0;
        }
        let speed = (length / time_left).max(fitted.length());
        self.step.rates[(2.0 * x) as usize] * time_left * ease(speed * photon.inverse_limit)
    }

    /// The displacement by the field over the step from `c`, by the midpoint method.
    fn drift(&self, photon: &Photon, c: Vec2, length: f32) -> Vec2 {
        let Some([begin, middle, _]) = &self.step.velocities else { return Vec2::ZERO };
        let moved = |stage: &StageVelocity, p: Vec2| {
            let ([fitted], [u]) = stage.fitted_and_all([p]);
            self.step.length as f32 * self.field_share(photon, (length, fitted), 0.5) * u
        };
        let drift = moved(middle, c + 0.5 * moved(begin, c));
        if drift.is_finite() { drift } else { Vec2::ZERO }
    }
}
