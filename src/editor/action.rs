//! Actions: what panels and tools ask for. The editor carries them out; a panel never does.

use std::collections::BTreeSet;
use std::path::PathBuf;

use lightloom_core::note::About;

use super::asset::{AssetUse, TargetSlot};
use super::command::Command;
use super::document::Edit;
use super::look::object::SceneObject;
use super::selection::Selection;
use super::session::Panel;

/// An action asked for in one frame of the window.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Changes the project; all edits of one gesture are one undo step.
    Edit(Edit),
    /// Ends the gesture: the next edit is a new undo step.
    Settle,
    /// Cancels the gesture and restores the project.
    Abort,
    /// A command, as from a menu or a shortcut.
    Command(Command),
    /// Selects a tool by its index.
    Tool(usize),
    /// Shows a panel.
    Panel(Panel),
    /// Pastes text from the clipboard.
    Paste(String),
    /// Replaces the selection.
    Select(Selection),
    /// Selects an object of the scene.
    SelectObject(SceneObject),
    /// Moves the playhead to a frame.
    Playhead(i32),
    /// Shows these caustics only, by group; empty shows all.
    Solo(BTreeSet<usize>),
    /// Follows the photon in this row, or none.
    Probe(Option<usize>),
    /// Opens a project file.
    Open(PathBuf),
    /// Opens a backup of the document's file.
    OpenBackup(PathBuf),
    /// Plays the rendered frames of a folder, or those that a picture belongs to.
    PlayFrames(PathBuf),
    /// Starts a project from a template, by index.
    New(usize),
    /// Asks for a file and puts it into the project.
    PickFile(AssetUse),
    /// Lays the picture of a target where the caustic falls that becomes it, as large.
    PlacePicture(TargetSlot),
    /// Shows and selects what a note is about.
    Show(About),
    /// Shows a message in the status bar.
    Say(String),
}

impl From<Edit> for Action {
    fn from(edit: Edit) -> Self {
        Self::Edit(edit)
    }
}

impl From<Command> for Action {
    fn from(command: Command) -> Self {
        Self::Command(command)
    }
}
