//! Random motion of the light about the course of its plan.

use glam::Vec2;
use rayon::prelude::*;

use super::fields::MeetingFields;
use crate::flow::spatial_order::spatial_order;
use crate::flow::walls::SUBSTEPS;
use crate::math::sobol;

/// Standard deviation half way, over the size of the pieces that hold together. The plan is that of a random motion; its
/// mean velocity alone squeezes what is dark in a key frame to cracks at the meeting, which this much fills. With .1 the
/// target shows late: its lines of two cells are soft at t = .8.
const SHARE: f32 = 0.05;
/// Farthest displacement, standard deviations.
const FARTHEST: f64 = 3.0;
/// Exponent of 4 t (1 - t): lines of the target are sharp again from t = .75 on. With 1.5 they are soft until .85.
const BELL: i32 = 5;

/// The displacement of each photon about its trajectory, plane units: 0 at both key frames, largest half way.
pub(super) struct Diffusion {
    /// Half way, by row.
    displacements: Vec<Vec2>,
}

impl Diffusion {
    /// For photons from `source` to `targets` that are at `meeting` half way. Those that move less than pieces hold together
    /// have less of it, so that light at rest stays as it is. Neighbours have displacements of low discrepancy: light that
    /// is even stays so.
    pub(super) fn new(hold: f32, (source, targets): (&[Vec2], &[Vec2]), meeting: &[Vec2]) -> Self {
        let mut displacements = vec![Vec2::ZERO; source.len()];
        for (index, row) in spatial_order(meeting).into_iter().map(|row| row as usize).enumerate() {
            let [x, y] = sobol::scrambled(index as u32, 0);
            let radius = (-2.0 * (1.0 - x).ln()).sqrt().min(FARTHEST) as f32;
            let direction = Vec2::from_angle(std::f32::consts::TAU * y as f32);
            displacements[row] = SHARE * source[row].distance(targets[row]).min(hold) * radius * direction;
        }
        Self { displacements }
    }

    /// Displaces photons at time `t`; beside walls by no more than what keeps them on their side.
    pub(super) fn displace(&self, fields: &MeetingFields, t: f64, positions: &mut [Vec2]) {
        let bell = (4.0 * t * (1.0 - t)).max(0.0) as f32;
        let share = bell.powi(BELL);
        let step = ((t * (fields.steps() * SUBSTEPS) as f64) as usize).min(fields.steps() * SUBSTEPS - 1);
        let clearance = fields.obstacles().and_then(|obstacles| obstacles.clearance(step));
        let each = positions.par_iter_mut().zip(&self.displacements).with_min_len(4096);
        each.for_each(|(position, displacement)| {
            let by = share * *displacement;
            let free = clearance.map_or(f32::INFINITY, |clearance| clearance.at_least(*position));
            *position += by.clamp_length_max(free);
        });
    }
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
        let diffusion = Diffusion::new(fields.hold(), (&source, &targets), &source);
        for t in [0.0, 1.0] {
            let mut at = source.clone();
            diffusion.displace(&fields, t, &mut at);
            assert_eq!(at, source, "at t = {t}");
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
    }
}
