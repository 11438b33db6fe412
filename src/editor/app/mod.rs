//! The application. One frame: results come in, panels are shown, actions are carried out, the preview is updated.

mod autosave;
mod commands;
mod dropped;
mod file_state;
mod files;
mod import;
mod layout;
mod open_windows;
mod outside;
mod placing;
mod recents;
mod report;
mod task;
mod windows;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui;
use lightloom_core::import::Import;
use lightloom_core::project::Collection;

use super::action::Action;
use super::device::{self, Device};
use super::dialogs::{Dialogs, Picker, is_on_top};
use super::document::Document;
use super::engine::SharedEngine;
use super::export::{Exports, InterruptedExport, interrupted};
use super::key_queue::{KeyQueue, Taker};
use super::playback::{self, Playback};
use super::preview::{LivePreview, Subject};
use super::session::Session;
use super::state::EditorState;
use super::store::{Folders, Preferences};
use super::timeline::Timeline;
use super::tools::Toolbox;
use super::views::Views;
use super::{keyboard, preferences, templates, theme};
use file_state::{Details, Elsewhere, Files, Placing};
use open_windows::Windows;
use recents::Recents;
use task::Task;

/// Seconds after the start when it is looked again for what an earlier run left: one that was killed just before still holds it
/// while the system clears it away, which takes long on a busy machine.
const LOOKS_AGAIN: [u64; 5] = [2, 4, 8, 16, 32];

/// The window: the editor's state with its views, windows and files.
pub struct App {
    editor: EditorState,
    toolbox: Toolbox,
    timeline: Timeline,
    playback: Playback,
    views: Views,
    exports: Exports,
    /// Exports that an earlier run left, not yet offered.
    interrupted: Vec<InterruptedExport>,
    /// The start, and the times after it when it is looked again for what an earlier run left.
    begun: Instant,
    looks_again: std::slice::Iter<'static, u64>,
    /// Where the exports of earlier runs are.
    records: Option<PathBuf>,
    picker: Picker,
    windows: Windows,
    recents: Recents,
    files: Files,
    engine: SharedEngine,
    /// The scene that is being read for the document.
    importing: Option<Task<Import>>,
    /// The picture whose place is being found.
    placing: Option<Placing>,
    /// The copy of the project with all its files that is being made.
    collecting: Option<Task<(PathBuf, Collection)>>,
    /// The details of a message in the status bar.
    details: Option<Details>,
    preferences: Preferences,
    keeps_preferences: bool,
    /// The graphics device, and its name.
    gpu: Gpu,
    graphics: String,
    device: Arc<Device>,
    /// The last message of the status bar that is in the log.
    logged: String,
    /// Actions asked for by [`App::ask`].
    asked: Vec<Action>,
}

/// The kind of graphics device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gpu {
    /// A graphics card.
    Hardware,
    /// Software rendering; the processor draws the photons 2 to 18 times as fast itself.
    Software,
    /// No device that blends 32-bit floats.
    None,
}

