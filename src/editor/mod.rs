//! The window: draw, tune, scrub, compare, export, save.

pub mod store;
