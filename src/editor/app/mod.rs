//! The application: the order of a frame. Results come in, panels are shown, actions are carried out, the preview is asked.

mod apply;
mod commands;
mod layout;

use std::time::Duration;

use eframe::egui;

use super::action::Action;
use super::document::Document;
use super::panels::Desk;
use super::playback::{self, Playback};
use super::preview::{Preview, Subject};
use super::session::Session;
use super::timeline::Timeline;
use super::tools::Toolbox;
use super::views::Views;
use super::{templates, theme};

/// The window's state.
pub struct App {
    document: Document,
    session: Session,
    preview: Preview,
    toolbox: Toolbox,
    timeline: Timeline,
    playback: Playback,
    views: Views,
    /// What the status bar says, until something else happens.
    word: String,
}

impl App {
    /// A window that shows `document`. `by_card` tells whether the graphics card can draw photons.
    pub fn new(ctx: &egui::Context, document: Document, by_card: bool) -> Self {
        theme::apply(ctx);
        let wake = ctx.clone();
        let first = document.project().keys.first().map_or(1, |key| key.frame);
        let mut preview = Preview::new(move || wake.request_repaint());
        preview.draw_by_card(by_card);
        Self {
            session: Session { playhead: first, ..Session::default() },
            document,
            preview,
            toolbox: Toolbox::default(),
            timeline: Timeline::default(),
            playback: Playback::default(),
            views: Views::default(),
            word: String::new(),
        }
    }

    /// The document, to look at.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The state of the window, to look at.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// One frame of the window.
    pub fn show(&mut self, ui: &mut egui::Ui) {
        self.play(ui.ctx());
        let mut actions = Vec::new();
        self.keys(ui.ctx(), &mut actions);
        self.layout(ui, &mut actions);
        for action in actions {
            self.apply(ui.ctx(), action);
        }
        let gesture = ui.input(|input| input.pointer.any_down()) || ui.ctx().egui_wants_keyboard_input();
        if !gesture {
            self.document.settle();
        }
        self.follow();
    }

    /// Time that passed moves the playhead.
    fn play(&mut self, ctx: &egui::Context) {
        let frames = playback::played(self.document.project(), &self.session);
        let fps = playback::fps(self.document.project());
        let seconds = ctx.input(|input| input.stable_dt).into();
        if let Some(next) = self.playback.advance(&mut self.session, &frames, fps, seconds) {
            ctx.request_repaint_after(Duration::from_secs_f64(next));
        }
    }

    /// Tells the workers what is wanted now.
    fn follow(&mut self) {
        let subject = Subject {
            project: self.document.project().clone(),
            base: templates::file_of(&self.document),
            external: false,
        };
        self.preview.follow(&subject, &self.session, self.views.wanted());
    }

    /// What panels see.
    fn desk<'a>(&'a mut self, actions: &'a mut Vec<Action>) -> Desk<'a> {
        Desk { document: &self.document, session: &mut self.session, preview: &self.preview, actions }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        self.show(ui);
    }

    fn clear_color(&self, _: &egui::Visuals) -> [f32; 4] {
        theme::SURROUND.to_normalized_gamma_f32()
    }
}
