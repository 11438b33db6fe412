//! Carries out the actions that panels and tools asked for, and the commands of menus and keys.

use eframe::egui;

use super::file_state::Leave;
use super::{App, Gpu};
use crate::editor::action::Action;
use crate::editor::clipboard;
use crate::editor::command::Command;
use crate::editor::preferences;
use crate::editor::state::EditorState;
use crate::editor::store::{PhotonRenderer, Theme};

impl App {
    /// Carries out an action: the editor's state handles most of them, the window the rest.
    pub(super) fn apply(&mut self, ctx: &egui::Context, action: Action) {
        match self.editor.apply(action) {
            Some(Action::Command(command)) => self.command(ctx, command),
            Some(Action::PlayFrames(path)) => self.windows.player.play(ctx, &path),
            Some(Action::Open(path)) => self.leave(ctx, Leave::Open(path)),
            Some(Action::OpenBackup(path)) => self.leave(ctx, Leave::Backup(path)),
            Some(Action::New(template)) => self.leave(ctx, Leave::New(template)),
            Some(Action::PickFile(asset)) => self.pick_file(ctx, asset),
            Some(Action::PlacePicture(at)) => self.place_picture(at),
            _ => (),
        }
    }

    /// Carries out a command of the window and its files.
    pub(super) fn command(&mut self, ctx: &egui::Context, command: Command) {
        let scale = &mut self.preferences.ui_scale;
        let EditorState { document, session, .. } = &mut self.editor;
        match command {
            Command::Copy => {
                let text = clipboard::copy(document.project(), &session.selection);
                text.into_iter().for_each(|text| ctx.copy_text(text));
            }
            Command::Cut => {
                if let Some((text, arranged)) = clipboard::cut(document.project(), &session.selection) {
                    ctx.copy_text(text);
                    self.editor.arrange(arranged);
                }
            }
            Command::Paste => ctx.send_viewport_cmd(egui::ViewportCommand::RequestPaste),
            Command::ActualSize => self.views.actual_size(session, document.project()),
            Command::Snapping => {
                session.snapping = !session.snapping;
                self.preferences.snapping = session.snapping;
            }
            Command::New => self.windows.welcome.open = true,
            Command::NewEmpty => self.leave(ctx, Leave::Empty),
            Command::Open => self.ask_what_to_open(ctx),
            Command::Import => self.ask_what_to_import(ctx),
            Command::Save => self.save(ctx),
            Command::SaveAs => self.save_as(ctx),
            Command::Collect => self.ask_where_to_collect(ctx),
            Command::ReloadAssets => self.reload_assets(),
            Command::Quit => self.leave(ctx, Leave::Quit),
            Command::Export => self.windows.export.open = true,
            Command::Player => self.windows.player.open = !self.windows.player.open,
            Command::Palette => self.windows.palette.open(),
            Command::Shortcuts => self.windows.shortcuts.open = !self.windows.shortcuts.open,
            Command::Preferences => self.windows.preferences = !self.windows.preferences,
            Command::Tour => self.windows.tour.begin(document.project()),
            Command::SaveReport => return self.ask_where_to_report(ctx),
            Command::Larger => *scale = preferences::stepped(*scale, 1),
            Command::Smaller => *scale = preferences::stepped(*scale, -1),
            Command::NormalSize => *scale = 1.0,
            Command::DarkTheme => self.preferences.theme = Theme::Dark,
            Command::LightTheme => self.preferences.theme = Theme::Light,
            Command::SystemTheme => self.preferences.theme = Theme::System,
            _ => {}
        }
        preferences::apply(ctx, &self.preferences);
    }

    /// Whether the graphics card draws the photons of the plane.
    pub(super) fn draws_on_gpu(&self) -> bool {
        match (self.preferences.photon_renderer, self.gpu) {
            (PhotonRenderer::Auto, gpu) => gpu == Gpu::Hardware,
            (PhotonRenderer::Gpu, gpu) => gpu != Gpu::None,
            (PhotonRenderer::Cpu, _) => false,
        }
    }
}
