//! The toolbar beside the plane view.

use egui::{CornerRadius, Rect, Role, Sense, Stroke, Ui, Vec2, WidgetInfo};

use super::tool::Tool;
use super::toolbox::Toolbox;
use crate::editor::action::Action;
use crate::editor::context::EditorContext;
use crate::editor::theme;

/// Side of a button, points.
const BUTTON: f32 = 34.0;
/// Side of its icon, points.
const ICON: f32 = 18.0;
/// Tools that are followed by a gap: selection, drawing, viewing.
const GAPS: [usize; 2] = [0, 5];

/// Width of the toolbar, points.
pub const WIDTH: f32 = BUTTON + 8.0;

/// Shows the tools as a column, and asks for the clicked one. Returns the rectangles of the first two drawing tools.
pub fn show(ui: &mut Ui, editor: &mut EditorContext, toolbox: &Toolbox) -> [Rect; 2] {
    let (mut wanted, mut places) = (None, Vec::new());
    ui.spacing_mut().item_spacing.y = 2.0;
    ui.vertical_centered(|ui| {
        ui.add_space(4.0);
        for (i, tool) in toolbox.tools().enumerate() {
            let (place, clicked) = button(ui, tool, editor.session.tool == i);
            places.push(place);
            if clicked {
                wanted = Some(i);
            }
            if GAPS.contains(&i) {
                ui.add_space(8.0);
            }
        }
    });
    if let Some(tool) = wanted {
        editor.ask(Action::Tool(tool));
    }
    [1, 2].map(|i| places.get(i).copied().unwrap_or(Rect::NOTHING))
}

fn button(ui: &mut Ui, tool: &dyn Tool, active: bool) -> (Rect, bool) {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(BUTTON), Sense::click());
    let info = tool.info();
    response.widget_info(|| WidgetInfo::selected(Role::RadioButton, ui.is_enabled(), active, info.name));
    let visuals = ui.visuals();
    let (fill, colour) = if active {
        (theme::ACCENT, egui::Color32::WHITE)
    } else if response.hovered() || response.has_focus() {
        (visuals.widgets.hovered.bg_fill, visuals.widgets.hovered.fg_stroke.color)
    } else {
        (egui::Color32::TRANSPARENT, visuals.widgets.inactive.fg_stroke.color)
    };
    let painter = ui.painter();
    painter.rect_filled(rect, CornerRadius::same(6), fill);
    let square = Rect::from_center_size(rect.center(), Vec2::splat(ICON));
    tool.icon(painter, square, Stroke::new(2.0, colour));
    let clicked = response.clicked();
    response.on_hover_ui(|ui| {
        ui.horizontal(|ui| {
            ui.strong(info.name);
            ui.weak(info.key.name());
        });
        ui.set_max_width(260.0);
        ui.label(info.hint);
    });
    (rect, clicked)
}
