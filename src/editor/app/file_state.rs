//! What the window knows of its files: the threads that read and write them, and what it waits for.

use std::path::PathBuf;
use std::sync::Arc;

use lightloom_core::project::Project;

use crate::editor::dialogs::Question;
use crate::editor::store::{Folders, Journal, Preferences, Recovery, SaveRequest, Saver, StoreRequest};

/// The threads that read and write, and what is waited for.
pub(super) struct Files {
    pub(super) saver: Option<Saver>,
    pub(super) journal: Option<Journal>,
    /// The question that is open, and what its answer decides.
    pub(super) question: Option<(Question, PendingQuestion)>,
    /// What shall be done once the document is saved.
    pub(super) after_save: Option<Leave>,
    /// The example that is being read.
    pub(super) template: Option<PathBuf>,
    /// Work of earlier runs that is still to be asked for.
    pub(super) lost: Vec<Recovery>,
    /// What was handed to the threads last, and the window's title.
    pub(super) last_sent: LastSent,
    pub(super) title: String,
    pub(super) closing: bool,
}

/// What an answer decides.
pub(super) enum PendingQuestion {
    Leave(Leave),
    Recover(Box<Recovery>),
    Changed(Box<SaveRequest>),
    Nothing,
}

/// Why the document is left.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Leave {
    Quit,
    Open(PathBuf),
    New(usize),
}

impl Files {
    /// Starts the threads and looks for work that a crash left. Without folders the documents can be shown, not saved.
    pub(super) fn start(folders: Option<Folders>, wake: impl Fn() + Send + 'static) -> Self {
        let saver = folders.clone().and_then(|folders| Saver::start(folders, wake).ok());
        if let Some(saver) = &saver {
            saver.ask(StoreRequest::LookForLost);
        }
        let journal = folders.as_ref().map(|folders| Journal::start(folders.recovery()));
        Self {
            saver,
            journal,
            question: None,
            after_save: None,
            template: None,
            lost: Vec::new(),
            last_sent: LastSent::default(),
            title: String::new(),
            closing: false,
        }
    }

    /// Asks the saver; false where there is none.
    pub(super) fn request(&self, request: StoreRequest) -> bool {
        self.saver.as_ref().map(|saver| saver.ask(request)).is_some()
    }
}

/// What was handed to the threads last.
#[derive(Default)]
pub(super) struct LastSent {
    pub(super) project: Option<Arc<Project>>,
    pub(super) preferences: Option<Preferences>,
}
