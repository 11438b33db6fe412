//! Numbers: random streams, splines, grids and solvers. Knows nothing of light.

pub mod bspline;
pub mod distribution;
pub mod hilbert;
pub mod rng;
pub mod sobol;
