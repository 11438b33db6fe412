//! How photons move where walls stand.
//!
//! The test whether a wall is crossed is exact, see [`crate::constraint::barrier`]; [`crate::constraint::visibility`] finds
//! the paths around walls.

mod bounce;
mod clearance;
mod columns;
mod obstacles;
mod path_state;
mod violations;
mod walker;

pub(super) use bounce::bounce;
pub(super) use clearance::Clearance;
pub(super) use columns::{Columns, WallColumns};
pub(super) use obstacles::{Obstacles, SUBSTEPS};
pub use violations::WallViolations;
pub(super) use walker::slide;
