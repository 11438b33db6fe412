//! The transform in progress in the orbit view: its input, and the words below.

use egui::{Align2, Area, Color32, CursorIcon, FontId, Id, Order, Rect, Sense, Ui};
use lightloom_core::scene::SceneDesc;

use crate::editor::action::Action;
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;
use crate::editor::look::transforming::{End, Transforming};
use crate::editor::look::viewpoint::Viewpoint;
use crate::editor::panels::lamp_words;

/// Room for words in the corner of the view, points.
const CORNER: egui::Vec2 = egui::vec2(12.0, 10.0);

/// Passes pointer and keys to the transform, and shows the scene as it is so far.
pub(super) fn drive(ui: &Ui, editor: &mut EditorContext, scene: &SceneDesc, shown: &Viewpoint) {
    let Some(mut transforming) = editor.session.transforming.take() else { return };
    ui.ctx().set_cursor_icon(CursorIcon::Move);
    if !transforming.by_handle {
        cover(ui);
    }
    let end = input(ui, &mut transforming, shown);
    match end {
        Some(End::Cancelled) => {
            editor.ask(Action::Abort);
            ui.ctx().request_repaint();
            return;
        }
        Some(End::Confirmed) | None => {
            if let Ok(changed) = transforming.scene()
                && changed != *scene
            {
                editor.ask(Edit::Scene(Some(Box::new(changed))));
                ui.ctx().request_repaint();
            }
        }
    }
    if end.is_some() {
        editor.ask(Action::Settle);
        editor.ask(Action::Say(transforming.words().replace('|', "")));
    } else {
        editor.session.transforming = Some(transforming);
    }
}

/// Keeps the pointer from everything below: the click that confirms presses no button.
fn cover(ui: &Ui) {
    let all = ui.ctx().content_rect();
    Area::new(Id::unique("transform")).order(Order::Foreground).fixed_pos(all.min).show(ui.ctx(), |ui| {
        ui.allocate_rect(all, Sense::click_and_drag());
    });
}

fn input(ui: &Ui, transforming: &mut Transforming, shown: &Viewpoint) -> Option<End> {
    let end = ui.input(|input| transforming.take(&input.events));
    let (primary, released, secondary) = ui.input(|input| {
        let pointer = &input.pointer;
        (
            pointer.primary_pressed(),
            pointer.primary_released() || !pointer.any_down(),
            pointer.secondary_pressed(),
        )
    });
    if let Some(at) = ui.input(|input| input.pointer.latest_pos()) {
        transforming.point(shown, at);
    }
    let clicked = if transforming.by_handle { released } else { primary };
    if secondary { Some(End::Cancelled) } else { end.or(clicked.then_some(End::Confirmed)) }
}

/// The words below the view: the transform in progress, what the selected lamp does, or what the pointer does.
pub(super) fn words(ui: &Ui, view: Rect, editor: &EditorContext, through: bool) {
    let lamp = || lamp_words(editor).map(|(name, words)| format!("{name}: {words}"));
    let (strong, line) = match &editor.session.transforming {
        Some(transforming) => {
            let reason = transforming.scene().err().map_or_else(String::new, |reason| format!(" ({reason})"));
            let help = "X Y Z lock · digits · Enter or click confirms · Escape or right click cancels";
            (Some(format!("{}{reason}", transforming.words())), help)
        }
        None if through => (
            lamp(),
            "Through the camera: drag orbits it, Shift pans, wheel dollies · 0 looks freely · click selects",
        ),
        None => (
            lamp(),
            "Click selects · drag orbits, Shift pans, wheel zooms · G R S move, turn, scale · 0 through the camera",
        ),
    };
    let at = view.left_bottom() + egui::vec2(CORNER.x, -CORNER.y);
    text(ui, view, at, line, Color32::from_gray(165), 11.5);
    if let Some(strong) = strong {
        text(ui, view, at - egui::vec2(0.0, 18.0), &strong, Color32::WHITE, 14.0);
    }
}

fn text(ui: &Ui, view: Rect, at: egui::Pos2, words: &str, colour: Color32, size: f32) {
    let painter = ui.painter_at(view);
    let galley = painter.layout_no_wrap(words.to_owned(), FontId::proportional(size), colour);
    let place = Align2::LEFT_BOTTOM.anchor_size(at, galley.size());
    painter.rect_filled(place.expand2(egui::vec2(5.0, 1.0)), 3.0, Color32::from_black_alpha(170));
    painter.galley(place.min, galley, colour);
}
