//! Random motion of the light about the course of its plan.

use glam::Vec2;
use rayon::prelude::*;

use super::fields::MeetingFields;
use super::made_up::MadeUp;
use super::tears::tears;
use crate::flow::spatial_order::spatial_order;
use crate::flow::walls::{Clearance, SUBSTEPS, bounce};
use crate::math::smoothstep::smoothstep;
use crate::math::sobol;

/// Standard deviation half way, over the size of the pieces that hold together. The plan is that of a random motion; its
/// mean velocity alone squeezes what is dark in a key frame to cracks at the meeting, which this much fills: light melts and gathers
/// again. Half as much leaves the cracks seen, twice as much leaves nothing else to see.
const SHARE: f32 = 0.1;
/// Farthest displacement, standard deviations.
const FARTHEST: f64 = 3.0;
/// Exponent of 4 t (1 - t): lines of the target are sharp again from t = .75 on. With 5 they are soft until .8.
const BELL: i32 = 8;
/// Largest standard deviation over the distance to the nearest wall: light fades towards a wall as planned, and is not heaped up
/// before it.
const NEAR_WALLS: f32 = 0.4;
/// Standard deviation beside a tear over half its width, and where light parts that was together at the meeting.
const TORN: f32 = 1.0;
const PARTED: f32 = 0.6;
/// The least width of a tear that counts, over the size of the pieces that hold together, and the shares of the light beside such
/// tears up to which they are few, and from which on they are many.
const SEEN: f32 = 0.05;
const BESIDE: [f32; 2] = [0.18, 0.3];
/// The largest standard deviation beside tears over the size of the pieces that hold together, and the exponent of the time by which
/// it closes, with few and with many tears. A few wide tears of a plain shape need much; a limit of .2 everywhere blurs half of a
/// finely drawn target until t = .8.
const WIDEST: [f32; 2] = [0.5, 0.08];
const CLOSES: [f32; 2] = [1.0, 1.5];

/// Standard deviation over what a photon has made up for of its gap: where the gap of neighbours differs, light is spread over the
/// seam between them.
const MADE_UP: f32 = 0.5;

/// The displacement of each photon about its trajectory, plane units: 0 at both key frames, largest half way.
pub(super) struct Diffusion {
    /// By row, of standard deviation 1 along each axis.
    directions: Vec<Vec2>,
    /// Standard deviations half way everywhere, by row.
    even: Vec<f32>,
    /// The gaps at the meeting, by row.
    gaps: Vec<Vec2>,
    /// Those beside the tears of the body of either key frame; of all, the widest counts.
    torn: [Torn; 2],
    /// The mean of the standard deviations everywhere.
    mean: f32,
}

impl Diffusion {
    /// For photons between both `keys` that `meet` half way, those of either key frame. Those that move less than
    /// pieces hold together have less of it, so that light at rest stays as it is. Neighbours have displacements of low
    /// discrepancy: light that is even stays so.
    pub(super) fn new(hold: f32, keys: [&[Vec2]; 2], meet: [&[Vec2]; 2]) -> Self {
        let ends = || meet[0].par_iter().zip(meet[1]);
        // With the gap made up for: where that jumps, light tears as well.
        let meeting: Vec<Vec2> = ends().map(|(a, b)| a.midpoint(*b)).collect();
        let gaps = ends().map(|(a, b)| b - a).collect();
        let mut directions = vec![Vec2::ZERO; keys[0].len()];
        for (index, row) in spatial_order(&meeting).into_iter().enumerate() {
            let [x, y] = sobol::scrambled(index as u32, 0);
            let radius = (-2.0 * (1.0 - x).ln()).sqrt().min(FARTHEST) as f32;
            directions[row as usize] = radius * Vec2::from_angle(std::f32::consts::TAU * y as f32);
        }
        let moved = keys[0].par_iter().zip(keys[1]).map(|(a, b)| a.distance(*b).min(hold));
        let even: Vec<f32> = moved.map(|moved| SHARE * moved).collect();
        let mean = even.iter().copied().map(f64::from).sum::<f64>() / even.len().max(1) as f64;
        let torn = |side: usize| Torn::new(hold, keys[side], &meeting);
        let torn = rayon::join(|| torn(0), || torn(1)).into();
        Self { directions, even, gaps, torn, mean: mean as f32 }
    }

    /// The mean standard deviation along each axis at time `t`, without those beside tears, plane units.
    pub(super) fn deviation(&self, t: f64) -> f32 {
        share(t) * self.mean
    }

    /// Displaces photons at time `t`; walls mirror them.
    pub(super) fn displace(&self, fields: &MeetingFields, t: f64, positions: &mut [Vec2]) {
        let share = share(t);
        let closes = [self.torn[0].closes(t), self.torn[1].closes(1.0 - t)];
        let made_up = MadeUp::at(t.min(1.0 - t) as f32, fields.hold());
        let step = ((t * (fields.steps() * SUBSTEPS) as f64) as usize).min(fields.steps() * SUBSTEPS - 1);
        let obstacles = fields.obstacles();
        let walls = obstacles.and_then(|walls| Some((walls.clearance(step)?, walls.graph(step)?.barriers())));
        positions.par_iter_mut().enumerate().with_min_len(4096).for_each(|(row, position)| {
            let torn = [0, 1].map(|side| closes[side] * self.torn[side].deviation[row]);
            let gap = self.gaps[row];
            let seam = MADE_UP * made_up.share(gap) * gap.length();
            // The widest: as a sum, all of a body with many tears would be out of focus half way.
            let deviation = (share * self.even[row]).max(torn[0]).max(torn[1]).max(seam);
            let most = |(clearance, _): (&Clearance, _)| NEAR_WALLS * clearance.at(*position).max(0.0);
            let by = deviation.min(walls.map_or(f32::INFINITY, most)) * self.directions[row];
            *position = match walls {
                Some((clearance, barriers)) if clearance.at_least(*position) < by.length() => {
                    bounce(barriers, *position, by)
                }
                _ => *position + by,
            };
        });
    }
}

