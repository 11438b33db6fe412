//! Storage: project files, the autosave journal, and preferences.
//!
//! ```text
//! every change ──► Journal ──► <state folder>/recovery/<id>.json    at most a second later
//! open, save   ──► Saver   ──► the user's file, its last three versions as <state folder>/backups/….bak1 to 3
//! next start   ──► recoverable ──► what a crash left there, to be recovered or discarded
//! ```
//!
//! Nothing here knows a window; all reading and writing runs on threads.

pub mod folders;
pub mod journal;
pub mod preferences;
pub mod recovery;
pub mod saver;
pub mod trust;
pub mod watch;

mod attached;
mod backups;
mod collect;
mod disk;
mod record;
mod save;
mod slot;

pub use attached::Hold;
pub use backups::Backup;
pub use collect::{CollectRequest, collect};
pub use disk::Fingerprint;
pub use folders::Folders;
pub use journal::{Journal, Note};
pub use preferences::{PhotonRenderer, Preferences, Theme};
pub use recovery::{Recovery, recoverable};
pub use save::{Origin, SaveRequest, Saved};
pub use saver::{Opened, Saver, StoreReply, StoreRequest};
pub use trust::trusted;
pub use watch::Watch;

#[cfg(test)]
mod tests;
