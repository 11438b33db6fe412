//! The program itself, started as a script or a hand starts it.
#![allow(missing_docs, clippy::unwrap_used)]

mod cli;
mod compare;
mod crash;
mod real_window;
#[path = "../scenes/mod.rs"]
mod scenes;
#[path = "../window/mod.rs"]
mod window;
