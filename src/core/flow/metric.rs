//! Measures of the quality of a flow. Speeds are in mean straight speeds, |b - a| per unit of t.

use glam::{Mat2, Vec2};
use rayon::prelude::*;

use super::field::Field;

/// Cells along the longer side in which photons count as neighbours.
const CELLS: f32 = 64.0;
/// Quantile of the peak speed: the fastest of a thousand may be an outlier of the matching.
const PEAK_QUANTILE: f64 = 0.999;

/// Velocity variance within cells, over the photons of cells that hold two or more.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NeighbourVariance {
    within: f64,
    about_mean: f64,
    mean_square: f64,
}

impl NeighbourVariance {
    /// Of photons on a plane of this extent; those outside are left out.
    pub fn new(positions: &[Vec2], velocities: &[Vec2], extent: Vec2) -> Self {
        let columns = (extent.x * CELLS).ceil().max(1.0) as usize;
        let rows = (extent.y * CELLS).ceil().max(1.0) as usize;
        let mut cells = vec![Sum::default(); columns * rows];
        for (p, &v) in positions.iter().zip(velocities) {
            let (x, y) = ((p.x * CELLS).floor(), (p.y * CELLS).floor());
            if x >= 0.0 && y >= 0.0 && x < columns as f32 && y < rows as f32 {
                cells[y as usize * columns + x as usize].add(v);
            }
        }
        let mut all = Sum::default();
        let mut within = 0.0;
        for cell in cells.iter().filter(|cell| cell.count > 1.0) {
            // Bessel's correction: the mean of few follows their own scatter.
            within += cell.variance_sum() * cell.count / (cell.count - 1.0);
            all.join(cell);
        }
        Self { within, about_mean: all.variance_sum(), mean_square: all.square }
    }

    /// Neighbour-velocity variance over the mean square velocity: 0 where neighbours move alike.
    pub fn dispersion(&self) -> f64 {
        ratio(self.within, self.mean_square)
    }

    /// Share of the velocity variance that the place does not explain: 1 where photons cross at random, as in ghosting.
    pub fn crossing_index(&self) -> f64 {
        ratio(self.within, self.about_mean)
    }
}

#[derive(Clone, Copy, Default)]
struct Sum {
    count: f64,
    x: f64,
    y: f64,
    square: f64,
}

impl Sum {
    fn add(&mut self, v: Vec2) {
        let v = v.as_dvec2();
        self.join(&Self { count: 1.0, x: v.x, y: v.y, square: v.length_squared() });
    }

    fn join(&mut self, other: &Self) {
        self.count += other.count;
        self.x += other.x;
        self.y += other.y;
        self.square += other.square;
    }

    fn variance_sum(&self) -> f64 {
        (self.square - (self.x * self.x + self.y * self.y) / self.count.max(1.0)).max(0.0)
    }
}

/// 0 where there is nothing to divide by: nothing moves.
fn ratio(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

/// The fastest speed that 99.9 % of the photons stay below, from the fastest of each, over the mean straight speed.
pub fn peak_speed_ratio(fastest: &[f32], mean_straight: f32) -> f64 {
    if fastest.is_empty() || mean_straight <= 0.0 {
        return 0.0;
    }
    let mut sorted = fastest.to_vec();
    let rank = ((sorted.len() - 1) as f64 * PEAK_QUANTILE).ceil() as usize;
    let (_, peak, _) = sorted.select_nth_unstable_by(rank, f32::total_cmp);
    f64::from(*peak) / f64::from(mean_straight)
}

/// The relative misfit sqrt(sum |u(c) - v|^2 / sum |v|^2).
pub fn fit_residual(field: &Field, positions: &[Vec2], guidance: &[Vec2]) -> f64 {
    let undone: Vec<f32> =
        positions.par_iter().zip(guidance).map(|(&c, &v)| (field.velocity(c) - v).length_squared()).collect();
    let undone: f64 = undone.iter().map(|&x| f64::from(x)).sum();
    ratio(undone, guidance.iter().map(|v| f64::from(v.length_squared())).sum()).sqrt()
}

/// Root mean square of divergence and curl of the sum of these fields at these points, per unit of t.
pub fn divergence_and_curl_rms(fields: &[&Field], points: &[Vec2]) -> [f64; 2] {
    let mut squares = [0.0f64; 2];
    for &p in points {
        let slope: Mat2 = fields.iter().map(|field| field.gradient(p)).sum();
        squares[0] += f64::from(slope.x_axis.x + slope.y_axis.y).powi(2);
        squares[1] += f64::from(slope.x_axis.y - slope.y_axis.x).powi(2);
    }
    squares.map(|sum| (sum / points.len().max(1) as f64).sqrt())
}

/// The largest distance of a photon from its target.
pub fn endpoint_error(positions: &[Vec2], targets: &[Vec2]) -> f64 {
    positions.iter().zip(targets).map(|(c, b)| f64::from(c.distance(*b))).fold(0.0, f64::max)
}

/// sqrt(sum |a - b|^2 / sum |c|^2).
pub(super) fn relative_distance(
    a: &[Vec2],
    b: impl Iterator<Item = Vec2>,
    c: impl Iterator<Item = Vec2>,
) -> f64 {
    let apart: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a.distance_squared(b))).sum();
    ratio(apart, c.map(|c| f64::from(c.length_squared())).sum()).sqrt()
}
