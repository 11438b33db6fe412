//! The window: draw, tune, scrub, compare, export, save. No algorithm of light lives here: it shows and changes a
//! project and calls the core.

pub mod action;
pub mod canvas;
pub mod command;
pub mod dialogs;
pub mod document;
pub mod export;
pub mod keys;
pub mod menu;
pub mod palette;
pub mod panels;
pub mod playback;
pub mod preferences;
pub mod preview;
pub mod selection;
pub mod session;
pub mod shortcuts;
pub mod store;
pub mod templates;
pub mod theme;
pub mod timeline;
pub mod tools;
pub mod tour;
pub mod welcome;

mod app;

use std::path::Path;

pub use app::App;

/// Opens the window, on a project or on the example. Returns when it is closed.
///
/// # Errors
/// There is no screen, or nothing that draws on it; the system's words.
pub fn run(_project: Option<&Path>) -> Result<(), String> {
    Err("it is not there yet".into())
}
