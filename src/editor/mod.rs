//! The window: draw, tune, scrub, compare, export, save. No algorithm of light lives here: it shows and changes a
//! project and calls the core.

pub mod action;
pub mod canvas;
pub mod clipboard;
pub mod command;
pub mod document;
pub mod panels;
pub mod preview;
pub mod selection;
pub mod session;
pub mod theme;
pub mod tools;
