//! What panels and tools ask for. The application carries it out (`app.rs`); a panel never does.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::asset::AssetUse;
use super::command::Command;
use super::document::Edit;
use super::selection::Selection;
use super::session::Panel;

/// Something asked for in one frame of the window.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Change the project; one undo step with all of the same gesture.
    Edit(Edit),
    /// The gesture is over: the next edit is a step of its own.
    Settle,
    /// The gesture is broken off: the project is as before it.
    Abort,
    /// What also stands in a menu or has a shortcut.
    Command(Command),
    /// Take another tool, by its place in the list of tools.
    Tool(usize),
    /// Bring a panel to the front.
    Panel(Panel),
    /// Put in what the clipboard holds as text.
    Paste(String),
    /// Select what was drawn.
    Select(Selection),
    /// Go to a frame.
    Playhead(i32),
    /// Show only these caustics, by group; empty shows all.
    Solo(BTreeSet<usize>),
    /// Follow the photon of this row; none follows none.
    Probe(Option<usize>),
    /// Open a project.
    Open(PathBuf),
    /// Start from one of the templates.
    New(usize),
    /// Let the artist pick a file, and put it into the project.
    PickFile(AssetUse),
    /// Say something in the status bar.
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
