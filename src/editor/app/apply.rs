//! Carries out what panels and tools asked for.

use eframe::egui;

use super::App;
use super::file_state::Leave;
use crate::editor::action::Action;
use crate::editor::document::Edit;
use crate::editor::selection::Selection;

impl App {
    /// Carries out one action. An edit that cannot be is refused with its reason in the status bar.
    pub(super) fn apply(&mut self, ctx: &egui::Context, action: Action) {
        match action {
            Action::Edit(edit) => self.edit(edit),
            Action::Settle => self.document.settle(),
            Action::Abort => self.document.abort(),
            Action::Command(command) => self.command(ctx, command),
            Action::Tool(tool) => self.session.tool = tool,
            Action::Select(selection) => self.session.selection = selection,
            Action::Playhead(frame) => self.session.playhead = frame,
            Action::Solo(groups) => self.session.solo = groups,
            Action::Probe(row) => self.session.probe = row,
            Action::Panel(panel) => self.session.panel = panel,
            Action::Paste(text) => self.paste(&text),
            Action::Open(path) => self.leave(ctx, Leave::Open(path)),
            Action::New(template) => self.leave(ctx, Leave::New(template)),
            Action::PickFile(pick) => self.pick_file(ctx, pick),
            Action::Say(words) => self.status = words,
        }
        self.keep_selection();
    }

    pub(super) fn edit(&mut self, edit: Edit) {
        let removed = matches!(edit, Edit::Remove(_));
        match self.document.edit(edit) {
            Ok(()) if removed => self.session.selection = Selection::default(),
            Ok(()) => self.status.clear(),
            Err(error) => self.status = error.to_string(),
        }
    }

    /// What is selected exists.
    fn keep_selection(&mut self) {
        let points = self.document.project().constraints.iter().map(|c| c.points().len());
        self.session.selection.keep_within(&points.collect::<Vec<_>>());
    }
}
