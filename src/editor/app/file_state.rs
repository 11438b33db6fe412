//! State of the window's files: the threads that read and write them, and pending requests.

use std::path::PathBuf;
use std::sync::Arc;

use lightloom_core::project::Project;

use crate::editor::dialogs::Question;
use crate::editor::export::InterruptedExport;
use crate::editor::store::{Folders, Journal, Preferences, Recovery, SaveRequest, Saver, StoreRequest};

/// The file threads, and the requests they have not answered yet.
pub(super) struct Files {
    pub(super) saver: Option<Saver>,
    pub(super) journal: Option<Journal>,
    /// The open question, and what its answer decides.
    pub(super) question: Option<(Question, PendingQuestion)>,
    /// What follows once the document is saved.
    pub(super) after_save: Option<Leave>,
    /// The template being read.
    pub(super) template: Option<PathBuf>,
    /// Unsaved work of earlier runs that was not offered yet.
    pub(super) lost: Vec<Recovery>,
    /// The last state sent to the threads, and the window's title.
    pub(super) last_sent: LastSent,
    pub(super) title: String,
    pub(super) closing: bool,
}

/// The decision that an answered question makes.
pub(super) enum PendingQuestion {
    Leave(Leave),
    Recover(Box<Recovery>),
    Changed(Box<SaveRequest>),
    Export(Box<InterruptedExport>),
    Nothing,
}

/// What follows when the document is left.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Leave {
    Quit,
    Open(PathBuf),
    New(usize),
    Empty,
}

impl Files {
    /// Starts the threads and looks for work that a crash left. Without folders nothing can be saved.
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

    /// Sends a request to the saver; false where there is none.
    pub(super) fn request(&self, request: StoreRequest) -> bool {
        self.saver.as_ref().map(|saver| saver.ask(request)).is_some()
    }
}

/// The project and preferences that were sent to the threads last.
#[derive(Default)]
pub(super) struct LastSent {
    pub(super) project: Option<Arc<Project>>,
    pub(super) preferences: Option<Preferences>,
}
