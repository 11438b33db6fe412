//! Keeps the artist's work: the project file, the journal beside it, and what the editor remembers.
//!
//! ```text
//! every change ──► Journal ──► <state folder>/recovery/<id>.json    at most a second later, whatever happens to the window
//! open, save   ──► Saver   ──► the artist's file, its last version as <state folder>/backups/….bak
//! next start   ──► recoverable ──► what a crash left there, to be taken up or discarded
//! ```
//!
//! Nothing here knows a window, and nothing here is waited for: threads of their own read and write.

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
