//! File requests, and the dialogs that answer them.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Mutex, PoisonError};

use egui::Context;

use crate::editor::asset::AssetUse;

/// Endings of what can be imported.
const IMPORTED: &[&str] =
    &["glb", "gltf", "obj", "png", "jpg", "jpeg", "webp", "tif", "tiff", "exr", "hdr", "csv", "npy"];

/// The purpose of a file dialog.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A project to open.
    OpenProject,
    /// Where to save the project.
    SaveProject,
    /// The output folder for frames.
    ExportFolder,
    /// A scene of another program, or a picture, for the project.
    Import,
    /// The folder to collect the project into.
    CollectFolder,
    /// A picture of a rendered sequence to play.
    Frames,
    /// Where to save the report that a user sends.
    SaveReport,
    /// A file for the project to use.
    Asset(AssetUse),
}

/// A request for a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PickRequest {
    /// The purpose.
    pub purpose: Purpose,
    /// The initial folder.
    pub folder: Option<PathBuf>,
    /// The initial file name for saving; empty otherwise.
    pub name: String,
}

/// The result of a file dialog.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PickResult {
    /// The chosen path.
    Picked(PathBuf),
    /// The user cancelled.
    Cancelled,
    /// The system has no file dialog.
    Unavailable,
}

/// What a dialog of the system will answer.
pub(super) type Answer = std::pin::Pin<Box<dyn Future<Output = PickResult> + Send>>;

/// A source of file dialogs.
pub trait Dialogs: Send + Sync {
    /// Opens a dialog; the result arrives when the user has answered.
    fn pick(&self, request: &PickRequest, wake: Context) -> Receiver<PickResult>;
}

/// Predefined results for tests; unavailable when they are used up.
#[derive(Debug, Default)]
pub struct Scripted(Mutex<VecDeque<PickResult>>);

impl Scripted {
    /// Dialogs with these results, in order.
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
    /// A request without initial folder or name.
    pub fn new(purpose: Purpose) -> Self {
        Self { purpose, folder: None, name: String::new() }
    }

    /// With an initial folder.
    pub fn in_folder(self, folder: Option<PathBuf>) -> Self {
        Self { folder, ..self }
    }

    /// With an initial file name.
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
            Self::Import => "Import a scene or a picture",
            Self::CollectFolder => "Folder for the project and all its files",
            Self::Frames => "Choose a rendered frame",
            Self::SaveReport => "Save the report",
            Self::Asset(AssetUse::Mesh | AssetUse::MeshFile(_)) => "Choose a mesh",
            Self::Asset(AssetUse::Picture(_)) => "Choose a picture",
            Self::Asset(AssetUse::Plate) => "Choose a background plate",
            Self::Asset(AssetUse::Points(_)) => "Choose a file of points",
        }
    }

    /// Name and extensions of the wanted files; no extension means a folder.
    pub(in crate::editor) fn files(&self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::OpenProject | Self::SaveProject => ("Lightloom projects", &["json", "lightloom"]),
            Self::ExportFolder | Self::CollectFolder => ("Folders", &[]),
            Self::Import => ("Scenes and pictures", IMPORTED),
            Self::Frames => ("Pictures", &["png", "jpg", "jpeg"]),
            Self::SaveReport => ("Texts", &["txt"]),
            Self::Asset(pick) => pick.files(),
        }
    }

    pub(super) fn saves(&self) -> bool {
        matches!(self, Self::SaveProject | Self::SaveReport)
    }
}

/// The path with the usual extension where the user typed none.
pub(super) fn with_ending(purpose: &Purpose, path: PathBuf) -> PathBuf {
    match purpose.files().1.first() {
        Some(usual) if purpose.saves() && path.extension().is_none() => path.with_extension(usual),
        _ => path,
    }
}
