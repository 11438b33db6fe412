//! The kernel of a plan: free motion, or motion around walls.

use super::gaussian::Gaussian;
use super::wall_kernel::WallKernel;

/// Standard deviation of the blur of densities, in cells.
const BLUR: f64 = 1.5;

/// How light may spread in the time that is left.
pub(super) enum Kernel {
    /// No walls: one Gaussian over the time left.
    Free { size: [usize; 2], over: Gaussian, blur: Gaussian },
    /// Many short steps around walls. `blur` of them make the blur of densities.
    Walls { steps: Box<WallKernel>, blur: usize },
}

impl Kernel {
    /// Free motion of variance `variance`, squared cells.
    pub(super) fn free(size: [usize; 2], variance: f64) -> Self {
        Self::Free { size, over: Gaussian::new(size, variance), blur: Gaussian::new(size, BLUR * BLUR) }
    }

    /// Motion around walls in steps of variance `step`, squared cells.
    pub(super) fn walls(steps: WallKernel, step: f64) -> Self {
        Self::Walls { steps: Box::new(steps), blur: (BLUR * BLUR / step).round().max(1.0) as usize }
    }

    /// Sets the window of time: all steps but the first and the last `first`, with the variance left in it.
    pub(super) fn set_window(&mut self, first: usize, variance: f64) {
        match self {
            Self::Free { size, over, .. } => *over = Gaussian::new(*size, variance),
            Self::Walls { steps, .. } => steps.set_window(first),
        }
    }

    /// `out` = the density of `side` (0 earlier, 1 later) at the other end of the window.
    pub(super) fn spread(&mut self, side: usize, density: &[f64], out: &mut [f64]) {
        match self {
            Self::Free { over, .. } => over.spread(density, out),
            Self::Walls { steps, .. } => steps.spread(side, density, out),
        }
    }

    /// As [`Self::spread`] with the walls at that side, and no cap on the way: a symmetric matrix.
    pub(super) fn spread_freely(&mut self, side: usize, density: &[f64], out: &mut [f64]) {
        match self {
            Self::Free { over, .. } => over.spread(density, out),
            Self::Walls { steps, .. } => steps.spread_freely(side, density, out),
        }
    }

    /// `out` = `density`, blurred by about a cell and a half.
    pub(super) fn blur(&mut self, side: usize, density: &[f64], out: &mut [f64]) {
        match self {
            Self::Free { blur, .. } => blur.spread(density, out),
            Self::Walls { steps, blur } => steps.blur(side, *blur, density, out),
        }
    }
}
