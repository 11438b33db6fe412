//! The flow of one segment.

use glam::Vec2;

use super::field::Field;
use super::field_trajectories::FieldTrajectories;
use super::fields::Fields;
use super::meeting::{HalfTracks, MeetingFields, MeetingTrajectories};
use super::path_trajectories::PathTrajectories;
use super::trajectories::Trajectories;
use super::turbulence::Turbulence;

/// The flow of one segment: fitted fields, or closed-form paths.
#[derive(serde::Deserialize, serde::Serialize)]
pub enum SegmentFlow {
    /// Fields fitted to the guidance of paired photons.
    Fields(Fields),
    /// Fields that carry both key frames to their meeting half way.
    Meeting(MeetingFields),
    /// Paths given by their ends and midpoint offsets.
    Paths,
}

impl SegmentFlow {
    /// The trajectories of photons at `source` bound for `targets`, row by row. `midpoint_offsets` are those of their
    /// pairing; fields ignore them. `tracks` are those to the meeting, where they are known.
    ///
    /// # Panics
    /// When the columns differ in length.
    pub fn trajectories<'a>(
        &'a self,
        source: &'a [Vec2],
        targets: &'a [Vec2],
        midpoint_offsets: &'a [Vec2],
        tracks: Option<&'a [HalfTracks; 2]>,
    ) -> Box<dyn Trajectories + 'a> {
        match self {
            Self::Meeting(fields) => Box::new(match tracks {
                Some(tracks) => {
                    MeetingTrajectories::with_tracks(fields, (source, targets), tracks.each_ref())
                }
                None => MeetingTrajectories::new(fields, source, targets),
            }),
            Self::Fields(fields) => Box::new(FieldTrajectories::new(fields, source, targets)),
            Self::Paths => Box::new(PathTrajectories::new(source, targets, midpoint_offsets)),
        }
    }

    /// The fields, where there are any.
    pub fn fields(&self) -> Option<&Fields> {
        match self {
            Self::Fields(fields) => Some(fields),
            Self::Meeting(_) | Self::Paths => None,
        }
    }

    /// The turbulence that is added to the fields.
    pub fn turbulence(&self) -> Option<&Turbulence> {
        match self {
            Self::Fields(fields) => fields.turbulence(),
            Self::Meeting(fields) => fields.turbulence(),
            Self::Paths => None,
        }
    }

    /// Time steps of the photons; none where paths have a closed form.
    pub fn steps(&self) -> Option<usize> {
        match self {
            Self::Fields(fields) => Some(fields.steps()),
            Self::Meeting(fields) => Some(fields.moves()),
            Self::Paths => None,
        }
    }

    /// The fields whose velocities add up at time `t`, 0..=1: the fitted field first, then the turbulence. Empty where none
    /// acts.
    pub fn at(&self, t: f64) -> Vec<Field> {
        match self {
            Self::Fields(fields) => fields.at(t),
            Self::Meeting(fields) => fields.at(t),
            Self::Paths => Vec::new(),
        }
    }
}
