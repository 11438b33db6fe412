//! The handles of the selected object: an arrow along each axis moves it, a ring about each axis turns it.

use egui::{Painter, Pos2, Shape, Stroke};
use glam::{Quat, Vec3};

use super::axis::{self, AxisLock};
use super::object::SceneObject;
use super::transforming::TransformKind;
use super::viewpoint::Viewpoint;

/// Length of an arrow, points.
const ARROW: f32 = 78.0;
/// Length of its head, beyond that, points.
const HEAD: f32 = 11.0;
/// Where an arrow begins to be one, points from the middle.
const GAP: f32 = 14.0;
/// Radius of a ring, points.
const RING: f32 = 56.0;
/// Corners of a ring.
const CORNERS: usize = 64;
/// Reach of arrows and rings, points.
const REACH: f32 = 7.0;

/// A handle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Handle {
    /// What dragging it does.
    pub kind: TransformKind,
    /// Its axis.
    pub axis: usize,
}

impl Handle {
    /// The lock of a transform that it begins.
    pub fn lock(self) -> AxisLock {
        AxisLock::Axis(self.axis)
    }
}

/// The handles of one object.
pub struct Gizmo<'a> {
    view: &'a Viewpoint,
    pivot: Vec3,
    moves: bool,
    turns: bool,
}

impl<'a> Gizmo<'a> {
    /// The handles at the pivot of an object; `is_sun` of a light that stands nowhere, `turns` of what can be turned.
    pub fn new(view: &'a Viewpoint, object: SceneObject, pivot: Vec3, (is_sun, turns): (bool, bool)) -> Self {
        let target = matches!(object, SceneObject::LightTarget(_) | SceneObject::CameraTarget);
        Self { view, pivot, moves: !is_sun, turns: turns && !target }
    }

    /// An arrow on the screen, without its beginning; none where it points along the view.
    fn arrow(&self, axis: usize) -> Option<[Pos2; 2]> {
        let metre = self.view.metres_per_point(self.pivot);
        let at = |points: f32| self.view.screen(self.pivot + axis::unit(axis) * (points * metre));
        let line = [at(GAP)?, at(ARROW)?];
        (self.moves && line[0].distance(line[1]) > 8.0).then_some(line)
    }

    /// A ring on the screen: the half that faces the camera.
    fn ring(&self, axis: usize) -> Vec<Pos2> {
        if !self.turns {
            return Vec::new();
        }
        let normal = axis::unit(axis);
        let towards = (self.view.camera.position - self.pivot).normalize_or(Vec3::Z);
        let facing = normal.dot(towards).abs();
        // The middle of the half that faces the camera.
        let nearest = (towards - normal * normal.dot(towards)).normalize_or(normal.any_orthonormal_vector());
        let radius = RING * self.view.metres_per_point(self.pivot);
        let reach = if facing > 0.98 { std::f32::consts::PI } else { std::f32::consts::FRAC_PI_2 };
        let corner = |i: usize| {
            let angle = reach * (2.0 * i as f32 / CORNERS as f32 - 1.0);
            let offset = Quat::from_axis_angle(normal, angle) * nearest;
            self.view.screen(self.pivot + offset * radius)
        };
        (0..=CORNERS).filter_map(corner).collect()
    }

    /// The handle at a point of the screen; arrows win over rings.
    pub fn hit(&self, at: Pos2) -> Option<Handle> {
        // To the tip of its head, where one takes hold of an arrow.
        let arrow = |&axis: &usize| {
            self.arrow(axis).is_some_and(|[from, to]| distance(at, from, tip(from, to)) <= REACH)
        };
        let ring =
            |&axis: &usize| self.ring(axis).windows(2).any(|piece| distance(at, piece[0], piece[1]) <= REACH);
        let found = |kind, axis| Handle { kind, axis };
        (0..3)
            .find(arrow)
            .map(|axis| found(TransformKind::Move, axis))
            .or_else(|| (0..3).find(ring).map(|axis| found(TransformKind::Turn, axis)))
    }

    /// Draws the handles; the one under the pointer stands out.
    pub fn draw(&self, painter: &Painter, over: Option<Handle>) {
        for axis in 0..3 {
            let width = |kind| if over == Some(Handle { kind, axis }) { 4.0 } else { 2.2 };
            let stroke = |kind| Stroke::new(width(kind), axis::COLOURS[axis]);
            let mut thin = stroke(TransformKind::Turn);
            thin.color = thin.color.gamma_multiply(0.75);
            painter.add(Shape::line(self.ring(axis), thin));
            if let Some([from, to]) = self.arrow(axis) {
                painter.line_segment([from, to], stroke(TransformKind::Move));
                let along = (to - from).normalized();
                let across = along.rot90() * 4.5;
                let head = vec![tip(from, to), to + across, to - across];
                painter.add(Shape::convex_polygon(head, axis::COLOURS[axis], Stroke::NONE));
            }
        }
    }
}

/// The tip of the head of an arrow.
fn tip(from: Pos2, to: Pos2) -> Pos2 {
    to + (to - from).normalized() * HEAD
}

/// Distance of a point from a segment.
fn distance(at: Pos2, a: Pos2, b: Pos2) -> f32 {
    let along = b - a;
    let share = ((at - a).dot(along) / along.length_sq().max(1e-6)).clamp(0.0, 1.0);
    at.distance(a + along * share)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use egui::{Rect, pos2, vec2};
    use lightloom_core::scene::CameraDesc;

    use super::*;

    #[test]
    fn an_arrow_is_taken_hold_of_along_all_that_is_drawn_and_not_beyond() {
        let place = Rect::from_min_size(pos2(0.0, 0.0), vec2(800.0, 600.0));
        let camera = CameraDesc { position: [0.7, 1.2, 1.6], ..CameraDesc::default() };
        let view = Viewpoint::new(&camera, place).unwrap();
        let gizmo = Gizmo::new(&view, SceneObject::Mesh(0), Vec3::ZERO, (false, true));
        for axis in 0..3 {
            let [from, to] = gizmo.arrow(axis).unwrap();
            let tip = tip(from, to);
            let is_move = |at: Pos2| gizmo.hit(at) == Some(Handle { kind: TransformKind::Move, axis });
            assert!(is_move(to) && is_move(tip) && is_move(from + (to - from) * 0.8), "{axis}");
            assert!(!is_move(tip + (to - from).normalized() * (REACH + 1.0)), "{axis}");
        }
    }
}
