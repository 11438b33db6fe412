//! Observers of a growing render.

use super::Plan;
use crate::Result;
use crate::render::Image;

/// Observer of a growing render. Pictures are made only for an observer that asks for them.
pub trait RenderObserver: Sync {
    /// Whether the unfinished light of a run that is abandoned is kept for another that takes it up.
    fn keeps_unfinished(&self) -> bool {
        true
    }

    /// The project and its files are in order; this is the work ahead and its cost.
    fn planned(&self, _plan: &Plan) {}

    /// `passes` passes are complete. `picture` makes the current picture of a frame, in screen values; none for a frame
    /// that is not rendered.
    fn passed(&self, _passes: usize, _picture: &dyn Fn(i32) -> Result<Option<Image>>) {}
}

/// No observer.
impl RenderObserver for () {}
