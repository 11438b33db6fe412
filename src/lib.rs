//! Lightloom: the command line and the window around the core.

pub mod cli;
pub mod editor;
mod file_lock;
pub mod log;
pub mod processor;
