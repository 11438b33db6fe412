//! The plane view with its light.

use std::sync::Arc;

use egui::{Color32, Painter, Rect, Ui};
use glam::{Vec2, vec2};
use lightloom_core::render::{PlaneMaterial, ViewSettings};

use super::fit::{WHOLE, under};
use super::{Views, wipe};
use crate::editor::canvas::plane_transform::PlaneTransform;
use crate::editor::canvas::{self, Backdrop};
use crate::editor::context::EditorContext;
use crate::editor::preview::gpu::{Drawing, PhotonColumns};
use crate::editor::tools::Toolbox;

impl Views {
    /// Shows the plane view: light, overlays and active tool.
    pub(super) fn plane_view(&mut self, ui: &mut Ui, editor: &mut EditorContext, toolbox: &mut Toolbox) {
        let view = ui.available_rect_before_wrap();
        let project = editor.document.project().clone();
        let (extent, compare) = (project.extent(), editor.session.compare);
        let (photons_of_sides, paper) = (editor.preview.painted().photons, editor.preview.paper());
        let by_card = editor.preview.draws_photons() && !editor.session.overlays.false_colour;
        let pictures = &self.pictures;
        let light = |painter: &Painter, transform: &PlaneTransform| {
            let sides = wipe::sides(view, compare).into_iter().enumerate();
            for (side, clip) in sides.filter_map(|(side, clip)| Some((side, clip?))) {
                if let Some(columns) = photons_of_sides[side].as_ref().filter(|_| by_card) {
                    let drawing =
                        drawing(painter, clip, transform, (extent, paper), &project.render.view, columns);
                    painter.add(egui_wgpu::Callback::new_paint_callback(clip, drawing));
                } else if let Some(texture) = pictures.plane[side].texture() {
                    let painter = painter.with_clip_rect(clip.intersect(painter.clip_rect()));
                    painter.image(texture.id(), transform.rect(extent), WHOLE, Color32::WHITE);
                }
            }
        };
        let preview = editor.preview.preview().cloned();
        let photons = preview.as_ref().and_then(|preview| preview.positions(editor.session.playhead));
        let backdrop =
            Backdrop { light: Some(&light), target: pictures.target(), photons: photons.unwrap_or_default() };
        let response = canvas::show(ui, editor, toolbox, &backdrop);
        let transform = PlaneTransform::new(view, extent, &editor.session.plane);
        let image = editor.preview.painted().linear[0].clone().filter(|_| !by_card);
        if let Some((at, image)) = response.hover_pos().zip(image) {
            self.pixel = under(at, transform.rect(extent), &image);
        }
        if let Some(wipe) = &mut editor.session.compare {
            wipe::handle(ui, view, wipe);
        }
    }
}

/// The drawing of one side of the view by the graphics card.
fn drawing(
    painter: &Painter,
    clip: Rect,
    transform: &PlaneTransform,
    (extent, paper): (Vec2, PlaneMaterial),
    view: &ViewSettings,
    photons: &Arc<PhotonColumns>,
) -> Drawing {
    let pixels = painter.ctx().pixels_per_point();
    let corner = clip.min * pixels;
    let origin = transform.screen_from_plane(Vec2::ZERO) * pixels - corner;
    Drawing {
        photons: photons.clone(),
        corner: corner.into(),
        size: [clip.width() * pixels, clip.height() * pixels].map(|n| n.round().max(1.0) as u32),
        origin: vec2(origin.x, origin.y),
        scale: transform.scale() * pixels,
        extent,
        radiance: paper.radiance_per_watt(1.0),
        view: view.clone(),
    }
}
