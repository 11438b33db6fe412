//! Tools: they receive gestures in plane coordinates and return actions, so each is tested without a window.

pub mod arrange;
mod curve;
mod cut;
mod directed_line;
mod erase;
pub mod groups;
mod hit_test;
mod icon;
mod pan;
mod pen;
mod probe;
mod select;
mod snap;
mod target;
mod tool;
pub mod toolbar;
mod toolbox;
mod wall;
mod zoom;

pub use target::target_corners;
pub use tool::{Gesture, Ghost, HeldKeys, PointerMode, Tool, ToolContext, ToolInfo};
pub use toolbox::{Toolbox, all};
