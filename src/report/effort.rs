//! How much is measured.

/// Size of the inputs and number of runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// A project at preview size, the stability table at reduced size; within a minute.
    Quick,
    /// A project at its own size, the stability table as a final render has it; minutes to an hour.
    Full,
}

impl Effort {
    /// The first when quick, the second when full.
    pub(crate) fn pick<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
}
