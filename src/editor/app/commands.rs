//! Carries out commands.

use eframe::egui;

use super::App;
use crate::editor::action::Action;
use crate::editor::command::{COMMANDS, Command};
use crate::editor::panels::Desk;
use crate::editor::session::Views;
use crate::editor::timeline;
use crate::editor::tools::arrange::{self, Arranged};

impl App {
    /// Turns keys into commands.
    pub(super) fn keys(&mut self, ctx: &egui::Context, actions: &mut Vec<Action>) {
        if ctx.egui_wants_keyboard_input() {
            return;
        }
        for entry in COMMANDS {
            if let Some(shortcut) = &entry.shortcut
                && ctx.input_mut(|input| input.consume_shortcut(shortcut))
            {
                actions.push(entry.command.into());
            }
        }
    }

    /// Carries out a command.
    pub(super) fn command(&mut self, ctx: &egui::Context, command: Command) {
        let mut actions = Vec::new();
        let mut desk = Desk {
            document: &self.document,
            session: &mut self.session,
            preview: &self.preview,
            actions: &mut actions,
        };
        let done = timeline::carry_out(command, &mut desk);
        for action in actions {
            self.apply(ctx, action);
        }
        if !done {
            self.other_command(ctx, command);
        }
    }

    fn other_command(&mut self, ctx: &egui::Context, command: Command) {
        let (project, selection) = (self.document.project().clone(), self.session.selection.clone());
        match command {
            Command::Undo => self.document.undo(),
            Command::Redo => self.document.redo(),
            Command::Delete => self.arrange(arrange::delete(&project, &selection)),
            Command::Reverse => self.arrange(arrange::reverse(&project, &selection)),
            Command::Join => self.arrange(arrange::join(&project, &selection)),
            Command::Split => self.arrange(arrange::split(&project, &selection)),
            Command::BothViews => self.session.views = Views::Both,
            Command::PlaneView => self.session.views = Views::Plane,
            Command::ShotView => self.session.views = Views::Shot,
            Command::LookView => self.session.views = Views::Look,
            _ => {}
        }
    }

    /// Changes what was drawn, and selects what came of it.
    fn arrange(&mut self, arranged: Arranged) {
        if let Some((edit, selection)) = arranged {
            self.edit(edit);
            self.session.selection = selection;
        }
    }
}
