//! Storage: project files, the autosave journal, and preferences.
//!
//! ```text
//! every change ──► Journal ──► <state folder>/recovery/<id>.json    at most a second later
//! open, save   ──► Saver   ──► the user's file, its previous version as <state folder>/backups/….bak
//! next start   ──► recoverable ──► what a crash left there, to be recovered or discarded
//! ```
//!
//! Nothing here knows a window; all reading and writing runs on threads.

pub mod folders;
pub mod journal;
pub mod preferences;
pub mod recovery;
pub mod saver;

mod disk;
mod record;
mod slot;

pub use disk::Fingerprint;
pub use folders::Folders;
pub use journal::{Journal, Note};
pub use preferences::{PhotonRenderer, Preferences, Theme};
pub use recovery::{Recovery, recoverable};
pub use saver::{Opened, SaveRequest, Saved, Saver, StoreReply, StoreRequest};
