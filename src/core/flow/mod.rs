//! The vector field (Sec. 3).

pub mod field;
pub mod fit;
