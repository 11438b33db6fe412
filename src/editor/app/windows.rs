//! Windows over the window: export, palette, shortcuts, preferences, examples, first steps.

use eframe::egui;
use egui::Key;

use super::App;
use crate::editor::action::Action;
use crate::editor::context::EditorContext;
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
        let mut editor = EditorContext {
            document: &self.document,
            session: &mut self.session,
            preview: &self.preview,
            actions,
        };
        let windows = &mut self.windows;
        windows.export.external = self.external;
        windows.export.show(ctx, &mut editor, &mut self.exports, &mut self.picker);
        let flow = &editor.document.project().flow;
        let presets = || -> Vec<_> {
            let preset = |preset: &crate::editor::panels::Preset| {
                (preset.name.to_owned(), Action::Edit(Edit::Flow(preset.apply(flow))))
            };
            PRESETS.iter().map(preset).collect()
        };
        let chosen = windows.palette.show(ctx, || palette::items(&editor, tools, &presets()));
        actions_from(editor.actions, chosen);
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
