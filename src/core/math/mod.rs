//! Numerics: random streams, splines, grids and solvers; independent of all other modules.

pub mod bspline;
pub mod cg;
pub mod cholesky;
pub mod colour;
pub mod dense;
mod direct;
mod dissection;
pub mod distribution;
pub mod hilbert;
pub mod kronecker;
pub mod lanczos;
pub mod mirror;
pub mod mixed_gram;
pub mod multigrid;
pub mod normal_blocks;
pub mod null_space;
pub mod operator;
pub mod real;
pub mod rng;
pub mod smoothstep;
pub mod sobol;
mod sparse_cholesky;
pub mod stencil;
mod stiff_nodes;
pub mod sum;
pub mod transfer;
pub mod vector;
