//! The tool that moves, rotates and scales the target picture.

use egui::{CursorIcon, Key, Painter, Rect, Stroke};
use glam::Vec2;
use lightloom_core::targets::Placement;

use super::icon;
use super::snap::Snap;
use super::tool::{Gesture, Ghost, Tool, ToolContext, ToolInfo};
use crate::editor::action::Action;
use crate::editor::document::Edit;
use crate::editor::target_image::TargetImage;

/// Hit distance of a handle, screen points.
const HANDLE: f32 = 9.0;
/// Distance of the rotation handle from the picture, screen points.
const STALK: f32 = 28.0;
/// Snapping angle about multiples of 15 degrees, degrees.
const NEAR: f32 = 2.0;
/// Range of the width of a picture, plane units.
const WIDTH: [f32; 2] = [0.005, 10.0];

/// Corners of the target picture at the playhead: lower left, lower right, upper right, upper left.
pub fn target_corners(context: &ToolContext) -> Option<[Vec2; 4]> {
    Some(
        Frame::new(&TargetImage::at_playhead(context.project, context.session)?.image.placement, context)
            .corners(),
    )
}

/// The frame of a picture on the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Frame {
    centre: Vec2,
    /// Half of its width, as a vector.
    right: Vec2,
    /// Half of its height, as a vector.
    up: Vec2,
}

impl Frame {
    /// The frame of a placement; a picture of unknown size counts as a square.
    fn new(placement: &Placement, context: &ToolContext) -> Self {
        let size = context.picture.unwrap_or(Vec2::splat(100.0));
        let (centre, x, y) = placement.frame(size, context.extent);
        Self { centre, right: x * (0.5 * size.x), up: y * (0.5 * size.y) }
    }

    fn corners(&self) -> [Vec2; 4] {
        let Self { centre, right, up } = *self;
        [centre - right - up, centre + right - up, centre + right + up, centre - right + up]
    }

    fn stalk(&self, context: &ToolContext) -> Vec2 {
        self.centre + self.up + self.up.normalize_or(Vec2::Y) * context.points(STALK)
    }

    fn contains(&self, p: Vec2) -> bool {
        let off = p - self.centre;
        let inside = |axis: Vec2| off.dot(axis).abs() <= axis.length_squared();
        inside(self.right) && inside(self.up)
    }

    fn placement(&self) -> Placement {
        let width = 2.0 * self.right.length();
        let rotate = self.right.to_angle().to_degrees();
        let far = Vec2::splat(10.0);
        Placement {
            centre: Some(self.centre.clamp(-far, far).into()),
            width: Some(width.clamp(WIDTH[0], WIDTH[1])),
            rotate,
        }
    }
}

/// A handle of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Handle {
    Inside,
    Corner(usize),
    Turn,
}

/// The tool that places the target picture at the playhead.
#[derive(Default)]
pub(super) struct Place {
    /// The dragged handle, where it was grabbed, and the initial frame.
    taken: Option<(Handle, Vec2, Frame)>,
    over: Option<Handle>,
}

impl Place {
    fn handle(p: Vec2, frame: &Frame, context: &ToolContext) -> Option<Handle> {
        let near = |q: Vec2| p.distance(q) <= context.points(HANDLE);
        let corner = frame.corners().into_iter().position(near).map(Handle::Corner);
        let turn = near(frame.stalk(context)).then_some(Handle::Turn);
        corner.or(turn).or_else(|| frame.contains(p).then_some(Handle::Inside))
    }

    fn drag(&self, p: Vec2, context: &ToolContext) -> Option<Frame> {
        let (handle, from, frame) = self.taken?;
        Some(match handle {
            Handle::Inside => moved(frame, from, p, context),
            Handle::Corner(corner) => scaled(frame, corner, p, context),
            Handle::Turn => turned(frame, from, p, context),
        })
    }
}

fn moved(frame: Frame, from: Vec2, p: Vec2, context: &ToolContext) -> Frame {
    let middle = [context.extent / 2.0];
    let snap = Snap { from: Some(frame.centre), own: &middle, ..Snap::ALL };
    Frame { centre: snap.find(frame.centre + p - from, context).at, ..frame }
}

/// Scales about the opposite corner; with Alt about the centre.
fn scaled(frame: Frame, corner: usize, p: Vec2, context: &ToolContext) -> Frame {
    let corners = frame.corners();
    let fixed = if context.held.alt { frame.centre } else { corners[(corner + 2) % 4] };
    let diagonal = corners[corner] - fixed;
    let width = 2.0 * frame.right.length();
    let factor = (p - fixed).dot(diagonal) / diagonal.length_squared();
    if !factor.is_finite() || width <= 0.0 {
        return frame;
    }
    let factor = factor.clamp(WIDTH[0] / width, WIDTH[1] / width);
    let centre = fixed + (frame.centre - fixed) * factor;
    Frame { centre, right: frame.right * factor, up: frame.up * factor }
}

