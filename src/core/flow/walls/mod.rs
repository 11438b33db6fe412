//! How photons move where walls stand.
//!
//! The test whether a wall is crossed is exact, see [`crate::constraint::barrier`]; [`crate::constraint::visibility`] finds
//! the paths around walls.

mod clearance;
mod columns;
mod moves;
mod obstacles;
mod path_state;
mod violations;
mod walker;

pub(super) use clearance::Clearance;
pub(super) use columns::{Columns, WallColumns};
pub(super) use moves::{bounce, slide};
pub(super) use obstacles::{Obstacles, SUBSTEPS};
pub use violations::WallViolations;
