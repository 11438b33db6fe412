//! The plane seen flat, as the plane view shows it.

use egui::{
    Color32, CursorIcon, Painter, Response, Role, Sense, Stroke, StrokeKind, TextureId, Ui, WidgetInfo,
};
use glam::Vec2;
use lightloom_core::constraint::Constraint;

use super::input::{self, ViewMove};
use super::interaction::{Surface, run_tool};
use super::overlay::{self, Overlay, hovered};
use super::plane_transform::PlaneTransform;
use crate::editor::context::EditorContext;
use crate::editor::preview::FlowPicture;
use crate::editor::session::PlaneViewport;
use crate::editor::theme;
use crate::editor::tools::{Ghost, PointerMode, ToolContext, Toolbox};

/// Paints the light of the plane.
pub type Light<'a> = &'a dyn Fn(&Painter, &PlaneTransform);

/// What is behind the overlays, and what is known of it.
#[derive(Clone, Copy, Default)]
pub struct Backdrop<'a> {
    /// Paints the light of the plane.
    pub light: Option<Light<'a>>,
    /// The target picture at the playhead, with its size in pixels.
    pub target: Option<(TextureId, Vec2)>,
    /// Photon positions at the playhead, by row; empty while unknown.
    pub photons: &'a [Vec2],
}

/// Shows the plane and passes gestures to the active tool.
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
    let transform = PlaneTransform::new(rect, extent, &editor.session.plane);
    let surface = Surface {
        per_point: transform.scale().recip(),
        picture: backdrop.target.map(|(_, size)| size),
        photons: backdrop.photons,
    };
    let tooltip =
        run_tool((ui, &response), editor, toolbox, input.gestures, &surface, |context, flow, ghosts| {
            paint(&ui.painter_at(rect), context, &transform, backdrop, flow, ghosts);
            hovered(ghosts).and_then(|i| context.project.constraints.get(i)).map(described)
        });
    let space_held = ui.input(|input| input.key_down(egui::Key::Space)) && !ui.ctx().text_edit_focused();
    let cursor = match (input.dragging, space_held || toolbox.pointer_mode() == PointerMode::Pan) {
        (true, _) => CursorIcon::Grabbing,
        (false, true) => CursorIcon::Grab,
        (false, false) => toolbox.tool().cursor(),
    };
    let response = response.on_hover_and_drag_cursor(cursor);
    match tooltip {
        Some(tooltip) => response.on_hover_text_at_pointer(tooltip),
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

/// The tooltip of a constraint.
fn described(constraint: &Constraint) -> String {
    let (kind, name, value) = match constraint {
        Constraint::DirectedLine(line) => ("Directed line", &line.name, format!("weight {}", line.weight)),
        Constraint::Wall(wall) => ("Wall", &wall.name, format!("thickness {:.4}", wall.thickness)),
    };
    let name = if name.is_empty() { String::new() } else { format!(" “{name}”") };
    let span =
        constraint.span().map_or_else(String::new, |span| format!(", frames {} to {}", span.from, span.to));
    let off = if constraint.is_enabled() { "" } else { ", disabled" };
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
    if context.session.overlays.false_colour {
        overlay::stops_legend(painter);
    }
}
