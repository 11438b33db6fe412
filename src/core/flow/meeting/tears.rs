//! Where a body of light tears on its way from a key frame to the meeting.

use glam::Vec2;
use rayon::prelude::*;

use crate::bridge::Cells;

/// Cells over the size of the pieces that hold together.
const CELLS: f32 = 4.0;
/// Limits of the cells along the plane.
const COARSEST: f32 = 24.0;
const FINEST: f32 = 256.0;
/// Neighbours that move apart by more than this many times what is usual around them are torn; less is stretched, as a body is
/// that spreads.
const TORN: f32 = 3.0;
/// Cells to each side whose median says what is usual.
const AROUND: usize = 3;

/// Fall of the width with the distance to a tear. At 1 light fills a tear evenly, but lies in folds beside it.
const SLOPE: f32 = 0.4;

/// Half the width that the nearest tear has at the meeting, less a part of the distance to it at the key frame, for each photon.
/// `key` and `meeting` are where the photons are at the key frame and at the meeting.
pub(super) fn tears(hold: f32, key: &[Vec2], meeting: &[Vec2]) -> Vec<f32> {
    let cells = Cells::new(Vec2::ONE, (CELLS / hold.max(f32::MIN_POSITIVE)).clamp(COARSEST, FINEST) as usize);
    let mut means = vec![Mean::default(); cells.count()];
    for (&at, &then) in key.iter().zip(meeting) {
        means[cells.holding(at)].add(at, then);
    }
    let means: Vec<Option<[Vec2; 2]>> = means.iter().map(Mean::places).collect();
    let widths = spread(widths(&cells, &means), &cells);
    key.iter().map(|&at| cells.single_value(&widths, at)).collect()
}

/// The mean places of the photons of a cell.
#[derive(Clone, Copy, Default)]
struct Mean {
    count: f32,
    at: Vec2,
    then: Vec2,
}

impl Mean {
    fn add(&mut self, at: Vec2, then: Vec2) {
        self.count += 1.0;
        self.at += at;
        self.then += then;
    }

    /// At the key frame and at the meeting; none without photons.
    fn places(&self) -> Option<[Vec2; 2]> {
        (self.count > 0.0).then(|| [self.at / self.count, self.then / self.count])
    }
}

/// Half the width of the tears beside each cell.
fn widths(cells: &Cells, means: &[Option<[Vec2; 2]>]) -> Vec<f32> {
    let [width, height] = cells.size;
    let apart = |i: usize, step: usize| {
        let [[at, then], [next_at, next_then]] = [means[i]?, (*means.get(i + step)?)?];
        Some([at.distance(next_at), then.distance(next_then)])
    };
    let pairs: Vec<[Option<[f32; 2]>; 2]> = (0..cells.count())
        .map(|i| [if i % width + 1 < width { apart(i, 1) } else { None }, apart(i, width)])
        .collect();
    let usual = |i: usize| {
        let (x, y) = (i % width, i / width);
        let rows = y.saturating_sub(AROUND)..(y + AROUND + 1).min(height);
        let columns = x.saturating_sub(AROUND)..(x + AROUND + 1).min(width);
        let around = rows.flat_map(|y| columns.clone().map(move |x| y * width + x));
        let mut stretches: Vec<f32> = around
            .flat_map(|i| pairs[i].into_iter().flatten())
            .map(|[before, after]| after / before)
            .collect();
        let middle = stretches.len() / 2;
        *stretches.select_nth_unstable_by(middle, f32::total_cmp).1
    };
    let torn = |i: usize| {
        let mut torn = [0.0_f32; 2];
        if pairs[i].iter().any(Option::is_some) {
            let stretch = TORN * usual(i).max(1.0);
            for (torn, pair) in torn.iter_mut().zip(pairs[i]) {
                *torn = pair.map_or(0.0, |[before, after]| (0.5 * (after - stretch * before)).max(0.0));
            }
        }
        torn
    };
    let torn: Vec<[f32; 2]> = (0..cells.count()).into_par_iter().map(torn).collect();
    let mut widths = vec![0.0_f32; cells.count()];
    for (i, torn) in torn.into_iter().enumerate() {
        for (torn, step) in torn.into_iter().zip([1, width]).filter(|(torn, _)| *torn > 0.0) {
            widths[i] = widths[i].max(torn);
            widths[i + step] = widths[i + step].max(torn);
        }
    }
    widths
}

/// The largest width around each cell, less a part of the distance to it: two sweeps of a distance transform (Rosenfeld and
/// Pfaltz 1968).
fn spread(mut widths: Vec<f32>, cells: &Cells) -> Vec<f32> {
    let [width, height] = cells.size;
    let straight = SLOPE * cells.side;
    let across = std::f32::consts::SQRT_2 * straight;
    let mut sweep = |forward: bool| {
        let count = width * height;
        for k in 0..count {
            let i = if forward { k } else { count - 1 - k };
            let (x, y) = ((i % width) as isize, (i / width) as isize);
            let s = if forward { -1 } else { 1 };
            let behind = [((s, 0), straight), ((0, s), straight), ((s, s), across), ((-s, s), across)];
            for ((dx, dy), way) in behind {
                let (x, y) = (x + dx, y + dy);
                if (0..width as isize).contains(&x) && (0..height as isize).contains(&y) {
                    widths[i] = widths[i].max(widths[y as usize * width + x as usize] - way);
                }
            }
        }
    };
    sweep(true);
    sweep(false);
    widths
}

#[cfg(test)]
mod tests {
    use glam::vec2;

    use super::*;

    #[test]
    fn a_body_that_parts_is_torn_along_its_seam_and_nowhere_else() {
        let key: Vec<Vec2> =
            (0..40_000).map(|i| vec2((i % 200) as f32 + 0.5, (i / 200) as f32 + 0.5) / 400.0).collect();
        let parted = |p: &Vec2| *p + vec2(if p.x < 0.25 { -0.02 } else { 0.02 }, 0.1);
        let meeting: Vec<Vec2> = key.iter().map(parted).collect();
        let torn = tears(0.05, &key, &meeting);
        for (p, torn) in key.iter().zip(&torn) {
            let expected = (0.02 - SLOPE * (p.x - 0.25).abs()).max(0.0);
            // Known to a cell, 1/80, and what is called stretched of that.
            assert!((torn - expected).abs() < 0.02, "{torn} at {p}, expected {expected}");
        }
        assert!(torn.iter().any(|torn| *torn > 0.0));
        let stretched: Vec<Vec2> = key.iter().map(|p| 8.0 * *p).collect();
        assert!(tears(0.05, &key, &stretched).iter().all(|torn| *torn == 0.0), "stretched light is not torn");
    }
}
