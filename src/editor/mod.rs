//! The window: draw, tune, scrub, compare, export, save. No algorithm of light lives here: it shows and changes a
//! project and calls the core.

pub mod action;
mod app;
pub mod asset;
pub mod canvas;
pub mod clipboard;
pub mod command;
pub mod context;
pub mod dialogs;
pub mod document;
pub mod export;
pub mod keyboard;
pub mod menu;
pub mod palette;
pub mod panels;
pub mod playback;
pub mod preferences;
pub mod preview;
mod relative_path;
pub mod selection;
pub mod session;
pub mod shortcuts;
mod start;
pub mod store;
mod target_image;
pub mod templates;
pub mod theme;
pub mod timeline;
pub mod tools;
pub mod tour;
mod unique_name;
mod views;
pub mod welcome;

pub use app::{App, Gpu, Setup};
pub use start::run;
