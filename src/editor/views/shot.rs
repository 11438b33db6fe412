//! The shot view, through the project's camera. Strokes drawn here fall on the plane.

use egui::{Color32, Pos2, Rect, Role, Sense, Ui, WidgetInfo, vec2};
use glam::Vec2;
use lightloom_core::render::PlaneView;

use super::fit::{WHOLE, fitted, under};
use super::{Views, wipe};
use crate::editor::canvas::input::ViewMove;
use crate::editor::canvas::{self, ProjectedPlane, overlay};
use crate::editor::context::EditorContext;
use crate::editor::session::{ShotViewport, ZOOM_RANGE};
use crate::editor::theme;
use crate::editor::tools::Toolbox;

/// Rectangle of the picture after pan and zoom.
fn frame(fitted: Rect, viewport: ShotViewport) -> Rect {
    let middle = fitted.center() + viewport.offset.into();
    Rect::from_center_size(middle, fitted.size() * viewport.zoom)
}

/// The viewport after a move of the view.
fn moved(viewport: ShotViewport, movement: &ViewMove, fitted: Rect) -> ShotViewport {
    let offset = egui::Vec2::from(viewport.offset);
    match *movement {
        ViewMove::Pan(by) => ShotViewport { offset: (offset + by).into(), ..viewport },
        ViewMove::Zoom(factor, about) => {
            let zoom = (viewport.zoom * factor).clamp(*ZOOM_RANGE.start(), *ZOOM_RANGE.end());
            let from_middle = about - fitted.center();
            let offset = from_middle + (offset - from_middle) * (zoom / viewport.zoom);
            ShotViewport { zoom, offset: offset.into() }
        }
    }
}

impl Views {
    /// Shows the shot view: picture with caustics, overlays and active tool.
    pub(super) fn shot_view(&mut self, ui: &mut Ui, editor: &mut EditorContext, toolbox: &mut Toolbox) {
        let view = ui.available_rect_before_wrap();
        let project = editor.document.project().clone();
        let fitted = fitted(view, &project);
        let frame = frame(fitted, editor.session.shot);
        let response = ui.allocate_rect(view, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, ui.is_enabled(), "Shot"));
        let painter = ui.painter_at(view);
        painter.rect_filled(view, 0.0, theme::SURROUND);
        painter.rect_filled(frame, 0.0, Color32::BLACK);
        let sides = wipe::sides(view, editor.session.compare).into_iter().enumerate();
        for (side, clip) in sides.filter_map(|(side, clip)| Some((side, clip?))) {
            if let Some(texture) = self.pictures.shot[side].texture() {
                painter.with_clip_rect(clip).image(texture.id(), frame, WHOLE, Color32::WHITE);
            }
        }
        if editor.session.overlays.false_colour {
            overlay::stops_legend(&painter);
        }
        if let Ok(plane) = PlaneView::of_desc(project.scene.as_ref(), project.extent()) {
            let size = [project.render.width as usize, project.render.height as usize];
            let scale = frame.width() / size[0].max(1) as f32;
            let screen = |p: Vec2| {
                let pixel = plane.pixel_from_plane(p, size)?;
                Some(frame.min + vec2(pixel.x, pixel.y) * scale)
            };
            let from_screen = |p: Pos2| {
                let pixel = (p - frame.min) / scale;
                plane.plane_from_pixel(Vec2::new(pixel.x, pixel.y), size)
            };
            let projected = ProjectedPlane {
                view: frame,
                screen: &screen,
                plane: &from_screen,
                target: self.pictures.target(),
            };
            let moves = canvas::show_projected(ui, &response, editor, toolbox, &projected);
            editor.session.shot =
                moves.iter().fold(editor.session.shot, |viewport, by| moved(viewport, by, fitted));
        }
        if let Some((at, image)) = response.hover_pos().zip(editor.preview.painted().linear[1].clone()) {
            self.pixel = under(at, frame, &image);
        }
        if let Some(wipe) = &mut editor.session.compare {
            wipe::handle(ui, view, wipe);
        }
    }
}
