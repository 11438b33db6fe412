//! One photon through one step where walls stand.
//!
//! A photon that sees its target moves as without walls, unless that would carry it through one. Otherwise the step is
//! split (Strang 1968): half the guidance, the field, the other half of the guidance. Guidance walks along the way
//! around the walls; with the length L of the way ahead, L' = -s L / (1-t), so that half of it leaves
//! L ((1-t_m)/(1-t))^s, exactly, and at t = 1 nothing. The field slides along walls instead of pushing through them.

use arrayvec::ArrayVec;
use glam::Vec2;

use super::advect::Step;
use super::fade::ease;
use super::guidance::position;
use super::obstacles::{Route, State};
use crate::constraint::detour::Sight;
use crate::constraint::{Detour, Way};

/// How far from a wall the field leaves a photon, plane units: far above rounding, far below a cell.
const MARGIN: f32 = 1e-5;
/// Walls a photon slides along in one step.
const SLIDES: usize = 3;
/// Halvings in the search for the last place in sight: to 1/64 of a leg.
const HALVINGS: usize = 6;
/// Turns of the way in one step, besides its begin and end.
const TURNS: usize = 8;

/// What all photons share in one step.
pub(super) struct Walker<'a> {
    pub(super) step: &'a Step,
    pub(super) detour: &'a Detour,
}

/// A photon at the begin of a step.
pub(super) struct Photon {
    /// Where it is.
    pub(super) at: Vec2,
    /// Where it goes.
    pub(super) target: Vec2,
    /// One over the speed at which it leaves the field.
    pub(super) per_limit: f32,
}

/// How a photon gets through the step.
pub(super) enum Motion {
    /// By the cubic of its guidance.
    Curve([Vec2; 3]),
    /// Along a line to this point.
    Line(Vec2),
}

/// A place on the way through a step, and the way from there.
#[derive(Clone, Copy)]
struct Stop {
    at: Vec2,
    way: Way,
    /// Whether the field led here, and not the way.
    by_field: bool,
}

/// The places, the last at the end.
type Stops = ArrayVec<Stop, { TURNS + 4 }>;

impl Photon {
    /// Guidance straight to the target, Eq. (2).
    pub(super) fn guidance(&self, step: &Step) -> Vec2 {
        (self.target - self.at) / (1.0 - step.start) as f32
    }

    /// The step as without walls.
    pub(super) fn curve(&self, step: &Step) -> [Vec2; 3] {
        step.curve(self.target, self.guidance(step), self.per_limit)
    }

    /// Where that ends.
    pub(super) fn end_of(&self, step: &Step, curve: &[Vec2; 3]) -> Vec2 {
        let v = self.guidance(step) + (curve[0] + (curve[1] + curve[2]));
        position(self.target, v, step.end() as f32)
    }
}

