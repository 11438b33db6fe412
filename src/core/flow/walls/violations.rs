//! Photons that walls did not hold.

/// Photons that walls did not hold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WallViolations {
    /// Photons whose target no path reaches: they go straight.
    pub unreachable: usize,
    /// Wall crossings of photons that have a path; 0 unless the program is wrong.
    pub crossings: usize,
}

impl WallViolations {
    /// The sum of both.
    pub fn plus(self, other: Self) -> Self {
        Self {
            unreachable: self.unreachable + other.unreachable,
            crossings: self.crossings + other.crossings,
        }
    }
}
