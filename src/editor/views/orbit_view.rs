//! The orbit view: a camera that circles the scene.

use egui::{Color32, PointerButton, Role, Sense, Stroke, Ui, WidgetInfo, vec2};
use glam::Vec2;
use lightloom_core::render::{MarkerKind, SceneMarker};
use lightloom_core::scene::CameraDesc;

use super::Views;
use super::fit::WHOLE;
use crate::editor::context::EditorContext;
use crate::editor::session::Orbit;
use crate::editor::theme;

/// Maximum pixels along the longer side, for interactive speed.
const MOST: f32 = 640.0;
/// Wheel scroll that doubles the zoom, points.
const WHEEL: f32 = 240.0;

impl Views {
    /// Shows the orbit view and moves its camera by the pointer.
    pub(super) fn orbit_view(&mut self, ui: &mut Ui, editor: &mut EditorContext) {
        let view = ui.available_rect_before_wrap();
        let scene = editor.document.project().scene.as_ref();
        let shot = scene.map_or_else(CameraDesc::default, |scene| scene.camera.clone());
        let response = ui.allocate_rect(view, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, ui.is_enabled(), "Orbit view"));
        let mut orbit = editor.session.orbit.unwrap_or_else(|| Orbit::of(&shot));
        let (by, shift) = (response.drag_delta(), ui.input(|input| input.modifiers.shift));
        if response.dragged_by(PointerButton::Middle) || (shift && response.dragged()) {
            orbit = orbit.moved(Vec2::new(by.x, by.y), view.height(), shot.fov_deg);
        } else if response.dragged() {
            orbit = orbit.turned(Vec2::new(by.x, by.y));
        }
        if response.hovered() {
            let factor =
                ui.input(|input| input.zoom_delta() * (input.smooth_scroll_delta().y / WHEEL).exp2());
            orbit = orbit.zoomed(factor);
        }
        editor.session.orbit = Some(orbit);
        let pixels = view.size() * ui.pixels_per_point();
        let shrink = (MOST / pixels.max_elem()).min(1.0);
        let size = [pixels.x, pixels.y].map(|n| ((n * shrink).round() as u32).max(16));
        self.wanted.look = Some((orbit.camera(&shot), size));
        let painter = ui.painter_at(view);
        painter.rect_filled(view, 0.0, theme::SURROUND);
        if let Some(texture) = self.pictures.look.texture() {
            painter.image(texture.id(), view, WHOLE, Color32::WHITE);
            let scale = view.width() / texture.size()[0].max(1) as f32;
            for SceneMarker { kind, at } in editor.preview.look().marks {
                let at = view.min + vec2(at.x, at.y) * scale;
                let colour = match kind {
                    MarkerKind::Light(_) => theme::WARN,
                    MarkerKind::Camera => theme::ACCENT,
                };
                painter.circle(at, 5.0, colour.gamma_multiply(0.5), Stroke::new(1.5, colour));
            }
        }
        response.on_hover_text_at_pointer("Drag to orbit, Shift to pan, wheel to zoom");
    }
}
