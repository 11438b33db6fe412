//! The application: the order of a frame. Results come in, panels are shown, actions are carried out, the preview is asked.

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
use super::state::EditorState;
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
    editor: EditorState,
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
            editor: EditorState::new(setup.document, wake()),
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
        };
        app.editor.session.snapping = app.preferences.snapping;
        if first_start {
            app.editor.session.playing = true;
            app.windows.tour.begin(app.editor.document.project());
        }
        if let Some((title, text)) = setup.message {
            app.show_message(title, text);
        }
        app
    }

    /// The document, to look at.
    pub fn document(&self) -> &Document {
        &self.editor.document
    }

    /// The state of the window, to look at.
    pub fn session(&self) -> &Session {
        &self.editor.session
    }

    /// What was worked out, to look at.
    pub fn preview(&self) -> &Preview {
        &self.editor.preview
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
            self.editor.document.settle();
        }
        self.autosave(&ctx);
        self.follow();
    }

    /// Time that passed moves the playhead.
    fn play(&mut self, ctx: &egui::Context) {
        let frames = playback::played(self.editor.document.project(), &self.editor.session);
        let fps = playback::fps(self.editor.document.project());
        let seconds = ctx.input(|input| input.stable_dt).into();
        if let Some(next) = self.playback.advance(&mut self.editor.session, &frames, fps, seconds) {
            ctx.request_repaint_after(Duration::from_secs_f64(next));
        }
    }

    /// Tells the workers what is wanted now.
    fn follow(&mut self) {
        self.editor.preview.draw_by_card(self.draws_on_gpu());
        let subject = Subject {
            project: self.editor.document.project().clone(),
            base: templates::file_of(&self.editor.document),
            external: self.external,
        };
        self.editor.preview.follow(&subject, &self.editor.session, self.views.wanted());
    }

    /// Puts another document into the window.
    fn replace(&mut self, document: Document) {
        let _ = self.toolbox.put_down();
        self.editor.open(document);
        self.external = false;
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
