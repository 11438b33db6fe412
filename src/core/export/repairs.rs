//! What had to be repaired in a frame.

/// Counts of samples that the file format cannot hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RepairedSamples {
    /// Samples beyond the largest half float, clamped to it.
    pub half_clamped: u64,
    /// Samples that were not finite, replaced by 0.
    pub nonfinite_replaced: u64,
}

impl std::ops::AddAssign for RepairedSamples {
    fn add_assign(&mut self, other: Self) {
        self.half_clamped += other.half_clamped;
        self.nonfinite_replaced += other.nonfinite_replaced;
    }
}
