//! All figures of a body of light.

use glam::Vec2;
use rayon::prelude::*;

use super::neighbourhoods::Neighbourhoods;
use super::pace::Pace;
use super::picture::Picture;
use super::seams::Seams;
use super::{Continuity, evenly_spaced};
use crate::{Progress, Result};

/// Times at which seams are looked for, both keys included.
const PICTURES: usize = 11;
/// Photons whose neighbours are looked at.
const LOOKED_AT: usize = 6000;
/// Cells per plane unit in which light may bunch.
const BUNCH_CELLS: f32 = 64.0;

/// The figures of photons on a plane of this extent, whose longer side is 1: `frames` are their positions at evenly spaced
/// times from key to key, row by row, finite; at least two. Some 20 000 of them ([`super::chosen_rows`]) tell.
///
/// # Errors
/// `Cancelled`.
///
/// # Panics
/// When the frames have different numbers of photons.
pub fn measure(frames: &[Vec<Vec2>], extent: Vec2, progress: &Progress) -> Result<Continuity> {
    let [Some(source), Some(target)] = [frames.first(), frames.last()] else {
        return Ok(Continuity::default());
    };
    let at = |t: f64| &frames[(t * (frames.len() - 1) as f64).round_ties_even() as usize];
    let pictures = (0..PICTURES).into_par_iter().map(|i| {
        progress.check()?;
        Ok(Seams::new(at(i as f64 / (PICTURES - 1) as f64), extent).share())
    });
    let cracks = beyond_keys(pictures.collect::<Result<Vec<f64>>>()?);
    let rows = evenly_spaced(source.len(), LOOKED_AT);
    let torn = |key: &[Vec2], times: &[f64]| -> Result<Vec<f64>> {
        progress.check()?;
        let neighbourhoods = Neighbourhoods::new(key, &rows);
        Ok(times.iter().map(|&t| neighbourhoods.torn(at(t))).collect())
    };
    let (of_source, of_target) = (torn(source, &[0.5])?, torn(target, &[0.5, 0.75])?);
    progress.check()?;
    let Pace { fastest, quantile, straight } = Pace::of(frames);
    Ok(Continuity {
        cracks: cracks.iter().copied().fold(0.0, f64::max),
        cracks_mean: cracks.iter().sum::<f64>() / cracks.len() as f64,
        torn_source: of_source[0],
        torn_target: of_target[0],
        torn_target_late: of_target[1],
        bunch: bunch(frames, extent),
        fastest,
        fastest_999: quantile,
        fastest_straight: straight,
        gap: None,
    })
}

/// The shares at evenly spaced times, less those of the first and the last, interpolated.
fn beyond_keys(shares: Vec<f64>) -> Vec<f64> {
    let last = shares.len() - 1;
    let of_keys = |i: usize| shares[0] + (shares[last] - shares[0]) * i as f64 / last as f64;
    shares.iter().enumerate().map(|(i, share)| share - of_keys(i)).collect()
}

/// The fullest cell at any time over that of the fuller key; 1 where no light is seen.
fn bunch(frames: &[Vec<Vec2>], extent: Vec2) -> f64 {
    let fullest: Vec<f32> =
        frames.par_iter().map(|frame| Picture::counted(frame, extent, BUNCH_CELLS).max()).collect();
    let of_keys = fullest[0].max(fullest[fullest.len() - 1]);
    if of_keys > 0.0 { f64::from(fullest.into_iter().fold(0.0, f32::max) / of_keys) } else { 1.0 }
}
