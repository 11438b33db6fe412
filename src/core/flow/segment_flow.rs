//! The flow of one segment.

use glam::Vec2;

use super::field_trajectories::FieldTrajectories;
use super::fields::Fields;
use super::path_trajectories::PathTrajectories;
use super::trajectories::Trajectories;

/// The flow of one segment: fitted fields, or closed-form paths.
pub enum SegmentFlow {
    /// Fitted fields.
    Fields(Fields),
    /// Paths given by their ends and midpoint offsets.
    Paths,
}

impl SegmentFlow {
    /// The trajectories of photons at `source` bound for `targets`, row by row. `midpoint_offsets` are those of their
    /// pairing; fields ignore them.
    ///
    /// # Panics
    /// When the columns differ in length.
    pub fn trajectories<'a>(
        &'a self,
        source: &'a [Vec2],
        targets: &'a [Vec2],
        midpoint_offsets: &'a [Vec2],
    ) -> Box<dyn Trajectories + 'a> {
        match self {
            Self::Fields(fields) => Box::new(FieldTrajectories::new(fields, source, targets)),
            Self::Paths => Box::new(PathTrajectories::new(source, targets, midpoint_offsets)),
        }
    }

    /// The fields, where there are any.
    pub fn fields(&self) -> Option<&Fields> {
        match self {
            Self::Fields(fields) => Some(fields),
            Self::Paths => None,
        }
    }
}
