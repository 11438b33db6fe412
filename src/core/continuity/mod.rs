//! How well a body of light holds together while it moves, from the positions of photons alone.
//!
//! A morph may arrive exactly and still look broken half way: dark seams open between its parts, photons leave the
//! neighbours they had, light piles up in one place, single photons dash. [`Continuity`] has one figure for each. All are
//! taken from the photons at evenly spaced times, whatever moved them, so that methods can be compared.
//!
//! Definitions, with the longer side of the plane being 1:
//!
//! | figure | definition |
//! |---|---|
//! | cracks | Number density on cells of 1/256, blurred by a Gaussian of 1.6 cells, closed with a disc of radius 6 cells: what the closing fills in, over all light, less what the two keys have of it (interpolated linearly in time). |
//! | torn | Share of photons whose 12 neighbours in a key leave every one affine map by more than two neighbour distances: root mean square residual of the least-squares map over the distance of the twelfth neighbour. |
//! | bunch | Photons in the fullest cell of 1/64 at any time, over the same of the fuller key. |
//! | fastest | Distance per time over the mean distance \|b - a\|: the fastest photon, and the 99.9 % quantile of each time. |
//!
//! Grey closing: Serra 1982, *Image Analysis and Mathematical Morphology*, ch. XII.

mod closing;
mod figure;
mod measure;
mod neighbourhoods;
mod pace;
mod picture;
mod seams;
mod table;

use serde::Serialize;

pub use figure::{FIGURES, Figure};
pub use measure::measure;
pub use neighbourhoods::{Neighbourhoods, TORN};
pub use seams::Seams;
pub use table::{Row, Table};

/// Photons that are looked at: enough for 1/256 cells, few enough for a tenth of a second.
pub const PHOTONS: usize = 20_000;

/// The figures of one body of light between two keys.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Continuity {
    /// Largest share of the light that dark seams lack, beyond that of the keys; 0 where nothing cracks.
    pub cracks: f64,
    /// The same as a mean over time; below 0 where the keys have more seams than the way between them.
    pub cracks_mean: f64,
    /// Share of photons torn from their neighbours in the source, at t = 0.5.
    pub torn_source: f64,
    /// Share of photons not yet together with their neighbours in the target, at t = 0.5.
    pub torn_target: f64,
    /// The same at t = 0.75.
    pub torn_target_late: f64,
    /// Fullest cell at any time over that of the fuller key; 1 where light never piles up.
    pub bunch: f64,
    /// Fastest photon over the mean straight speed.
    pub fastest: f64,
    /// The same of the 99.9 % quantile, at the time where it is largest.
    pub fastest_999: f64,
    /// Longest straight way over the mean straight way: the fastest photon of straight lines.
    pub fastest_straight: f64,
    /// Root mean square distance at which the photons of both keys miss each other where they meet, plane units; absent
    /// where a method has no meeting.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gap: Option<f64>,
}

impl Continuity {
    /// The worse of two in each figure.
    pub fn worst(&self, other: &Self) -> Self {
        let (a, b) = (self, other);
        Self {
            cracks: a.cracks.max(b.cracks),
            cracks_mean: a.cracks_mean.max(b.cracks_mean),
            torn_source: a.torn_source.max(b.torn_source),
            torn_target: a.torn_target.max(b.torn_target),
            torn_target_late: a.torn_target_late.max(b.torn_target_late),
            bunch: a.bunch.max(b.bunch),
            fastest: a.fastest.max(b.fastest),
            fastest_999: a.fastest_999.max(b.fastest_999),
            fastest_straight: a.fastest_straight.max(b.fastest_straight),
            gap: [a.gap, b.gap].into_iter().flatten().reduce(f64::max),
        }
    }
}

/// At most [`PHOTONS`] of `count` rows, evenly spaced.
pub fn chosen_rows(count: usize) -> Vec<usize> {
    evenly_spaced(count, PHOTONS)
}

/// At most `most` of the numbers 0..count, evenly spaced.
fn evenly_spaced(count: usize, most: usize) -> Vec<usize> {
    let chosen = count.min(most);
    (0..chosen).map(|i| i * count / chosen).collect()
}
