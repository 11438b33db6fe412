//! Questions to the user: which file, and what shall become of changes.
//!
//! [`Picker`] asks the system for its own file dialog, and shows a plain one of ours where the system has none.

mod browser;
mod native;
mod question;

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};

use egui::{Context, Frame, Id, Modal};

use browser::Browser;

use super::pick::Pick;
pub use native::Native;
pub use question::{Answer, Question};

/// What a file is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A project to open.
    OpenProject,
    /// Where to save the project.
    SaveProject,
    /// The folder to which frames are written.
    ExportFolder,
    /// A file that the project is to use.
    Asset(Pick),
}

/// What to ask for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PickRequest {
    /// What it is asked for.
    pub purpose: Purpose,
    /// The folder at which to begin.
    pub folder: Option<PathBuf>,
    /// The name that a saved file has at first; empty where none is saved.
    pub name: String,
}

/// What came of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PickResult {
    /// The user chose this.
    Picked(PathBuf),
    /// The user wants nothing.
    Cancelled,
    /// There is nobody to ask: the system has no file dialog.
    Unavailable,
}

/// Where files are asked for.
pub trait Dialogs: Send + Sync {
    /// Asks; the answer comes when the user has given it.
    fn pick(&self, request: &PickRequest, wake: Context) -> Receiver<PickResult>;
}

/// Answers that were written down before, for tests; when they are used up there is nobody to ask.
#[derive(Debug, Default)]
pub struct Scripted(Mutex<VecDeque<PickResult>>);

impl Scripted {
    /// Gives these answers, in their order.
    pub fn new(answers: impl IntoIterator<Item = PickResult>) -> Self {
        Self(Mutex::new(answers.into_iter().collect()))
    }
}

impl Dialogs for Scripted {
    fn pick(&self, _request: &PickRequest, _wake: Context) -> Receiver<PickResult> {
        let (sender, receiver) = channel();
        let answer = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop_front();
        // The receiver is alive: it is returned here.
        let _ = sender.send(answer.unwrap_or(PickResult::Unavailable));
        receiver
    }
}

/// Asks for files, one at a time.
pub struct Picker {
    dialogs: Arc<dyn Dialogs>,
    stage: Stage,
}

enum Stage {
    Idle,
    /// The system's dialog is open.
    Asked(PickRequest, Receiver<PickResult>),
    /// Ours is.
    Browsing(PickRequest, Box<Browser>),
}

impl PickRequest {
    /// Asks for a file at no particular place.
    pub fn new(purpose: Purpose) -> Self {
        Self { purpose, folder: None, name: String::new() }
    }

    /// The request, to begin in a folder.
    pub fn in_folder(self, folder: Option<PathBuf>) -> Self {
        Self { folder, ..self }
    }

    /// The request, with a name for the file to be saved.
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }
}

impl Purpose {
    fn title(&self) -> &'static str {
        match self {
            Self::OpenProject => "Open a project",
            Self::SaveProject => "Save the project",
            Self::ExportFolder => "Folder for the frames",
            Self::Asset(Pick::Mesh | Pick::MeshFile(_)) => "Choose a mesh",
            Self::Asset(Pick::Picture(_)) => "Choose a picture",
            Self::Asset(Pick::Points(_)) => "Choose a file of points",
        }
    }

    /// What the wanted files are called, and how their names end; no end means a folder.
    fn files(&self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::OpenProject | Self::SaveProject => ("Lightloom projects", &["json"]),
            Self::ExportFolder => ("Folders", &[]),
            Self::Asset(pick) => pick.files(),
        }
    }

    fn saves(&self) -> bool {
        *self == Self::SaveProject
    }
}

impl Picker {
    /// A picker that asks through these dialogs.
    pub fn new(dialogs: Arc<dyn Dialogs>) -> Self {
        Self { dialogs, stage: Stage::Idle }
    }

    /// Asks; a question that is open already is dropped.
    pub fn ask(&mut self, request: PickRequest, ctx: &Context) {
        let answer = self.dialogs.pick(&request, ctx.clone());
        self.stage = Stage::Asked(request, answer);
    }

    /// Whether a question is open.
    pub fn is_open(&self) -> bool {
        !matches!(self.stage, Stage::Idle)
    }

    /// Shows our own dialog where the system has none; returns what was chosen.
    pub fn show(&mut self, ctx: &Context) -> Option<(Purpose, PathBuf)> {
        match std::mem::replace(&mut self.stage, Stage::Idle) {
            Stage::Idle => None,
            Stage::Asked(request, answer) => match answer.try_recv() {
                Ok(PickResult::Picked(path)) => {
                    let path = with_ending(&request.purpose, path);
                    Some((request.purpose, path))
                }
                Ok(PickResult::Cancelled) => None,
                Err(TryRecvError::Empty) => {
                    self.stage = Stage::Asked(request, answer);
                    None
                }
                Ok(PickResult::Unavailable) | Err(TryRecvError::Disconnected) => {
                    let browser = Box::new(Browser::new(&request, ctx));
                    self.stage = Stage::Browsing(request, browser);
                    None
                }
            },
            Stage::Browsing(request, mut browser) => match browser.show(ctx) {
                None => {
                    self.stage = Stage::Browsing(request, browser);
                    None
                }
                Some(None) => None,
                Some(Some(path)) => {
                    let path = with_ending(&request.purpose, path);
                    Some((request.purpose, path))
                }
            },
        }
    }
}

/// A window over all others, with room around its content.
pub(super) fn modal(ctx: &Context, name: &'static str) -> Modal {
    let style = ctx.global_style();
    let frame = Frame::popup(&style).inner_margin(16).corner_radius(style.visuals.window_corner_radius);
    Modal::new(Id::unique(name)).frame(frame)
}

/// A project is saved with its ending, also where the user typed none.
fn with_ending(purpose: &Purpose, path: PathBuf) -> PathBuf {
    if purpose.saves() && path.extension().is_none() { path.with_extension("json") } else { path }
}
