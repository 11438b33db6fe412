//! The plane with its light.

use std::sync::Arc;

use egui::{Color32, Painter, Rect, Ui, pos2};
use glam::vec2;
use lightloom_core::render::Paper;

use super::{Views, wipe};
use crate::editor::canvas::space::Space;
use crate::editor::canvas::{self, Under};
use crate::editor::panels::Desk;
use crate::editor::preview::gpu::{Drawing, Swarm};
use crate::editor::tools::Toolbox;

/// The whole of a texture.
const WHOLE: Rect = Rect { min: pos2(0.0, 0.0), max: pos2(1.0, 1.0) };

impl Views {
    /// The plane view: light, what was drawn, and the tool in hand.
    pub(super) fn plane_view(&self, ui: &mut Ui, desk: &mut Desk, toolbox: &mut Toolbox) {
        let view = ui.available_rect_before_wrap();
        let compare = desk.session.compare;
        let extent = desk.document.project().extent();
        let swarms = desk.preview.painted().swarm.clone();
        let drawing = |swarm: &Arc<Swarm>, space: &Space, painter: &Painter| {
            self.drawing(swarm, space, painter, view, desk_view(desk))
        };
        let light = |painter: &Painter, space: &Space| {
            for (side, clip) in wipe::sides(view, compare).into_iter().enumerate() {
                let Some(clip) = clip else { continue };
                let painter = painter.with_clip_rect(clip.intersect(painter.clip_rect()));
                if let Some(swarm) = &swarms[side] {
                    painter.add(egui_wgpu::Callback::new_paint_callback(clip, drawing(swarm, space, &painter)));
                } else if let Some(texture) = self.pictures.plane[side].texture() {
                    painter.image(texture.id(), space.rect(extent), WHOLE, Color32::WHITE);
                }
            }
        };
        let sketch = desk.preview.sketch().cloned();
        let photons = sketch.as_ref().and_then(|sketch| sketch.positions(desk.session.playhead));
        let _ = (light, photons, vec2(0.0, 0.0), Paper::WHITE, toolbox, Under::default(), canvas::extent(desk.document.project()));
    }
}
