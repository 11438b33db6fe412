//! The application: the order of a frame. Results come in, panels are shown, actions are carried out, the preview is asked.

use std::path::Path;

use eframe::egui;
use egui::{CentralPanel, Panel};

use super::action::Action;
use super::document::Document;
use super::panels::Desk;
use super::preview::{Preview, Subject};
use super::session::Session;
use super::theme;

/// The window's state.
pub struct App {
    document: Document,
    session: Session,
    preview: Preview,
}

impl App {
    /// A window that shows `document`.
    pub fn new(ctx: &egui::Context, document: Document) -> Self {
        theme::apply(ctx);
        let wake = ctx.clone();
        Self {
            session: Session {
                playhead: document.project().keys.first().map_or(1, |key| key.frame),
                ..Session::default()
            },
            document,
            preview: Preview::new(move || wake.request_repaint()),
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        let mut actions: Vec<Action> = Vec::new();
        let mut desk = Desk {
            document: &self.document,
            session: &mut self.session,
            preview: &self.preview,
            actions: &mut actions,
        };
        Panel::bottom("status").show(ui, |ui| ui.label(desk.preview.problem().unwrap_or("Ready").to_owned()));
        CentralPanel::default().show(ui, |ui| ui.label(desk.document.title()));
        desk.session.playing = false;
        let subject = Subject {
            project: self.document.project().clone(),
            base: self.document.path().unwrap_or(Path::new("project.json")).to_owned(),
            external: false,
        };
        self.preview.follow(&subject, self.session.playhead);
    }
}
