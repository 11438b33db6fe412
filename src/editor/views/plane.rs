//! The plane with its light.

use std::sync::Arc;

use egui::{Color32, Painter, Rect, Ui, pos2};
use glam::{Vec2, vec2};
use lightloom_core::render::{PlaneMaterial, ViewSettings};

use super::{Views, wipe};
use crate::editor::canvas::space::Space;
use crate::editor::canvas::{self, Under};
use crate::editor::panels::Desk;
use crate::editor::preview::gpu::{Drawing, PhotonColumns};
use crate::editor::tools::Toolbox;

/// The whole of a texture.
pub(super) const WHOLE: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(1.0, 1.0) };

impl Views {
    /// The plane view: light, what was drawn, and the tool in hand.
    pub(super) fn plane_view(&self, ui: &mut Ui, desk: &mut Desk, toolbox: &mut Toolbox) {
        let view = ui.available_rect_before_wrap();
        let project = desk.document.project().clone();
        let (extent, compare) = (project.extent(), desk.session.compare);
        let (photons_of_sides, paper) = (desk.preview.painted().photons, desk.preview.paper());
        let by_card = desk.preview.draws_photons();
        let light = |painter: &Painter, space: &Space| {
            let sides = wipe::sides(view, compare).into_iter().enumerate();
            for (side, clip) in sides.filter_map(|(side, clip)| Some((side, clip?))) {
                if let Some(columns) = photons_of_sides[side].as_ref().filter(|_| by_card) {
                    let drawing =
                        drawing(painter, clip, space, (extent, paper), &project.render.view, columns);
                    painter.add(egui_wgpu::Callback::new_paint_callback(clip, drawing));
                } else if let Some(texture) = self.pictures.plane[side].texture() {
                    let painter = painter.with_clip_rect(clip.intersect(painter.clip_rect()));
                    painter.image(texture.id(), space.rect(extent), WHOLE, Color32::WHITE);
                }
            }
        };
        let preview = desk.preview.preview().cloned();
        let photons = preview.as_ref().and_then(|preview| preview.positions(desk.session.playhead));
        let under = Under {
            light: Some(&light),
            target: self.pictures.target(),
            photons: photons.unwrap_or_default(),
        };
        canvas::show(ui, desk, toolbox, &under);
        if let Some(wipe) = &mut desk.session.compare {
            wipe::handle(ui, view, wipe);
        }
    }
}

/// The photons of one side of the view, for the graphics card.
fn drawing(
    painter: &Painter,
    clip: Rect,
    space: &Space,
    (extent, paper): (Vec2, PlaneMaterial),
    view: &ViewSettings,
    photons: &Arc<PhotonColumns>,
) -> Drawing {
    let pixels = painter.ctx().pixels_per_point();
    let corner = clip.min * pixels;
    let origin = space.screen_from_plane(Vec2::ZERO) * pixels - corner;
    Drawing {
        photons: photons.clone(),
        corner: corner.into(),
        size: [clip.width() * pixels, clip.height() * pixels].map(|n| n.round().max(1.0) as u32),
        origin: vec2(origin.x, origin.y),
        scale: space.scale() * pixels,
        extent,
        radiance: paper.radiance_per_watt(1.0),
        view: view.clone(),
    }
}
