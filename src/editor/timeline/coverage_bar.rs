//! The coverage bar: the preview's state of each frame, after the cached playback of Maya.

use egui::{Color32, Rect, Response, Role, Sense, Ui, WidgetInfo, vec2};

use super::scale::Scale;
use crate::editor::context::EditorContext;
use crate::editor::preview::State;
use crate::editor::theme;

/// Height, points.
pub(super) const HEIGHT: f32 = 6.0;

/// All states with colour and description.
const STATES: [(State, &str); 6] = [
    (State::Missing, "not computed yet"),
    (State::Stale, "from before the last change"),
    (State::Draft, "a coarse draft"),
    (State::Preview, "at preview quality"),
    (State::Fine, "with many photons"),
    (State::Failed, "could not be computed"),
];

fn colour(state: State, ui: &Ui) -> Color32 {
    match state {
        State::Missing => ui.visuals().widgets.inactive.bg_fill,
        State::Stale => theme::WARN.gamma_multiply(0.75),
        State::Draft => theme::ACCENT.gamma_multiply(0.5),
        State::Preview => theme::ACCENT,
        State::Fine => theme::GOOD,
        State::Failed => theme::BAD,
    }
}

fn words(state: State) -> &'static str {
    STATES.iter().find(|(other, _)| *other == state).map_or("", |(_, words)| words)
}

/// Shows the bar.
pub(super) fn show(ui: &mut Ui, rect: Rect, scale: &Scale, editor: &EditorContext) -> Response {
    let response = ui.interact(rect.expand2(vec2(0.0, 1.0)), ui.scope_id().with("stripe"), Sense::hover());
    let coverage = editor.preview.coverage();
    let runs = coverage.runs();
    let done: i64 = runs.iter().filter(|(.., s)| *s >= State::Draft && *s < State::Failed).map(length).sum();
    let all: i64 = runs.iter().map(length).sum();
    let label = format!("{done} of {all} frames computed");
    response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &label));
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
    for (first, last, state) in runs {
        let x = scale.x(f64::from(first) - 0.5)..=scale.x(f64::from(last) + 0.5);
        painter.rect_filled(
            Rect::from_x_y_ranges(x, rect.shrink2(vec2(0.0, 1.0)).y_range()),
            0.0,
            colour(state, ui),
        );
    }
    let under = response.hover_pos().map(|at| scale.frame(at.x));
    response.on_hover_ui_at_pointer(|ui| {
        ui.strong(label);
        if let Some(frame) = under {
            ui.label(format!("Frame {frame}: {}", words(coverage.of(frame))));
        }
        for (state, words) in STATES {
            ui.horizontal(|ui| {
                let (square, _) = ui.allocate_exact_size(vec2(12.0, 12.0), Sense::hover());
                ui.painter().rect_filled(square, 2.0, colour(state, ui));
                ui.label(words);
            });
        }
    })
}

fn length((first, last, _): &(i32, i32, State)) -> i64 {
    i64::from(*last) - i64::from(*first) + 1
}
