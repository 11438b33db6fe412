//! Caustic photons (Sec. 2).
