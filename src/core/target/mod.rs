//! Where the photons should go (Sec. 3).
