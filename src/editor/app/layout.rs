//! What stands where in the window.

use eframe::egui;
use egui::{CentralPanel, Frame, Margin, Panel, Ui};

use super::App;
use crate::editor::action::Action;
use crate::editor::panels::Desk;
use crate::editor::theme;
use crate::editor::timeline::Timeline;
use crate::editor::tools::bar;

impl App {
    /// Shows everything; what is asked for comes into `actions`.
    pub(super) fn layout(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        let mut desk =
            Desk { document: &self.document, session: &mut self.session, preview: &self.preview, actions };
        let desk = &mut desk;
        Panel::bottom("status").exact_size(24.0).show(ui, |ui| status(ui, desk, &self.word));
        Panel::bottom("timeline")
            .resizable(true)
            .default_size(Timeline::height(desk))
            .show(ui, |ui| self.timeline.show(ui, desk));
        Panel::left("tools")
            .exact_size(bar::WIDTH)
            .resizable(false)
            .frame(Frame::side_top_panel(ui.style()).inner_margin(Margin::same(2)))
            .show(ui, |ui| bar::show(ui, desk, &self.toolbox));
        let surround = Frame::NONE.fill(theme::SURROUND);
        CentralPanel::default().frame(surround).show(ui, |ui| self.views.show(ui, desk, &mut self.toolbox));
    }
}

/// What goes on, and what is wrong.
fn status(ui: &mut Ui, desk: &mut Desk, word: &str) {
    ui.horizontal_centered(|ui| {
        let problem = desk.preview.problem();
        if let Some(problem) = problem {
            ui.colored_label(theme::BAD, problem);
        } else if word.is_empty() {
            ui.weak("Ready");
        } else {
            ui.label(word);
        }
    });
}
