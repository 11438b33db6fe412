//! From photons to pictures (Sec. 4).

pub mod density;
pub mod image;
pub mod splat;
pub mod texture;
