//! Tools receive gestures in plane coordinates and answer with actions, so each is tested without a window.

pub mod arrange;
pub mod bar;
mod curve;
mod cut;
mod directed_line;
mod erase;
mod icon;
mod pan;
mod pen;
mod pick;
mod probe;
mod select;
mod snap;
mod target;
mod tool;
mod toolbox;
mod wall;
mod zoom;

pub use target::target_corners;
pub use tool::{Gesture, Ghost, Grip, Held, Look, Tool};
pub(crate) use toolbox::is_covered;
pub use toolbox::{Toolbox, all};
