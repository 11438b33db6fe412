//! Lightloom's core: from a glass and a picture to a rendered caustic animation.

pub mod error;
pub mod progress;

pub mod files;

pub mod math;

pub mod scene;

pub mod photon;

pub mod target;

pub mod matching;

pub mod flow;

pub mod render;

pub mod export;

pub mod project;

pub mod pipeline;

pub use error::{Error, Result};
pub use progress::Progress;
