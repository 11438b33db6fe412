//! State of the window's files: the threads that read and write them, and pending requests.

use std::path::PathBuf;
use std::sync::Arc;

use lightloom_core::project::{Admitted, Project};
use lightloom_core::targets::{ImageTarget, Placement};

use super::task::Task;
use crate::editor::access::Access;
use crate::editor::asset::{AssetUse, TargetSlot};
use crate::editor::dialogs::Question;
use crate::editor::export::InterruptedExport;
use crate::editor::store::{
    Backup, Fingerprint, Folders, Journal, Preferences, Recovery, SaveRequest, Saver, StoreRequest, Watch,
    trusted,
};

/// The file threads, and the requests they have not answered yet.
pub(super) struct Files {
    pub(super) saver: Option<Saver>,
    pub(super) journal: Option<Journal>,
    /// The open question, and what its answer decides.
    pub(super) question: Option<(Question, PendingQuestion)>,
    /// What follows once the document is saved.
    pub(super) after_save: Option<Leave>,
    /// Questions that wait until that one is answered.
    pub(super) waiting: Vec<(Question, PendingQuestion)>,
    /// The file being read, where it is not opened as what it is.
    pub(super) opening: Option<(PathBuf, Opening)>,
    /// The picked file whose place is looked at, and its use.
    pub(super) located: Option<(PathBuf, AssetUse)>,
    /// Files that the user trusts for good.
    pub(super) trusted: Admitted,
    /// Files outside of its folder that the open project may read: those, and what was picked or allowed.
    pub(super) admitted: Admitted,
    /// What is done with files from elsewhere, once the user said so for the open document.
    pub(super) outside: Option<Elsewhere>,
    /// Whether the user wants to be asked about files outside of the folder.
    pub(super) asks_outside: bool,
    /// Earlier versions of the document's file, newest first.
    pub(super) backups: Vec<Backup>,
    /// Unsaved work of earlier runs that was not offered yet.
    pub(super) lost: Vec<Recovery>,
    /// Looks whether the project's files change.
    pub(super) watch: Option<Watch>,
    /// Counts those changes.
    pub(super) edition: u64,
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
    /// Another program changed the file, which has this fingerprint now.
    ChangedMeanwhile(PathBuf, Fingerprint),
    /// A picked file lies outside of the project's folder.
    Pick(PathBuf, AssetUse),
    /// Files of the opened project lie outside of its folder.
    Outside(Vec<PathBuf>),
    Nothing,
}

/// What a file is opened as.
#[derive(Clone, Debug)]
pub(super) enum Opening {
    /// A new document with its content.
    Template,
    /// An earlier version of this file, which has that fingerprint.
    Backup(PathBuf, Fingerprint),
}

/// What is done with files that lie outside of the project's folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Elsewhere {
    /// They are copied beside the project when it is saved.
    Copy,
    /// They stay where they are, and are trusted for good.
    Trust,
}

/// What there is to say beyond the message in the status bar.
#[derive(Clone)]
pub(super) struct Details {
    /// That message: without it there are no details to show.
    pub(super) status: String,
    pub(super) title: String,
    pub(super) text: String,
}

/// A picture whose place is being found.
pub(super) struct Placing {
    pub(super) at: TargetSlot,
    pub(super) target: ImageTarget,
    pub(super) task: Task<Placement>,
}

/// What follows when the document is left.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Leave {
    Quit,
    Open(PathBuf),
    Backup(PathBuf),
    New(usize),
    Empty,
}

impl Files {
    /// Starts the threads and looks for work that a crash left. Without folders nothing can be saved.
    pub(super) fn start(folders: Option<Folders>, wake: impl Fn() + Clone + Send + 'static) -> Self {
        let watch = Watch::start(wake.clone());
        let saver = folders.clone().and_then(|folders| Saver::start(folders, wake).ok());
        if let Some(saver) = &saver {
            saver.ask(StoreRequest::LookForLost);
        }
        let trusted = trusted(folders.as_ref());
        let journal = folders.as_ref().map(|folders| Journal::start(folders.recovery()));
        Self {
            saver,
            journal,
            question: None,
            after_save: None,
            waiting: Vec::new(),
            opening: None,
            located: None,
            admitted: Admitted::new(trusted.files()),
            trusted,
            outside: None,
            asks_outside: false,
            backups: Vec::new(),
            lost: Vec::new(),
            watch,
            edition: 0,
            last_sent: LastSent::default(),
            title: String::new(),
            closing: false,
        }
    }

    /// Which files outside of its folder the project may read now.
    pub(super) fn access(&self) -> Access {
        Access::of(&self.admitted).at(self.edition)
    }

    /// Only what is trusted may be read by another document.
    pub(super) fn forget_admitted(&mut self) {
        self.admitted = Admitted::new(self.trusted.files());
        (self.outside, self.located) = (None, None);
        self.backups.clear();
    }

    /// Nothing is trusted any more; what the open project reads stays allowed until it is closed.
    pub(super) fn forget_trusted(&mut self) {
        self.trusted = Admitted::default();
        self.request(StoreRequest::ForgetTrusted);
    }

    /// Asks a question now, or after the open one.
    pub(super) fn ask(&mut self, question: Question, pending: PendingQuestion) {
        match self.question {
            None => self.question = Some((question, pending)),
            Some(_) => self.waiting.push((question, pending)),
        }
    }

    /// Sends a request to the saver; false where there is none.
    pub(super) fn request(&self, request: StoreRequest) -> bool {
        self.saver.as_ref().map(|saver| saver.ask(request)).is_some()
    }
}

/// The project, its files and the preferences that were sent to the threads last.
#[derive(Default)]
pub(super) struct LastSent {
    pub(super) project: Option<Arc<Project>>,
    pub(super) preferences: Option<Preferences>,
    /// The files that are watched.
    pub(super) watched: Vec<PathBuf>,
}
