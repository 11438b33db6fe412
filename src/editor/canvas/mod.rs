//! Views of the plane: live light, drawn constraints, overlays of the flow, and the active tool.

mod flat;
pub mod input;
mod interaction;
pub mod overlay;
pub mod plane_transform;
mod projected;

pub use flat::{Backdrop, Light, show};
pub use projected::{ProjectedPlane, show_projected};
