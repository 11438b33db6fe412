//! The vector field (Sec. 3): photons flow from one key frame to the next.
//!
//! At each time step the field is fitted ([`fit`]), then carries the photons on. By default it is fitted to the velocities of a
//! plan, from both key frames to their [`meeting`]. In the method of the paper it is fitted to the [`guidance`] of the photons
//! (`step`, `photons`); by the [`fade`] they leave it and arrive exactly. [`Fields`] and
//! [`MeetingFields`](meeting::MeetingFields) keep the fields for the photons of all later passes. The methods for comparison ([`MotionMethod`]) have closed-form paths. [`SegmentFlow`] is either; its
//! [`Trajectories`] give positions at any time.
//!
//! # The fade, measured
//!
//! 40 000 photons, 64 x 64 cells, 30 steps, transport matching, joint fit; the paper's fade (tau 0.85) / the default. peak: 99.9 % fastest
//! photon over the mean straight speed; dispersion: neighbour-velocity variance over mean square, largest of the run;
//! field: share of the motion that the field steers; wander: distance from the straight paths over their length.
//!
//! | gamma | peak | dispersion | field | wander |
//! |---|---|---|---|---|
//! | caustic to flower (straight lines: 1.7) | | | | |
//! | 0 | 16.7 / 2.7 | .095 / .015 | .86 / .58 | .21 / .14 |
//! | 0.25 | 12.3 / 2.5 | .301 / .021 | .92 / .60 | .09 / .06 |
//! | 0.5 | 12.2 / 2.5 | .337 / .021 | .92 / .60 | .08 / .05 |
//! | 1 | 12.0 / 2.4 | .334 / .021 | .92 / .61 | .07 / .05 |
//! | letter C to letter S in one place (straight lines: 3.3) | | | | |
//! | 0 | 56.3 / 4.6 | .130 / .054 | .79 / .45 | .39 / .18 |
//! | 0.25 | 27.0 / 4.4 | .264 / .062 | .88 / .53 | .18 / .12 |
//! | 0.5 | 29.6 / 4.2 | .366 / .066 | .90 / .56 | .15 / .10 |
//! | 1 | 32.9 / 4.2 | .356 / .068 | .89 / .57 | .15 / .09 |
//!
//! No fade can go below the straight lines, or photons would not arrive in time. Tried and left: 1 - s = (1-t)^q for all
//! (less wander at a higher peak); no speed limit (letters at gamma 0: 6.1 even with the fade from 0.2 to 0.8); a limit
//! that acts below 1.2 times a photon's own straight speed (letters 3.5, but long paths leave the flow at once and tear).

pub mod fade;
pub mod field;
pub mod fit;
pub mod flux;
pub mod guidance;
pub mod meeting;
pub mod metric;
pub mod movement;
pub mod settings;
pub mod turbulence;

mod field_trajectories;
mod fields;
mod fit_segment;
mod observer;
mod path_trajectories;
mod photons;
mod report;
mod segment;
mod segment_flow;
mod spatial_order;
mod step;
mod trajectories;
mod walls;

pub use fade::Fade;
pub use field_trajectories::FieldTrajectories;
pub use fields::Fields;
pub use fit_segment::{GuideTracks, Snapshots, fit_segment, fit_tracks, fit_with_snapshots};
pub use movement::MotionMethod;
pub use path_trajectories::{PathTrajectories, path_report};
pub use report::FlowReport;
pub use segment::Segment;
pub use segment_flow::SegmentFlow;
pub use settings::{FitKind, FlowSettings, GridSize};
pub use spatial_order::spatial_order;
pub use trajectories::Trajectories;
pub use turbulence::{Turbulence, TurbulenceSettings};
pub use walls::WallViolations;