/// The diffusion beside the tears of the body of a key frame.
struct Torn {
    /// Standard deviations half way, by row.
    deviation: Vec<f32>,
    /// The exponent of the time by which tears close towards the key frame.
    closing: f32,
}

impl Torn {
    /// For photons at a `key` frame that are at `meeting` half way. A tear is where light of the key frame parts until the meeting,
    /// or light of the meeting until the key frame: there an edge of the key frame meets another.
    fn new(hold: f32, key: &[Vec2], meeting: &[Vec2]) -> Self {
        let (mut deviation, parted) = rayon::join(|| tears(hold, key, meeting), || tears(hold, meeting, key));
        let beside = deviation.iter().filter(|torn| **torn > SEEN * hold).count() as f32
            / deviation.len().max(1) as f32;
        let many = smoothstep(f64::from((beside - BESIDE[0]) / (BESIDE[1] - BESIDE[0]))) as f32;
        let of = |[few, most]: [f32; 2]| few + many * (most - few);
        let widest = hold * of(WIDEST);
        for (torn, parted) in deviation.iter_mut().zip(parted) {
            *torn = (TORN * *torn).max(PARTED * parted).min(widest);
        }
        Self { deviation, closing: of(CLOSES) }
    }

    /// The share of the deviation half way at time `since` the key frame. It closes towards the key frame, and fades beyond the
    /// meeting, where the body of the other is seen.
    fn closes(&self, since: f64) -> f32 {
        if since < 0.5 { ((2.0 * since) as f32).powf(self.closing) } else { share(since) }
    }
}

/// The share at time `t` of what there is half way.
fn share(t: f64) -> f32 {
    ((4.0 * t * (1.0 - t)).max(0.0) as f32).powi(BELL)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_where_it_is_at_both_key_frames_and_at_rest() {
        let source: Vec<Vec2> = (0..2000).map(|i| Vec2::splat(i as f32 / 2000.0)).collect();
        let targets: Vec<Vec2> =
            source.iter().enumerate().map(|(i, p)| if i < 1000 { *p } else { *p + 0.2 }).collect();
        let fields = MeetingFields::new(4, 0.1, None, None).with_hold(0.05);
        let diffusion = Diffusion::new(fields.hold(), [&source, &targets], [&source, &source]);
        for t in [0.0, 1.0] {
            let mut at = source.clone();
            diffusion.displace(&fields, t, &mut at);
            assert_eq!(at, source, "at t = {t}");
            assert_eq!(diffusion.deviation(t), 0.0);
        }
        let mut at = source.clone();
        diffusion.displace(&fields, 0.5, &mut at);
        let moved = |row: &usize| at[*row].distance(source[*row]);
        assert!((0..1000).all(|row| moved(&row) == 0.0), "light at rest moves");
        // 1000 photons: the mean square of a two-dimensional normal, 2 sigma^2, is known to 1/sqrt(1000) of itself;
        // cut off at 3 it loses 1 %.
        let mean: f32 = (1000..2000).map(|row| moved(&row).powi(2)).sum::<f32>() / 1000.0;
        let expected = 2.0 * (SHARE * 0.05_f32).powi(2);
        assert!((mean / expected - 1.0).abs() < 0.11, "mean square {mean}, expected {expected}");
        // Half of the light rests.
        assert!(
            (diffusion.deviation(0.5) / (SHARE * 0.05) - 0.5).abs() < 1e-4,
            "{}",
            diffusion.deviation(0.5)
        );
    }

    #[test]
    fn where_the_gap_jumps_light_is_spread_as_far_as_the_seam_opens() {
        // One body whose right half has another gap than the left; it rests but for that.
        let at: Vec<Vec2> = (0..4000).map(|i| Vec2::new(i as f32 / 4000.0, 0.5)).collect();
        let gap = Vec2::new(0.0, 0.02);
        let met: Vec<Vec2> =
            at.iter().enumerate().map(|(i, p)| if i < 2000 { *p } else { *p + gap }).collect();
        let fields = MeetingFields::new(4, 0.1, None, None).with_hold(0.05);
        let diffusion = Diffusion::new(fields.hold(), [&at, &at], [&at, &met]);
        for t in [0.2, 0.5, 0.8] {
            let mut spread = at.clone();
            diffusion.displace(&fields, t, &mut spread);
            let moved = |row: usize| spread[row].distance_squared(at[row]);
            assert!((0..2000).all(|row| moved(row) == 0.0), "light without a gap moves at {t}");
            let opens = MadeUp::at(t.min(1.0 - t) as f32, fields.hold()).share(gap) * gap.length();
            let mean = (2000..4000).map(moved).sum::<f32>() / 2000.0;
            // As above: 2 sigma^2, known to 1/sqrt(2000) and the 1 % cut off.
            let expected = 2.0 * (MADE_UP * opens).powi(2);
            assert!((mean / expected - 1.0).abs() < 0.08, "mean square {mean}, expected {expected} at {t}");
        }
    }
}
