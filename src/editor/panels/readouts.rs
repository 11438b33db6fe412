//! Readouts: what the numbers say of the moment that is shown.

use egui::Ui;

use super::Desk;
use crate::editor::theme;

/// The panel of readouts.
pub(super) fn show(ui: &mut Ui, desk: &mut Desk) {
    if let Some(problem) = desk.preview.problem() {
        ui.colored_label(theme::BAD, problem);
    }
}
