//! The receiver seen flat: live light, what was drawn, the flow.

pub mod input;
pub mod overlay;
pub mod plane_transform;
mod projected;

use egui::{
    Color32, CursorIcon, Painter, Response, Role, Sense, Stroke, StrokeKind, TextureId, Ui, WidgetInfo,
};
use glam::Vec2;
use lightloom_core::constraint::Constraint;

use self::input::ViewMove;
use self::overlay::{Overlay, hovered};
use self::plane_transform::PlaneTransform;
pub use self::projected::{ProjectedPlane, show_projected};
use super::preview::FlowPicture;
use super::session::PlaneViewport;
use super::theme;
use super::tools::{Ghost, PointerMode, ToolContext, Toolbox};
use crate::editor::context::EditorContext;

/// Draws something where the plane stands on the screen.
pub type Light<'a> = &'a dyn Fn(&Painter, &PlaneTransform);

/// What the window shows backdrop the drawings, and knows of them.
#[derive(Clone, Copy, Default)]
pub struct Backdrop<'a> {
    /// Draws the light where the plane stands on the screen.
    pub light: Option<Light<'a>>,
    /// The picture of the target that follows the playhead, with its size in pixels.
    pub target: Option<(TextureId, Vec2)>,
    /// Where the photons are now, by row; empty while unknown.
    pub photons: &'a [Vec2],
}

/// Shows the plane and lets the tool in hand work on it.
pub fn show(ui: &mut Ui, editor: &mut EditorContext, toolbox: &mut Toolbox, backdrop: &Backdrop) -> Response {
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, ui.is_enabled(), "Plane"));
    for action in toolbox.take(editor.session.tool) {
        editor.ask(action);
    }
    let extent = editor.document.project().extent();
    let transform = PlaneTransform::new(rect, extent, &editor.session.plane);
    let plane = |p| Some(transform.plane_from_screen(p));
    let mut input = input::pointer(ui, &response, toolbox.pointer_mode(), &plane);
    input.gestures.extend(input::keys(ui, &response));
    editor.session.plane =
        moved(editor.session.plane, &input.moves, |viewport| PlaneTransform::new(rect, extent, viewport));
    let project = editor.document.project().clone();
    let context = ToolContext {
        project: &project,
        session: editor.session,
        extent,
        per_point: transform.scale().recip(),
        held: input::held(ui),
        picture: backdrop.target.map(|(_, size)| size),
        photons: backdrop.photons,
    };
    for gesture in input.gestures {
        editor.actions.extend(toolbox.gesture(gesture, &context));
    }
    let transform = PlaneTransform::new(rect, extent, &editor.session.plane);
    let ghosts = ghosts(&response, toolbox, &context);
    paint(&ui.painter_at(rect), &context, &transform, backdrop, &editor.preview.flow(), &ghosts);
    let space_held = ui.input(|input| input.key_down(egui::Key::Space)) && !ui.ctx().text_edit_focused();
    let cursor = match (input.dragging, space_held || toolbox.pointer_mode() == PointerMode::Pan) {
        (true, _) => CursorIcon::Grabbing,
        (false, true) => CursorIcon::Grab,
        (false, false) => toolbox.tool().cursor(),
    };
    let response = response.on_hover_and_drag_cursor(cursor);
    match hovered(&ghosts).and_then(|i| project.constraints.get(i)) {
        Some(constraint) => response.on_hover_text_at_pointer(described(constraint)),
        None => response,
    }
}

fn moved(
    viewport: PlaneViewport,
    moves: &[ViewMove],
    transform: impl Fn(&PlaneViewport) -> PlaneTransform,
) -> PlaneViewport {
    moves.iter().fold(viewport, |viewport, movement| match *movement {
        ViewMove::Pan(by) => transform(&viewport).panned(&viewport, by),
        ViewMove::Zoom(factor, about) => transform(&viewport).zoomed(&viewport, factor, about),
    })
}

/// What the tool shows; what belongs to the pointer only while that is over the plane.
fn ghosts(response: &Response, toolbox: &Toolbox, context: &ToolContext) -> Vec<Ghost> {
    let here = response.contains_pointer() || toolbox.tool().is_busy();
    let mut ghosts = toolbox.ghosts(context);
    ghosts.retain(|ghost| here || matches!(ghost, Ghost::Frame(..)));
    ghosts
}

/// What the tooltip says of a constraint.
fn described(constraint: &Constraint) -> String {
    let (kind, name, value) = match constraint {
        Constraint::DirectedLine(line) => ("Directed line", &line.name, format!("weight {}", line.weight)),
        Constraint::Wall(wall) => ("Wall", &wall.name, format!("thickness {:.4}", wall.thickness)),
    };
    let name = if name.is_empty() { String::new() } else { format!(" “{name}”") };
    let span =
        constraint.span().map_or_else(String::new, |span| format!(", frames {} to {}", span.from, span.to));
    let off = if constraint.is_enabled() { "" } else { ", switched off" };
    format!("{kind}{name}: {value}{span}{off}")
}

fn paint(
    painter: &Painter,
    context: &ToolContext,
    transform: &PlaneTransform,
    backdrop: &Backdrop,
    flow: &FlowPicture,
    ghosts: &[Ghost],
) {
    painter.rect_filled(painter.clip_rect(), 0.0, theme::SURROUND);
    let plane = transform.rect(context.extent);
    painter.rect_filled(plane, 0.0, Color32::BLACK);
    if let Some(light) = backdrop.light {
        light(painter, transform);
    }
    painter.rect_stroke(plane, 0.0, Stroke::new(1.0, Color32::from_gray(64)), StrokeKind::Outside);
    let screen = |p: Vec2| Some(transform.screen_from_plane(p));
    let overlay = Overlay { painter, screen: &screen };
    overlay.all(context, backdrop.target.map(|(texture, _)| texture), flow, ghosts);
    overlay::legends(painter, flow);
}
