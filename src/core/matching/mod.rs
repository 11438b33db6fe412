//! The bijection between source and target (Sec. 3): which photon goes where.
//!
//! Two steps, so that millions of photons in many passes move together:
//!
//! 1. [`TransportMap`]: the optimal (Brenier) map between the two *densities*, once per segment, by the back-and-forth method.
//! 2. [`Matching`]: an exact bijection between the *points* of one pass, near that map: bisection, then local 2-opt swaps.
//!
//! Where walls stand, [`WallMap`] takes the place of the transport map. [`StylizedMap`] is the previous method (2016), for
//! comparison. [`ContinuousMap`] is any of the three.
//!
//! Cost is squared distance throughout: its optimum never lets two straight paths collide, which is what ghosting is made of.

mod back_and_forth;
mod bijection;
mod bisection;
mod continuous_map;
mod dual;
mod lattice;
mod legendre;
mod poisson;
mod push_forward;
mod settings;
mod stylized;
mod transport_map;
mod two_opt;
mod wall_map;

pub use bijection::{Matching, SWEEPS, mean_square_distance};
pub use continuous_map::{ContinuousMap, Pairing};
pub use dual::dual_bound;
pub use settings::{MapSettings, MatchingMethod};
pub use stylized::StylizedMap;
pub use transport_map::{TransportMap, transport_map, transport_map_with};
pub use wall_map::{ANCHORS, WallMap};