/// Rotates about the centre; snaps near multiples of 15 degrees, and to them only with Shift.
fn turned(frame: Frame, from: Vec2, p: Vec2, context: &ToolContext) -> Frame {
    let by = (p - frame.centre).to_angle() - (from - frame.centre).to_angle();
    let angle = (frame.right.to_angle() + by).to_degrees();
    let even = (angle / 15.0).round() * 15.0;
    let catches = context.session.snapping && !context.held.ctrl && (angle - even).abs() < NEAR;
    let angle = if catches || context.held.shift { even } else { angle };
    let turn = Vec2::from_angle(angle.to_radians());
    Frame { right: turn * frame.right.length(), up: turn.perp() * frame.up.length(), ..frame }
}

impl Tool for Place {
    fn info(&self) -> ToolInfo {
        ToolInfo {
            name: "Place target",
            key: Key::M,
            hint: "Drag the picture to move it, a corner to scale it (Alt: about the centre), the knob to rotate it; double click resets it",
        }
    }

    fn icon(&self, painter: &Painter, square: Rect, stroke: Stroke) {
        let lines: &[&[[f32; 2]]] = &[
            &[[0.2, 0.26], [0.2, 0.86], [0.8, 0.86], [0.8, 0.26], [0.17, 0.26]],
            &[[0.2, 0.74], [0.42, 0.5], [0.58, 0.66], [0.66, 0.58], [0.8, 0.72]],
            &[[0.5, 0.26], [0.5, 0.06]],
        ];
        icon::lines(painter, square, stroke, lines);
        painter.circle_filled(icon::at(square, [0.5, 0.06]), 0.09 * square.width(), stroke.color);
    }

    fn cursor(&self) -> CursorIcon {
        match self.taken.map(|(handle, ..)| handle).or(self.over) {
            Some(Handle::Inside) => CursorIcon::Move,
            Some(Handle::Corner(0 | 2)) => CursorIcon::ResizeNeSw,
            Some(Handle::Corner(_)) => CursorIcon::ResizeNwSe,
            Some(Handle::Turn) => CursorIcon::Alias,
            None => CursorIcon::Default,
        }
    }

    fn gesture(&mut self, gesture: Gesture, context: &ToolContext) -> Vec<Action> {
        let Some(target) = TargetImage::at_playhead(context.project, context.session) else {
            self.put_down();
            let here = matches!(gesture, Gesture::Press(_));
            let say = "The next key frame has no target picture to place".to_owned();
            return if here { vec![Action::Say(say)] } else { Vec::new() };
        };
        let frame = Frame::new(&target.image.placement, context);
        let ask = |placement: Placement| Action::from(Edit::Keys(target.placed(context.project, &placement)));
        match gesture {
            Gesture::Hover(p) => self.over = Self::handle(p, &frame, context),
            Gesture::Press(p) => {
                self.taken = Self::handle(p, &frame, context).map(|handle| (handle, p, frame));
            }
            Gesture::Drag(p) => {
                return self.drag(p, context).map(|f| ask(f.placement())).into_iter().collect();
            }
            Gesture::Release(_) if self.taken.take().is_some() => return vec![Action::Settle],
            Gesture::Key(Key::Escape) if self.taken.take().is_some() => return vec![Action::Abort],
            Gesture::DoubleClick(p) if frame.contains(p) => {
                return vec![ask(Placement::default()), Action::Settle];
            }
            Gesture::Key(key) => {
                let Some(step) = context.arrow(key) else { return Vec::new() };
                let frame = Frame { centre: frame.centre + step, ..frame };
                return vec![ask(frame.placement()), Action::Settle];
            }
            Gesture::Release(_) | Gesture::DoubleClick(_) => (),
        }
        Vec::new()
    }

    fn ghosts(&self, context: &ToolContext) -> Vec<Ghost> {
        let target = TargetImage::at_playhead(context.project, context.session);
        let frame = target.map(|target| Frame::new(&target.image.placement, context));
        frame.map(|frame| Ghost::Frame(frame.corners(), frame.stalk(context))).into_iter().collect()
    }

    fn put_down(&mut self) {
        *self = Self::default();
    }

    fn is_busy(&self) -> bool {
        self.taken.is_some()
    }
}
