//! The bijection between source and target (Sec. 3): which photon goes where.
//!
//! Two steps, so that millions of photons in many passes move together:
//!
//! 1. [`TransportMap`]: the optimal (Brenier) map between the two *densities*, once per segment, by the back-and-forth method.
//! 2. [`Matching`]: an exact bijection between the *points* of one pass, near that map: equal halves, then local swaps.
//!
//! Beside it stands the method before this one, [`StylizedMap`], to compare with; [`ContinuousMap`] is either.
//!
//! Cost is squared distance throughout: its optimum never lets two straight paths collide, which is what ghosting is made of.

mod around;
mod back_and_forth;
mod bijection;
mod continuous_map;
mod dual;
mod halves;
mod lattice;
mod legendre;
mod poisson;
mod push_forward;
mod settings;
mod stylized;
mod swap;
mod transport_map;

pub use around::{ANCHORS, AroundMap};
pub use bijection::{Matching, SWEEPS, mean_square_distance};
pub use continuous_map::{ContinuousMap, Pairing};
pub use dual::dual_bound;
pub use settings::{MapSettings, Method};
pub use stylized::StylizedMap;
pub use transport_map::{TransportMap, transport_map, transport_map_with};
