//! The kernel: one box of fractional length, applied several times.

/// Number of boxes.
pub(super) const BOXES: usize = 3;
/// Numbers per texel.
pub(super) const LANES: usize = 4;

/// A box of 2 `half` + 1 cells and `edge` of a cell more on either side.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExtendedBox {
    pub half: usize,
    pub edge: f64,
}

impl ExtendedBox {
    /// The box whose variance, in cells squared, is `variance`.
    pub(super) fn with_variance(variance: f64) -> Self {
        // A box of 2k+1 cells has the variance k(k+1)/3; k is the largest that does not exceed it.
        let k = ((0.25 + 3.0 * variance).sqrt() - 0.5).floor().max(0.0);
        let missing = variance * (2.0 * k + 1.0) - k * (k + 1.0) * (2.0 * k + 1.0) / 3.0;
        let edge = missing / (2.0 * ((k + 1.0) * (k + 1.0) - variance));
        Self { half: k as usize, edge: edge.clamp(0.0, 1.0) }
    }

    pub(super) fn is_identity(&self) -> bool {
        self.half == 0 && self.edge < 1e-9
    }

    /// Its reach to either side, cells.
    pub(super) fn reach(&self) -> usize {
        self.half + 1
    }

    /// The three boxes as one kernel: the weight at the centre and at each distance; they sum to 1 over both sides.
    pub(super) fn weights(&self) -> Vec<f32> {
        let norm = 1.0 / (2.0 * self.half as f64 + 1.0 + 2.0 * self.edge);
        let mut one = vec![norm; 2 * self.reach() + 1];
        (one[0], one[2 * self.reach()]) = (self.edge * norm, self.edge * norm);
        let convolved = (1..BOXES).fold(one.clone(), |kernel, _| {
            let mut sum = vec![0.0; kernel.len() + one.len() - 1];
            for (i, k) in (0..kernel.len()).flat_map(|i| (0..one.len()).map(move |k| (i, k))) {
                sum[i + k] += kernel[i] * one[k];
            }
            sum
        });
        convolved[convolved.len() / 2..].iter().map(|&weight| weight as f32).collect()
    }
}
