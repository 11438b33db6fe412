//! Where photons should go: pictures and points.
