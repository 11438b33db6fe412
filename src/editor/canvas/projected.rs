//! A view of the plane through a camera: the same tools and drawings, on whatever shows plane points.

use egui::{Pos2, Rect, Response, TextureId, Ui};
use glam::Vec2;

use super::ghosts;
use super::input::{self, ViewMove};
use super::overlay::Overlay;
use crate::editor::context::EditorContext;
use crate::editor::tools::{ToolContext, Toolbox};

/// How a view shows the plane.
pub struct ProjectedPlane<'a> {
    /// The picture on the screen.
    pub view: Rect,
    /// Where a plane point is seen; none where it is not.
    pub screen: &'a dyn Fn(Vec2) -> Option<Pos2>,
    /// The plane point that is seen at a place of the screen.
    pub plane: &'a dyn Fn(Pos2) -> Option<Vec2>,
    /// The picture of the target that follows the playhead, with its size in pixels.
    pub target: Option<(TextureId, Vec2)>,
}

/// Draws what was drawn over a view, lets the tool in hand work on it, and tells how the view shall be moved.
pub fn show_projected(
    ui: &Ui,
    response: &Response,
    editor: &mut EditorContext,
    toolbox: &mut Toolbox,
    projected: &ProjectedPlane,
) -> Vec<ViewMove> {
    let mut input = input::pointer(ui, response, toolbox.pointer_mode(), projected.plane);
    if response.has_focus() || response.hovered() {
        input.gestures.extend(input::keys(ui, response));
    }
    let project = editor.document.project().clone();
    let sketch = editor.preview.sketch().cloned();
    let photons = sketch.as_ref().and_then(|sketch| sketch.positions(editor.session.playhead));
    let context = ToolContext {
        project: &project,
        session: editor.session,
        extent: project.extent(),
        per_point: per_point(response, projected),
        held: input::held(ui),
        picture: projected.target.map(|(_, size)| size),
        photons: photons.unwrap_or_default(),
    };
    for gesture in input.gestures {
        editor.actions.extend(toolbox.gesture(gesture, &context));
    }
    let ghosts = ghosts(response, toolbox, &context);
    let painter = ui.painter_at(response.rect);
    let overlay = Overlay { painter: &painter, screen: projected.screen };
    overlay.all(&context, projected.target.map(|(texture, _)| texture), &editor.preview.flow(), &ghosts);
    input.moves
}

/// Plane units per point of the screen where the pointer is, or in the middle of the picture.
fn per_point(response: &Response, projected: &ProjectedPlane) -> f32 {
    let at = response.hover_pos().unwrap_or(projected.view.center());
    let near = |by: egui::Vec2| (projected.plane)(at + by);
    let step = near(egui::vec2(1.0, 0.0)).zip(near(egui::vec2(0.0, 1.0))).zip(near(egui::Vec2::ZERO));
    step.map_or(0.002, |((right, down), here)| right.distance(here).max(down.distance(here)))
}
