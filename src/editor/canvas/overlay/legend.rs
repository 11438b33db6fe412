//! The legends of maps and arrows.

use egui::{Align2, Color32, CornerRadius, FontId, Mesh, Painter, Pos2, Rect, Shape, pos2, vec2};

use super::colours;
use crate::editor::preview::FlowPicture;
use crate::editor::preview::false_colour::{STOPS, of_share};
use crate::editor::session::FieldMap;

/// Width and height of a legend's bar, points.
const BAR: [f32; 2] = [150.0, 8.0];
/// Number of colour steps.
const STEPS: usize = 48;
/// Size of a legend, and its margin, points.
const BOX: [f32; 2] = [176.0, 50.0];
const MARGIN: f32 = 12.0;

/// Draws the legend of false colours in the lower right corner of a view.
pub fn stops_legend(painter: &Painter) {
    let corner = painter.clip_rect().right_bottom() + vec2(-MARGIN - BOX[0], -MARGIN);
    legend(painter, corner, "Stops around middle grey", [-STOPS, STOPS], of_share);
}

/// Draws the legends of the flow overlays in the lower left corner of a view.
pub fn legends(painter: &Painter, flow: &FlowPicture) {
    let mut corner = painter.clip_rect().left_bottom() + vec2(MARGIN, -MARGIN);
    if let Some(map) = flow.map.as_ref().filter(|map| map.most > 0.0) {
        let (title, lowest) = match map.of {
            FieldMap::Divergence => ("Divergence, per segment", -1.0),
            FieldMap::Curl => ("Curl, per segment", -1.0),
            FieldMap::Residual => ("Residual, plane units per segment", 0.0),
            FieldMap::Tears => ("Cracked open (-1), torn off (1)", -1.0),
        };
        legend(painter, corner, title, [lowest * map.most, map.most], |share| {
            colours::of_map(map.of, lowest + (1.0 - lowest) * share)
        });
        corner.y -= BOX[1] + 6.0;
    }
    if flow.fast > 0.0 && !flow.arrows.is_empty() {
        legend(painter, corner, "Speed, plane units per segment", [0.0, flow.fast], colours::speed);
    }
}

fn legend(painter: &Painter, corner: Pos2, title: &str, ends: [f32; 2], colour: impl Fn(f32) -> Color32) {
    let frame = Rect::from_min_size(corner - vec2(0.0, BOX[1]), BOX.into());
    painter.rect_filled(frame, CornerRadius::same(5), Color32::from_black_alpha(190));
    let font = FontId::proportional(10.5);
    let (light, dim) = (Color32::from_gray(225), Color32::from_gray(170));
    painter.text(frame.min + vec2(13.0, 6.0), Align2::LEFT_TOP, title, font.clone(), light);
    let bar = Rect::from_min_size(frame.min + vec2(13.0, 22.0), BAR.into());
    let mut mesh = Mesh::default();
    for i in 0..=STEPS {
        let x = bar.left() + bar.width() * i as f32 / STEPS as f32;
        for y in [bar.top(), bar.bottom()] {
            mesh.colored_vertex(pos2(x, y), colour(i as f32 / STEPS as f32));
        }
        if let Some(at) = (2 * i as u32).checked_sub(2) {
            mesh.add_triangle(at, at + 1, at + 2);
            mesh.add_triangle(at + 1, at + 3, at + 2);
        }
    }
    painter.add(Shape::mesh(mesh));
    let anchors = [(bar.left_bottom(), Align2::LEFT_TOP), (bar.right_bottom(), Align2::RIGHT_TOP)];
    for ((at, anchor), value) in anchors.into_iter().zip(ends) {
        painter.text(at + vec2(0.0, 3.0), anchor, number(value), font.clone(), dim);
    }
    if ends[0] < 0.0 {
        painter.text(bar.center_bottom() + vec2(0.0, 3.0), Align2::CENTER_TOP, "0", font, dim);
    }
}

/// A number with two or three digits.
fn number(value: f32) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if size >= 100.0 => format!("{value:.0}"),
        size if size >= 1.0 => format!("{value:.1}"),
        size if size >= 0.01 => format!("{value:.3}"),
        _ => format!("{value:.1e}"),
    }
}
