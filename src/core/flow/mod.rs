//! The vector field (Sec. 3).

pub mod assembly;
pub mod bending;
pub mod field;
pub mod fit;
