//! The plane seen through a camera: the same tools and overlays, under any projection.

use egui::{Pos2, Rect, Response, TextureId, Ui};
use glam::Vec2;

use super::input::{self, ViewMove};
use super::interaction::{Surface, run_tool};
use super::overlay::Overlay;
use crate::editor::context::EditorContext;
use crate::editor::tools::Toolbox;

/// A projection of the plane to the screen.
pub struct ProjectedPlane<'a> {
    /// The picture on the screen.
    pub view: Rect,
    /// Screen position of a plane point; none where it is not visible.
    pub screen: &'a dyn Fn(Vec2) -> Option<Pos2>,
    /// Plane point at a screen position.
    pub plane: &'a dyn Fn(Pos2) -> Option<Vec2>,
    /// The target picture at the playhead, with its size in pixels.
    pub target: Option<(TextureId, Vec2)>,
}

/// Draws the overlays over a projected view, passes gestures to the active tool, and returns the moves of the view.
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
    let preview = editor.preview.preview().cloned();
    let photons = preview.as_ref().and_then(|preview| preview.positions(editor.session.playhead));
    let surface = Surface {
        per_point: per_point(response, projected),
        picture: projected.target.map(|(_, size)| size),
        photons: photons.unwrap_or_default(),
    };
    let painter = ui.painter_at(response.rect);
    let overlay = Overlay { painter: &painter, screen: projected.screen };
    run_tool((ui, response), editor, toolbox, input.gestures, &surface, |context, flow, ghosts| {
        overlay.all(context, projected.target.map(|(texture, _)| texture), flow, ghosts);
    });
    input.moves
}

/// Plane units per screen point at the pointer, or at the centre of the picture.
fn per_point(response: &Response, projected: &ProjectedPlane) -> f32 {
    let at = response.hover_pos().unwrap_or(projected.view.center());
    let near = |by: egui::Vec2| (projected.plane)(at + by);
    let step = near(egui::vec2(1.0, 0.0)).zip(near(egui::vec2(0.0, 1.0))).zip(near(egui::Vec2::ZERO));
    step.map_or(0.002, |((right, down), here)| right.distance(here).max(down.distance(here)))
}
