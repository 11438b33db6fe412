//! Who looks on while a render grows.

use super::Plan;
use crate::Result;
use crate::render::Image;

/// Told of a render on its way. Nothing is made for an onlooker that does not ask.
pub trait Onlooker: Sync {
    /// The project and its files are in order; this will be done, and cost so much.
    fn planned(&self, _plan: &Plan) {}

    /// `passes` passes are complete. `picture` makes the picture of a frame as it stands, in screen values; there is none
    /// of a frame that is not rendered.
    fn passed(&self, _passes: usize, _picture: &dyn Fn(i32) -> Result<Option<Image>>) {}
}

/// Nobody.
impl Onlooker for () {}
