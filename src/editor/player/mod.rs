//! The player of rendered frames: a window that plays a numbered sequence of pictures at its frame rate.

mod clock;
mod loader;
mod noise;
mod sequence;
mod window;

pub use clock::Clock;
pub use loader::{Loader, Slot};
pub use sequence::Sequence;
pub use window::Player;
