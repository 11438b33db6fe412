//! The editor, without a screen.
#![allow(missing_docs, clippy::unwrap_used)]

mod app;
mod canvas;
mod crash;
mod device;
mod dialogs;
mod document;
mod export_window;
mod files;
mod flow_view;
mod import;
mod notes;
mod orbit_view;
mod palette;
mod panels;
mod photon_drawing;
mod player;
mod report;
mod scene;
mod shown_light;
mod store;
mod timeline;
mod tools;
#[path = "../window/mod.rs"]
mod window;
