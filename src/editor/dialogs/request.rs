//! What a file is asked for, and where: the system's dialogs, or answers of a test.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Mutex, PoisonError};

use egui::Context;

use crate::editor::asset::AssetUse;

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
    Asset(AssetUse),
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
    pub(super) fn title(&self) -> &'static str {
        match self {
            Self::OpenProject => "Open a project",
            Self::SaveProject => "Save the project",
            Self::ExportFolder => "Folder for the frames",
            Self::Asset(AssetUse::Mesh | AssetUse::MeshFile(_)) => "Choose a mesh",
            Self::Asset(AssetUse::Picture(_)) => "Choose a picture",
            Self::Asset(AssetUse::Points(_)) => "Choose a file of points",
        }
    }

    /// What the wanted files are called, and how their names end; no end means a folder.
    pub(super) fn files(&self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::OpenProject | Self::SaveProject => ("Lightloom projects", &["json"]),
            Self::ExportFolder => ("Folders", &[]),
            Self::Asset(pick) => pick.files(),
        }
    }

    pub(super) fn saves(&self) -> bool {
        *self == Self::SaveProject
    }
}

/// A project is saved with its ending, also where the user typed none.
pub(super) fn with_ending(purpose: &Purpose, path: PathBuf) -> PathBuf {
    if purpose.saves() && path.extension().is_none() { path.with_extension("json") } else { path }
}
