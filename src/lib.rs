//! Lightloom, the program: the command line over [`lightloom_core`].

pub mod cli;
pub mod editor;
