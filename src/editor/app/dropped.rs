//! Files that are dragged over the window and dropped: what would happen is said before they are let go.

use std::path::{Path, PathBuf};

use eframe::egui;
use egui::{Align2, Area, Frame, Id, Order, RichText};
use lightloom_core::scene::mesh;

use super::App;
use super::file_state::Leave;
use super::files::name;
use crate::editor::asset::{AssetUse, TargetSlot};
use crate::editor::dialogs::Purpose;

/// What a file becomes that is dropped.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Becomes {
    /// Opened in place of the document.
    Document,
    /// Frames that are played.
    Frames,
    /// A part of the project.
    Part(AssetUse),
    /// Nothing, for this reason.
    Nothing(String),
}

impl App {
    /// Says what would happen to the files that are dragged over the window.
    pub(super) fn say_what_drops(&self, ctx: &egui::Context) {
        let dragged = ctx.input(|input| input.raw.hovered_files.clone());
        let files: Vec<PathBuf> = dragged.into_iter().filter_map(|file| file.path).collect();
        if files.is_empty() {
            return;
        }
        let area = Area::new(Id::unique("dragged files"))
            .anchor(Align2::CENTER_CENTER, egui::Vec2::ZERO)
            .order(Order::Tooltip)
            .interactable(false);
        area.show(ctx, |ui| {
            Frame::popup(ui.style()).inner_margin(20).show(ui, |ui| {
                for file in files {
                    ui.label(RichText::new(self.words_of_drop(&file)).heading());
                }
            });
        });
    }

    fn words_of_drop(&self, file: &Path) -> String {
        let shown = name(file);
        let frame =
            |at: &TargetSlot| self.editor.document.project().keys.get(at.key).map_or(0, |key| key.frame);
        match self.becomes(file) {
            Becomes::Document => format!("Open '{shown}'"),
            Becomes::Frames => format!("Play the frames in '{shown}'"),
            Becomes::Part(AssetUse::Mesh) => format!("Import '{shown}' into the scene"),
            Becomes::Part(AssetUse::Picture(at) | AssetUse::Points(at)) => {
                format!("Show '{shown}' at the key frame {}", frame(&at))
            }
            Becomes::Part(AssetUse::MeshFile(_) | AssetUse::Plate) => format!("Use '{shown}'"),
            Becomes::Nothing(why) => format!("'{shown}' {why}"),
        }
    }

    /// A project is opened, a folder of frames is played, a mesh comes into the scene, a picture or points become what the key
    /// frame after the playhead shows.
    fn becomes(&self, file: &Path) -> Becomes {
        if file.is_dir() {
            return Becomes::Frames;
        }
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let is_one_of = |endings: &[&str]| ending.as_deref().is_some_and(|ending| endings.contains(&ending));
        if is_one_of(Purpose::OpenProject.files().1) {
            return Becomes::Document;
        }
        let ends = |pick: &AssetUse| is_one_of(pick.files().1);
        let keys = &self.editor.document.project().keys;
        let after = keys.iter().position(|key| key.frame >= self.editor.session.playhead);
        let at = TargetSlot { key: after.unwrap_or(keys.len().saturating_sub(1)), caustic: None };
        let parts = [AssetUse::Mesh, AssetUse::Picture(at.clone()), AssetUse::Points(at)];
        match parts.into_iter().find(ends) {
            Some(part) => Becomes::Part(part),
            None => {
                Becomes::Nothing(mesh::advice(file).map_or_else(
                    || "is not a project, mesh, picture or point file".to_owned(),
                    str::to_owned,
                ))
            }
        }
    }

    /// A file was dropped on the window.
    pub(super) fn dropped(&mut self, ctx: &egui::Context, file: PathBuf) {
        match self.becomes(&file) {
            Becomes::Document => self.leave(ctx, Leave::Open(file)),
            Becomes::Frames => self.windows.player.play(ctx, &file),
            Becomes::Part(part) => self.locate(part, file),
            Becomes::Nothing(why) => {
                self.show_message(format!("'{}' cannot be used", name(&file)), format!("It {why}."));
            }
        }
    }
}