impl Walker<'_> {
    /// Moves the photon through the step; `route` becomes its way from there.
    pub(super) fn step(&self, photon: &Photon, route: &mut Route, sight: &mut Sight) -> Motion {
        let motion = match route.state {
            State::Passes => Motion::Curve(photon.curve(self.step)),
            State::Waits => Motion::Line(self.slide(photon.at, self.drift(photon, photon.at, 0.0))),
            State::Follows => self.follow(photon, route, sight),
        };
        route.line = matches!(motion, Motion::Line(_));
        motion
    }

    /// The step of a photon that follows its way. What holds at its begin holds at its end: the photon sees where it is
    /// bound for, and has no more turns ahead than steps in which to take them, one in each. So a wall is never crossed:
    /// where nothing better is found the photon rests, or goes to the next turn at once.
    fn follow(&self, photon: &Photon, route: &mut Route, sight: &mut Sight) -> Motion {
        let (c, b) = (photon.at, photon.target);
        if route.way.is_straight()
            && let Some(motion) = self.smooth(photon, route, sight)
        {
            return motion;
        }
        if self.step.left == 0 {
            return Motion::Line(self.detour.heading(route.way, b));
        }
        if self.detour.corners_ahead(route.way) >= self.step.left {
            let corner = self.detour.heading(route.way, b);
            route.way = self.detour.after(route.way);
            return Motion::Line(corner);
        }
        for by_field in [true, false] {
            let (end, way) = self.split(photon, route.way, by_field, sight);
            if self.holds(c, end, way, b) {
                route.way = way;
                return Motion::Line(end);
            }
        }
        Motion::Line(c)
    }

    /// Whether a photon may go from `c` to `end` and on by `way`.
    fn holds(&self, c: Vec2, end: Vec2, way: Way, b: Vec2) -> bool {
        let barriers = self.detour.barriers();
        !barriers.blocks(c, end)
            && !barriers.blocks(end, self.detour.heading(way, b))
            && self.detour.corners_ahead(way) < self.step.left
    }

    /// The step as without walls, if no wall is met and the target is still in sight, or a way to it is found.
    fn smooth(&self, photon: &Photon, route: &mut Route, sight: &mut Sight) -> Option<Motion> {
        let (c, b) = (photon.at, photon.target);
        let curve = photon.curve(self.step);
        if !curve.iter().all(|k| k.is_finite()) {
            return Some(Motion::Curve(curve));
        }
        let end = photon.end_of(self.step, &curve);
        let barriers = self.detour.barriers();
        if barriers.blocks(c, end) {
            return None;
        }
        if barriers.blocks(end, b) {
            let way = self.detour.way(end, b, sight)?;
            if self.step.left == 0 || self.detour.corners_ahead(way) >= self.step.left {
                return None;
            }
            route.way = way;
        }
        // Between its ends the curve may bulge through a wall that the chord misses.
        let bulges = barriers.may_touch(c, end, 0.25 * c.distance(end));
        Some(if bulges { Motion::Line(end) } else { Motion::Curve(curve) })
    }

    /// Half the guidance, the field if it shall act, half the guidance; returns the end and the way from there.
    fn split(&self, photon: &Photon, way: Way, by_field: bool, sight: &mut Sight) -> (Vec2, Way) {
        let mut stops: Stops = ArrayVec::new();
        stops.push(Stop { at: photon.at, way, by_field: false });
        self.walk(photon, &mut stops, [0.0, 0.5]);
        if by_field {
            self.slide_on(photon, &mut stops, sight);
        }
        self.walk(photon, &mut stops, [0.5, 1.0]);
        self.farthest(photon.at, &stops)
    }

    /// The last place on the way through the step that is seen from its begin `c`: the chord must not cut a corner. Between
    /// two turns the place is searched for, or photons would gather at the turns.
    fn farthest(&self, c: Vec2, stops: &Stops) -> (Vec2, Way) {
        let barriers = self.detour.barriers();
        let last = stops.iter().rposition(|stop| !barriers.blocks(c, stop.at)).unwrap_or(0);
        let Stop { at, way, .. } = stops[last];
        // From a place that the field only passes through, no way may be known.
        let Some(next) = stops.get(last + 1).filter(|next| !next.by_field) else { return (at, way) };
        let (mut seen, mut hidden) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (seen + hidden);
            if barriers.blocks(c, at.lerp(next.at, middle)) { hidden = middle } else { seen = middle }
        }
        // On the leg after a turn the way is the one from that turn on.
        (at.lerp(next.at, seen), way)
    }

    /// Moves on by the field, if a way leads on from there.
    fn slide_on(&self, photon: &Photon, stops: &mut Stops, sight: &mut Sight) {
        let Some(&Stop { at: c, way, .. }) = stops.last() else { return };
        let length = self.detour.length(way, c, photon.target);
        let end = self.slide(c, self.drift(photon, c, length));
        if let Some(way) = self.detour.renewed(way, end, photon.target, sight) {
            let _ = stops.try_push(Stop { at: end, way, by_field: true });
        }
    }

    /// Walks along the way from the share `from` to the share `to` of the step.
    fn walk(&self, photon: &Photon, stops: &mut Stops, [from, to]: [f64; 2]) {
        let Some(&Stop { at: mut c, mut way, .. }) = stops.last() else { return };
        let b = photon.target;
        let length = self.detour.length(way, c, b);
        let (start, step) = (self.step.start, self.step.length);
        let guided = 1.0 - 0.5 * (self.share(photon, length, from) + self.share(photon, length, to));
        let left = ((1.0 - start - to * step).max(0.0) / (1.0 - start - from * step)).powf(f64::from(guided));
        let mut distance = length * (1.0 - left as f32);
        while distance > 0.0 {
            let heading = self.detour.heading(way, b);
            let leg = c.distance(heading);
            if distance < leg || way.is_straight() {
                c = if distance < leg { c + (heading - c) * (distance / leg) } else { b };
                let _ = stops.try_push(Stop { at: c, way, by_field: false });
                return;
            }
            (distance, c, way) = (distance - leg, heading, self.detour.after(way));
            if stops.len() >= TURNS || stops.try_push(Stop { at: c, way, by_field: false }).is_err() {
                return;
            }
        }
    }

    /// Share of the field, 1 - s, at the share `x` of the step (0, 1/2 or 1) for a photon with so long a way ahead.
    fn share(&self, photon: &Photon, length: f32, x: f64) -> f32 {
        let Some(stages) = &self.step.stages else { return 0.0 };
        let time_left = (1.0 - self.step.start - x * self.step.length) as f32;
        // At t = 1 the speed has no limit, and the fade none either.
        if time_left <= 0.0 {
            return 0.0;
        }
        stages[(2.0 * x) as usize].rate * time_left * ease(length / time_left * photon.per_limit)
    }

    /// What the field moves the photon by over the step, from `c`: the midpoint method.
    fn drift(&self, photon: &Photon, c: Vec2, length: f32) -> Vec2 {
        let Some([begin, middle, _]) = &self.step.stages else { return Vec2::ZERO };
        let h = self.step.length as f32 * self.share(photon, length, 0.5);
        let half = c + 0.5 * h * begin.velocity(c);
        let drift = h * middle.velocity(half);
        if drift.is_finite() { drift } else { Vec2::ZERO }
    }

    /// From `c` by `drift`, along the walls that are met instead of through them.
    fn slide(&self, mut c: Vec2, mut drift: Vec2) -> Vec2 {
        let barriers = self.detour.barriers();
        for _ in 0..SLIDES {
            let Some(contact) = barriers.first_contact(c, c + drift) else { return c + drift };
            let along = contact.segment.direction();
            let normal = along.perp();
            let side = if drift.dot(normal) > 0.0 { -normal } else { normal };
            let near = c + drift * contact.share + side * MARGIN;
            if barriers.blocks(c, near) {
                return c;
            }
            drift = along * (drift * (1.0 - contact.share)).dot(along);
            c = near;
        }
        c
    }
}
