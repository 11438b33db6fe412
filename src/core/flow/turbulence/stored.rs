//! Turbulence taken apart for a file, and put together again.

use glam::Vec2;

use super::Turbulence;
use crate::flow::field::{Field, Grid};
use crate::math::bspline::EXTRA;

impl Turbulence {
    /// Turbulence of known key noises: one field per grid for each key, the first key being the last one before the
    /// segment begins. `rate` is the key noises per unit of t, `number` the segment from 0, `speed` the root mean square
    /// speed. None where a key is missing.
    pub fn from_keys(keys: Vec<Vec<Field>>, rate: f32, number: usize, speed: f32) -> Option<Self> {
        let mut turbulence = Self { keys, first: 0, rate: rate.into(), number, speed };
        let [first, last] = [0.0, 1.0].map(|t| turbulence.place(t).0);
        turbulence.first = first;
        let needed = usize::try_from(last - first).ok()?.checked_add(2)?;
        let grids = turbulence.keys.first()?.len();
        let whole = turbulence.keys.len() >= needed && turbulence.keys.iter().all(|key| key.len() == grids);
        whole.then_some(turbulence)
    }

    /// The key noises, of each one field per grid.
    pub fn keys(&self) -> &[Vec<Field>] {
        &self.keys
    }

    /// Key noises per unit of t.
    pub fn rate(&self) -> f32 {
        self.rate as f32
    }

    /// The segment of the animation, from 0.
    pub fn segment(&self) -> usize {
        self.number
    }

    /// The noise grid of `cells` square cells along the plane's longer side that has this many coefficients along x and y.
    pub fn grid(cells: usize, nodes: [usize; 2]) -> Option<Grid> {
        let [x, y] = [nodes[0].checked_sub(EXTRA)?, nodes[1].checked_sub(EXTRA)?];
        let extent = Vec2::new(x as f32, y as f32) / cells as f32;
        (x > 0 && y > 0 && cells > 0).then_some(Grid { cells: [x, y], extent })
    }
}
