//! Questions to the user: which file, and what shall become of changes.
//!
//! [`Picker`] asks the system for its own file dialog, and shows a plain one of ours where the system has none.

mod browser;
mod modal;
mod native;
mod picker;
mod question;
mod request;

pub(super) use modal::modal;
pub use native::Native;
pub use picker::Picker;
pub use question::{Answer, Question};
pub use request::{Dialogs, PickRequest, PickResult, Purpose, Scripted};