/// The initial state of a window.
pub struct Setup {
    /// The open document.
    pub document: Document,
    /// A message to show first: title and text.
    pub message: Option<(String, String)>,
    /// Folders for recovery and preferences; without them nothing is kept between runs.
    pub folders: Option<Folders>,
    /// The user's preferences.
    pub preferences: Preferences,
    /// Whether their changes are stored.
    pub keeps_preferences: bool,
    /// The file dialogs.
    pub dialogs: Arc<dyn Dialogs>,
    /// What the graphics card can do.
    pub gpu: Gpu,
    /// Name, kind and driver of the graphics card; for people.
    pub graphics: String,
    /// Whether the card is still there.
    pub device: Arc<Device>,
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
        let engine = SharedEngine::default();
        let records = setup.folders.as_ref().map(Folders::exports);
        let first_start = !setup.preferences.first_start_seen;
        let mut app = Self {
            editor: EditorState::new(setup.document, engine.clone(), wake()),
            toolbox: Toolbox::default(),
            timeline: Timeline::default(),
            playback: Playback::default(),
            views: Views::default(),
            exports: Exports::new(engine.clone(), wake()).with_records(records.clone()),
            interrupted: records.as_deref().map(interrupted).unwrap_or_default(),
            begun: Instant::now(),
            looks_again: LOOKS_AGAIN.iter(),
            records,
            picker: Picker::new(setup.dialogs),
            windows: Windows::default(),
            recents: Recents::new(wake()),
            files: Files::start(setup.folders, wake()),
            engine,
            importing: None,
            placing: None,
            collecting: None,
            details: None,
            preferences: setup.preferences,
            keeps_preferences: setup.keeps_preferences,
            gpu: setup.gpu,
            graphics: setup.graphics,
            device: setup.device,
            logged: String::new(),
            asked: Vec::new(),
        };
        app.editor.session.snapping = app.preferences.snapping;
        if first_start {
            app.editor.session.playing = true;
            app.windows.tour.begin(app.editor.document.project());
        }
        app.attach();
        let folders: Vec<_> =
            app.preferences.recent.iter().rev().filter_map(|file| file.parent()).map(Into::into).collect();
        folders.iter().for_each(|folder: &PathBuf| app.picker.remember(folder));
        if let Some((title, text)) = setup.message {
            app.show_message(title, text);
        }
        app
    }

    /// The open document.
    pub fn document(&self) -> &Document {
        &self.editor.document
    }

    /// The state of the session.
    pub fn session(&self) -> &Session {
        &self.editor.session
    }

    /// The results of the preview.
    pub fn preview(&self) -> &LivePreview {
        &self.editor.preview
    }

    /// Asks for an action as a panel does; it is carried out in the next frame.
    pub fn ask(&mut self, action: Action) {
        self.asked.push(action);
    }

    /// One frame of the window.
    pub fn show(&mut self, ui: &mut egui::Ui) {
        let ctx = ui.ctx().clone();
        if self.device.is_lost() {
            // What is on its way to the disk gets there; the next window offers it.
            self.exports = Exports::new(SharedEngine::default(), || ());
            (self.files.journal, self.files.saver) = (None, None);
            device::start_anew(self.editor.document.path());
        }
        let asking = self.picker.is_waiting();
        self.receive(&ctx);
        self.direct_keys(&ctx, asking);
        self.play(&ctx);
        let tools: Vec<_> = self.toolbox.tools().map(|tool| (tool.info().name, tool.info().key)).collect();
        let mut actions = std::mem::take(&mut self.asked);
        // A transform in progress has all keys.
        let transforms = self.editor.session.transforming.is_some();
        if !transforms {
            let busy = (self.toolbox.tool().is_busy(), self.windows.palette.is_open());
            if busy == (false, false) && !ctx.text_edit_focused() && !keyboard::is_covered(&ctx) {
                self.windows.take_keys(&ctx);
            }
            actions.extend(keyboard::pressed(&ctx, &tools, busy, self.views.key_place(&ctx)));
        }
        self.layout(ui, &mut actions);
        self.windows(&ctx, &tools, &mut actions);
        self.say_what_drops(&ctx);
        for action in actions {
            self.apply(&ctx, action);
        }
        self.type_on(&ctx, transforms);
        let gesture = ctx.input(|input| input.pointer.any_down())
            || ctx.text_edit_focused()
            || self.views.is_flying(&ctx)
            || self.editor.session.transforming.is_some();
        if !gesture && !self.toolbox.tool().is_busy() {
            self.editor.document.settle();
        }
        self.autosave(&ctx);
        self.follow();
        self.log_status();
        self.direct_keys(&ctx, asking);
    }

    /// Says who takes the keys. `asking` is whether a file dialog was on its way before this frame.
    fn direct_keys(&self, ctx: &egui::Context, asking: bool) {
        let covered = self.picker.is_open() || self.files.question.is_some() || self.windows.welcome.open;
        keyboard::set_covered(ctx, covered);
        let palette = self.windows.palette.is_open() && !ctx.text_edit_focused();
        let taker = match self.picker.taker(ctx) {
            Taker::Shown if palette => Taker::Coming,
            Taker::Shown if asking && !self.picker.is_open() => Taker::Gone,
            Taker::Shown if covered && !is_on_top(ctx) => Taker::Coming,
            taker => taker,
        };
        KeyQueue::set(ctx, taker);
    }

    /// Passes the keys to a transform that were pressed in the frame that began it, after the key that did.
    fn type_on(&mut self, ctx: &egui::Context, transformed: bool) {
        let Some(begun) = self.editor.session.transforming.as_mut().filter(|_| !transformed) else { return };
        ctx.input(|input| {
            let is_first = |event: &&egui::Event| match event {
                egui::Event::Key { key, pressed: true, .. } => begun.kind.key() == *key,
                _ => false,
            };
            let after = input.events.iter().skip_while(|event| !is_first(event)).skip(1);
            // An Enter or Escape so early is no more than a wish: the next frame reads on.
            let _ = begun.take(&after.cloned().collect::<Vec<_>>());
        });
        ctx.request_repaint();
    }

    /// Moves the playhead by the time that passed.
    fn play(&mut self, ctx: &egui::Context) {
        let frames = playback::played(self.editor.document.project(), &self.editor.session);
        let fps = playback::fps(self.editor.document.project()) * self.editor.session.speed;
        let seconds = ctx.input(|input| input.stable_dt).into();
        if let Some(next) = self.playback.advance(&mut self.editor.session, &frames, fps, seconds) {
            ctx.request_repaint_after(Duration::from_secs_f64(next));
        }
    }

    /// Updates the preview's subject and views.
    fn follow(&mut self) {
        self.editor.preview.draw_by_card(self.draws_on_gpu());
        let subject = self.subject();
        self.editor.preview.follow(&subject, &self.editor.session, self.views.wanted());
    }

    /// The open project, and the place of its files.
    fn subject(&self) -> Subject {
        Subject {
            project: self.editor.document.project().clone(),
            base: templates::file_of(&self.editor.document),
            access: self.files.access(),
        }
    }

    /// Replaces the document.
    fn replace(&mut self, document: Document) {
        self.replace_admitting(document, &[]);
    }

    /// Replaces the document by one that may read these files, wherever they are.
    fn replace_admitting(&mut self, document: Document, admitted: &[PathBuf]) {
        let _ = self.toolbox.put_down();
        self.editor.open(document);
        self.views.forget_pictures();
        (self.importing, self.placing, self.details) = (None, None, None);
        // Who begins with something else needs no tour of the example.
        self.preferences.first_start_seen |= self.windows.tour.end();
        self.files.forget_admitted();
        let trusted = self.files.trusted.files();
        admitted.iter().for_each(|file| self.files.admitted.add(file));
        self.files.outside = admitted.iter().any(|file| !trusted.contains(file)).then_some(Elsewhere::Copy);
        self.attach();
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
