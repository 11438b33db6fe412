//! From photons to pictures (Sec. 4).

pub mod density;
pub mod frames;
pub mod image;
pub mod settings;
pub mod splat;
pub mod texture;
pub mod view;

pub use settings::RenderSettings;
