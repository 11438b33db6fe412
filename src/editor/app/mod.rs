//! The application: the order of a frame. Results come in, panels are shown, actions are carried out, the preview is asked.

mod apply;
mod autosave;
mod commands;
mod file_state;
mod files;
mod layout;
mod open_windows;
mod recents;
mod windows;

use std::sync::Arc;
use std::time::Duration;

use eframe::egui;

use super::action::Action;
use super::dialogs::{Dialogs, Picker};
use super::document::Document;
use super::export::Exports;
use super::playback::{self, Playback};
use super::preview::{Preview, Subject};
use super::session::Session;
use super::store::{Folders, Preferences};
use super::timeline::Timeline;
use super::tools::Toolbox;
use super::views::Views;
use super::{keyboard, preferences, templates, theme};
use file_state::Files;
use open_windows::Windows;
use recents::Recents;

/// The window's state.
pub struct App {
    document: Document,
    session: Session,
    preview: Preview,
    toolbox: Toolbox,
    timeline: Timeline,
    playback: Playback,
    views: Views,
    exports: Exports,
    picker: Picker,
    windows: Windows,
    recents: Recents,
    files: Files,
    preferences: Preferences,
    /// What the graphics card can do.
    gpu: Gpu,
    /// Whether the project may read files from anywhere: the artist picked one, or allowed it.
    external: bool,
    /// What was asked for from outside.
    asked: Vec<Action>,
    /// What the status bar says, until something else happens.
    status: String,
}

/// What draws the photons of the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gpu {
    /// A graphics card.
    Hardware,
    /// A program that behaves like one. The processor estimates the light itself two to eighteen times as fast.
    Software,
    /// Nothing that blends 32-bit floats.
    None,
}

/// What a window is opened with.
pub struct Setup {
    /// What it shows.
    pub document: Document,
    /// What to tell first, if anything: a title and what to do.
    pub message: Option<(String, String)>,
    /// Where the user's files for recovery and preferences are; without them nothing is kept between runs.
    pub folders: Option<Folders>,
    /// What the user prefers.
    pub preferences: Preferences,
    /// Where files are asked for.
    pub dialogs: Arc<dyn Dialogs>,
    /// What the graphics card can do.
    pub gpu: Gpu,
}

impl App {
    /// A window that shows a document.
    pub fn new(ctx: &egui::Context, setup: Setup) -> Self {
        theme::apply(ctx);
        preferences::apply(ctx, &setup.preferences);
        let wake = || {
            let ctx = ctx.clone();
            move || ctx.request_repaint()
        };
        let first_start = !setup.preferences.first_start_seen;
        let mut app = Self {
            session: Session { snapping: setup.preferences.snapping, ..begin(&setup.document) },
            preview: Preview::new(wake()),
            toolbox: Toolbox::default(),
            timeline: Timeline::default(),
            playback: Playback::default(),
            views: Views::default(),
            exports: Exports::new(wake()),
            picker: Picker::new(setup.dialogs),
            windows: Windows::default(),
            recents: Recents::new(wake()),
            files: Files::start(setup.folders, wake()),
            preferences: setup.preferences,
            gpu: setup.gpu,
            external: false,
            asked: Vec::new(),
            status: String::new(),
            document: setup.document,
        };
        if first_start {
            app.session.playing = true;
            app.windows.tour.begin(app.document.project());
        }
        if let Some((title, text)) = setup.message {
            app.show_message(title, text);
        }
        app
    }

    /// The document, to look at.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The state of the window, to look at.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// What was worked out, to look at.
    pub fn preview(&self) -> &Preview {
        &self.preview
    }

    /// Asks for something as a panel would; it is done in the next frame of the window.
    pub fn ask(&mut self, action: Action) {
        self.asked.push(action);
    }

    /// One frame of the window.
    pub fn show(&mut self, ui: &mut egui::Ui) {
        let ctx = ui.ctx().clone();
        self.receive(&ctx);
        self.play(&ctx);
        let tools: Vec<_> = self.toolbox.tools().map(|tool| (tool.name(), tool.key())).collect();
        let mut actions = std::mem::take(&mut self.asked);
        actions.extend(keyboard::pressed(&ctx, &tools, self.toolbox.tool().is_busy()));
        self.layout(ui, &mut actions);
        self.windows(&ctx, &tools, &mut actions);
        for action in actions {
            self.apply(&ctx, action);
        }
        let gesture = ctx.input(|input| input.pointer.any_down()) || ctx.text_edit_focused();
        if !gesture && !self.toolbox.tool().is_busy() {
            self.document.settle();
        }
        self.autosave(&ctx);
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
        self.preview.draw_by_card(self.draws_on_gpu());
        let subject = Subject {
            project: self.document.project().clone(),
            base: templates::file_of(&self.document),
            external: self.external,
        };
        self.preview.follow(&subject, &self.session, self.views.wanted());
    }

    /// Puts another document into the window.
    fn replace(&mut self, document: Document) {
        let Session { layout, overlays, snapping, looping, panel, tool, .. } = self.session.clone();
        let _ = self.toolbox.put_down();
        self.session = Session { layout, overlays, snapping, looping, panel, tool, ..begin(&document) };
        self.document = document;
        self.external = false;
        self.status.clear();
    }
}

/// A session at the begin of a document.
fn begin(document: &Document) -> Session {
    let first = document.project().keys.first().map_or(1, |key| key.frame);
    Session { playhead: first, ..Session::default() }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        self.show(ui);
    }

    fn clear_color(&self, _: &egui::Visuals) -> [f32; 4] {
        theme::SURROUND.to_normalized_gamma_f32()
    }
}
