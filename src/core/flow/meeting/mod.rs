//! Flow that carries both key frames towards each other until they meet half way.
//!
//! The [`bridge`](crate::bridge) plans the motion of the whole body of light; psi and phi are fitted to its velocities
//! at every step, once for the light of the earlier key frame, which moves forward to t = 1/2, and once for that of the
//! later one, which moves backward ([`fit_meeting`]). Photons are paired where they meet ([`HalfTracks`]): the pairing is
//! short, the neighbourhoods of each key frame stay whole in its own half, and both ends are exact. The gap that is left at
//! the meeting is made up for evenly in both halves (`made_up`). What is rendered is diffused about these trajectories, most half
//! way and where a body tears (`diffusion`, `tears`); figures are of the trajectories themselves.

mod curve;
mod detours;
mod diffusion;
mod fields;
mod fit;
mod half_step;
mod leading_fit;
mod made_up;
mod runge_kutta;
mod segment;
mod tears;
mod tracks;
mod trajectories;
mod walks;
mod wall_motion;

pub use fields::MeetingFields;
pub use fit::{BridgeReport, MeetingFit, fit_meeting, fit_meeting_with};
pub use segment::MeetingSegment;
pub use tracks::HalfTracks;
pub use trajectories::{MeetingTrajectories, meeting_report};
