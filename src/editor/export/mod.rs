//! Exports beside editing: each renders a frozen project on threads of its own, one after the other.

mod job;
mod queue;
mod strip;
mod window;
mod wish;

pub use job::{Cost, Growing, Job, Order, Outcome, Stage};
pub use queue::Exports;
pub use strip::strip;
pub use window::ExportWindow;
pub use wish::Wish;
