//! Windows over the window: export, palette, shortcuts, preferences, examples, first steps.

use eframe::egui;
use egui::Key;

use super::App;
use crate::editor::action::Action;
use crate::editor::document::Edit;
use crate::editor::export::ExportWindow;
use crate::editor::palette::{self, Palette};
use crate::editor::panels::{Desk, PRESETS};
use crate::editor::preferences;
use crate::editor::shortcuts::Sheet;
use crate::editor::tour::{Anchors, Tour};
use crate::editor::welcome::Welcome;

/// The windows, and which of them are open.
#[derive(Default)]
pub(super) struct Windows {
    pub(super) export: ExportWindow,
    pub(super) palette: Palette,
    pub(super) shortcuts: Sheet,
    pub(super) preferences: bool,
    pub(super) welcome: Welcome,
    pub(super) tour: Tour,
    /// Where the things are that the first steps speak of.
    pub(super) anchors: Option<Anchors>,
}

impl App {
    /// Shows the windows that are open.
    pub(super) fn windows(
        &mut self,
        ctx: &egui::Context,
        tools: &[(&'static str, Key)],
        actions: &mut Vec<Action>,
    ) {
        let mut desk =
            Desk { document: &self.document, session: &mut self.session, preview: &self.preview, actions };
        let windows = &mut self.windows;
        windows.export.external = self.external;
        windows.export.show(ctx, &mut desk, &mut self.exports, &mut self.picker);
        let flow = &desk.document.project().flow;
        let presets = || -> Vec<_> {
            let preset = |preset: &crate::editor::panels::Preset| {
                (preset.name.to_owned(), Action::Edit(Edit::Flow(preset.apply(flow))))
            };
            PRESETS.iter().map(preset).collect()
        };
        let chosen = windows.palette.show(ctx, || palette::items(&desk, tools, &presets()));
        actions_from(desk.actions, chosen);
        windows.shortcuts.show(ctx, tools);
        preferences::show(ctx, &mut windows.preferences, &mut self.preferences);
        self.session.snapping = self.preferences.snapping;
        let chosen = windows.welcome.show(ctx, &self.recents.found());
        actions_from(actions, chosen);
        if let Some(anchors) = &windows.anchors
            && windows.tour.show(ctx, anchors, self.document.project(), &self.session)
        {
            self.preferences.first_start_seen = true;
        }
    }
}

fn actions_from(actions: &mut Vec<Action>, chosen: Option<Action>) {
    actions.extend(chosen);
}
