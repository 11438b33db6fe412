//! The window: draw, tune, scrub, compare, export, save. No algorithm of light lives here: it shows and changes a
//! project and calls the core.

pub mod action;
mod app;
pub mod canvas;
pub mod clipboard;
pub mod command;
pub mod document;
pub mod panels;
pub mod pick;
pub mod playback;
pub mod preview;
pub mod selection;
pub mod session;
pub mod shortcuts;
mod start;
pub mod store;
pub mod templates;
pub mod theme;
pub mod timeline;
pub mod tools;
mod views;

pub use app::App;
pub use start::run;
