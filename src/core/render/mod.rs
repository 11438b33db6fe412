//! From photons to pictures (Sec. 4).
