//! The secondary windows: export, player, palette, shortcuts, preferences, examples, tour.

use eframe::egui;
use egui::Key;

use super::App;
use crate::editor::action::Action;
use crate::editor::document::Edit;
use crate::editor::palette;
use crate::editor::panels::PRESETS;
use crate::editor::preferences;

impl App {
    /// Shows the windows that are open.
    pub(super) fn windows(
        &mut self,
        ctx: &egui::Context,
        tools: &[(&'static str, Key)],
        actions: &mut Vec<Action>,
    ) {
        let mut editor = self.editor.context(actions);
        let windows = &mut self.windows;
        windows.export.access = self.files.access();
        windows.export.show(ctx, &mut editor, &mut self.exports, &mut self.picker);
        windows.player.show(ctx, &mut self.picker);
        let flow = &editor.document.project().flow;
        let presets = || -> Vec<_> {
            let preset = |preset: &crate::editor::panels::Preset| {
                (preset.name.to_owned(), Action::Edit(Edit::Flow(preset.apply(flow))))
            };
            PRESETS.iter().map(preset).collect()
        };
        let chosen = windows.palette.show(ctx, || palette::items(&editor, tools, &presets()));
        editor.actions.extend(chosen);
        windows.shortcuts.show(ctx, tools);
        let trusted = self.files.trusted.count();
        if preferences::show(ctx, &mut windows.preferences, &mut self.preferences, trusted) {
            self.files.forget_trusted();
        }
        self.editor.session.snapping = self.preferences.snapping;
        let chosen = windows.welcome.show(ctx, &self.recents.found());
        actions.extend(chosen);
        if let Some(anchors) = &windows.anchors
            && windows.tour.show(ctx, anchors, self.editor.document.project(), &self.editor.session)
        {
            self.preferences.first_start_seen = true;
        }
    }
}
