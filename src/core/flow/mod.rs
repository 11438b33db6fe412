//! The vector field (Sec. 3).
