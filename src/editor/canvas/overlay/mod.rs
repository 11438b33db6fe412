//! Overlays of a view of the plane: constraints, flow, target, and the shapes of the active tool.

mod band;
mod colours;
mod flow;
mod frame;
mod ghosts;
mod handles;
mod heat;
mod legend;
mod line;
mod wall;
mod warnings;

pub use legend::{legends, stops_legend};

use egui::{Color32, Painter, Pos2, Shape, Stroke, TextureId};
use glam::Vec2;
use lightloom_core::constraint::Constraint;
use lightloom_core::project::Project;

use crate::editor::preview::FlowPicture;
use crate::editor::session::Session;
use crate::editor::tools::{Ghost, ToolContext, target_corners};

/// Opacity of constraints that are inactive at the playhead.
const DIM: f32 = 0.38;
/// Dash and gap of disabled constraints, points.
const DASHES: [f32; 2] = [7.0, 5.0];

/// Time between two frames while streamlines move.
const PACE: std::time::Duration = std::time::Duration::from_millis(33);

/// A painter in plane coordinates.
#[derive(Clone, Copy)]
pub struct Overlay<'a> {
    /// The painter.
    pub painter: &'a Painter,
    /// Screen position of a plane point; none where it is not visible.
    pub screen: &'a dyn Fn(Vec2) -> Option<Pos2>,
}

/// The drawing style of one constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ConstraintStyle {
    /// Disabled: drawn dashed.
    off: bool,
    /// Strength at the playhead, 0..=1: what does not act is dimmed.
    strength: f32,
    selected: bool,
    hovered: bool,
}

impl ConstraintStyle {
    const DRAWING: Self = Self { off: false, strength: 1.0, selected: false, hovered: false };

    fn of(constraint: &Constraint, index: usize, session: &Session, hovered: Option<usize>) -> Self {
        let frame = session.playhead;
        let strength = match (constraint.is_enabled(), constraint.span(), constraint) {
            (false, ..) => 0.0,
            (true, None, _) => 1.0,
            (true, Some(span), Constraint::DirectedLine(_)) => span.strength(frame) as f32,
            (true, Some(span), Constraint::Wall(_)) => f32::from(u8::from(span.contains(frame))),
        };
        Self {
            off: !constraint.is_enabled(),
            strength,
            selected: session.selection.contains(index),
            hovered: hovered == Some(index),
        }
    }

    fn tint(self, colour: Color32) -> Color32 {
        colour.gamma_multiply(DIM + (1.0 - DIM) * self.strength)
    }
}

impl Overlay<'_> {
    /// Draws all overlays in order: map, grid, target, flow, constraints, shapes of the active tool.
    pub fn all(
        &self,
        context: &ToolContext,
        target: Option<TextureId>,
        flow: &FlowPicture,
        ghosts: &[Ghost],
    ) {
        let (project, show) = (context.project, &context.session.overlays);
        if let Some(map) = &flow.map {
            self.heat(map, context.extent);
        }
        if show.grid {
            self.grid(project.flow.grid.cells(context.extent), context.extent);
        }
        if let Some((texture, corners)) =
            target.filter(|_| show.target && !context.session.playing).zip(target_corners(context))
        {
            self.target(texture, corners);
        }
        self.flow(flow, self.painter.ctx().input(|input| input.time));
        if show.drawn {
            self.drawn(project, context.session, hovered(ghosts));
        }
        if let Some(photon) = &flow.followed {
            self.followed(photon);
        }
        self.ghosts(ghosts);
        if show.drawn {
            self.warnings(context, ghosts);
        }
        if !flow.streamlines.is_empty() {
            self.painter.ctx().request_repaint_after(PACE);
        }
    }

    /// Draws all lines and walls; `hovered` is the index of the one under the pointer.
    pub(super) fn drawn(&self, project: &Project, session: &Session, hovered: Option<usize>) {
        let all = || project.constraints.iter().enumerate();
        let style = |i: usize, constraint: &Constraint| ConstraintStyle::of(constraint, i, session, hovered);
        for (i, constraint) in all() {
            let points = plane_points(constraint);
            match constraint {
                Constraint::Wall(wall) => self.wall(&points, wall.thickness, style(i, constraint)),
                Constraint::DirectedLine(line) => self.influence(&points, line.width, style(i, constraint)),
            }
        }
        // Lines above all walls and bands: they are thin.
        for (i, constraint) in all() {
            if let Constraint::DirectedLine(_) = constraint {
                self.line(&plane_points(constraint), style(i, constraint));
            }
        }
        for (i, constraint) in
            all().filter(|(i, constraint)| session.selection.contains(*i) && !constraint.is_locked())
        {
            self.handles(&plane_points(constraint), i, &session.selection);
        }
    }

    /// The visible parts of a polyline.
    fn seen(&self, points: &[Vec2]) -> Vec<Vec<Pos2>> {
        let mut pieces = vec![Vec::new()];
        for place in points.iter().map(|&p| (self.screen)(p)) {
            match (place, pieces.last_mut()) {
                (Some(place), Some(piece)) => piece.push(place),
                _ => pieces.push(Vec::new()),
            }
        }
        pieces.retain(|piece: &Vec<Pos2>| piece.len() > 1);
        pieces
    }

    fn polyline(&self, points: &[Vec2], stroke: Stroke, dashed: bool) {
        for piece in self.seen(points) {
            if dashed {
                self.painter.extend(Shape::dashed_line(&piece, stroke, DASHES[0], DASHES[1]));
            } else {
                self.painter.line(piece, stroke);
            }
        }
    }

    /// Screen points per plane unit at a plane point; none where it is not visible.
    fn scale(&self, at: Vec2) -> Option<f32> {
        const STEP: f32 = 1e-3;
        let side = |offset: Vec2| Some((self.screen)(at + offset)?.distance((self.screen)(at)?) / STEP);
        Some(0.5 * (side(Vec2::new(STEP, 0.0))? + side(Vec2::new(0.0, STEP))?))
    }
}

/// Index of the constraint under the pointer.
pub(super) fn hovered(ghosts: &[Ghost]) -> Option<usize> {
    ghosts
        .iter()
        .find_map(|ghost| if let Ghost::Hover(constraint) = ghost { Some(*constraint) } else { None })
}

fn plane_points(constraint: &Constraint) -> Vec<Vec2> {
    lightloom_core::constraint::stroke::clean(constraint.points())
}
