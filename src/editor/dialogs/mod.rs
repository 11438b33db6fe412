//! Dialogs: file selection, questions and messages.
//!
//! [`Picker`] uses the system's file dialog, or a built-in one where the system has none.

mod browser;
mod modal;
mod native;
mod picker;
#[cfg(all(unix, not(target_os = "macos")))]
mod portal;
mod question;
mod request;
mod system;

pub(super) use modal::{is_on_top, modal};
pub use native::Native;
pub use picker::Picker;
pub use question::{Answer, Question};
pub use request::{Dialogs, PickRequest, PickResult, Purpose, Scripted};
