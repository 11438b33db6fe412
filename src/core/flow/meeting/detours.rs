//! Photons beside walls near the meeting: they make up for their gap late, and the few whose move would meet a wall go around
//! it.

use glam::Vec2;
use rayon::prelude::*;

use super::fields::MeetingFields;
use super::half_step::HalfStep;
use super::tracks::HalfTracks;
use crate::Progress;
use crate::Result;
use crate::constraint::visibility::SearchBuffers;
use crate::constraint::{VisibilityGraph, WallPath};
use crate::flow::walls::{SUBSTEPS, WallViolations};
use crate::math::smoothstep::smoothstep;

/// Part of a half after which photons beside walls make up for their gap.
const LATE: f64 = 0.8;
/// Parts of a half at which a detour may leave the track; the last that does not ask for more than this speed, over the mean one.
const LEAVES: [f64; 5] = [0.8, 0.6, 0.4, 0.2, 0.0];
const FASTEST: f32 = 3.0;
/// The same where no path leads from those, however fast: walls that stand for a while may have opened or closed since.
const LEAVES_LATE: [f64; 2] = [0.9, 1.0];

/// The path of a photon around walls from its track in the first half to that in the second.
struct Detour {
    row: u32,
    /// Time at which it begins; it ends as long before the end.
    begin: f64,
    /// Places at even times.
    path: Vec<Vec2>,
    /// Whether it meets no wall.
    clear: bool,
}

/// What walls change about the paths of photons around the meeting.
pub(super) struct Detours {
    /// By half, whether each photon comes near a wall.
    beside: [Vec<bool>; 2],
    /// Whether each photon is on a detour, which makes up for all of its gap.
    on_detour: Vec<bool>,
    /// Steps of a half before photons beside walls make up for their gap, and all steps of a half.
    steps: [usize; 2],
    /// By row, ascending.
    detours: Vec<Detour>,
    violations: WallViolations,
}

impl Detours {
    /// For photons that move along `halves`; none where no wall stands at any time.
    ///
    /// # Errors
    /// `Cancelled`.
    pub(super) fn new(
        fields: &MeetingFields,
        halves: [&HalfTracks; 2],
        progress: &Progress,
    ) -> Result<Option<Self>> {
        let Some(graph) = fields.walls_at_any_time(progress)? else { return Ok(None) };
        let count = halves[0].count();
        let late = ((count as f64 * LATE) as usize).min(count - 1);
        let beside = [0, 1].map(|half| beside(fields, half, halves));
        let on_detour = vec![false; halves[0].end().len()];
        let mut all = Self {
            beside,
            on_detour,
            steps: [late, count],
            detours: Vec::new(),
            violations: WallViolations::default(),
        };
        let rows = all.blocked(fields, halves, progress)?;
        rows.iter().for_each(|&row| all.on_detour[row as usize] = true);
        // A detour may take so long that other walls stand than at the meeting.
        let detour = |&row: &u32| detour(fields, halves, &graph, row);
        all.detours = rows.par_iter().map(detour).collect();
        all.violations.unreachable = all.detours.iter().filter(|detour| !detour.clear).count();
        Ok(Some(all))
    }

    /// Photons that leave the flow.
    pub(super) fn count(&self) -> usize {
        self.detours.len()
    }

    /// Photons that no path brings together: they go straight, through the walls.
    pub(super) fn violations(&self) -> WallViolations {
        self.violations
    }

    /// The photons that go straight through walls, by row.
    pub(super) fn unreachable(&self) -> impl Iterator<Item = usize> {
        self.detours.iter().filter(|detour| !detour.clear).map(|detour| detour.row as usize)
    }

    /// The share of its gap that photon `row` has made up for at the time `since` the key frame of a half, in halves.
    pub(super) fn share(&self, half: usize, row: usize, since: f64, early: f32) -> f32 {
        if self.on_detour[row] {
            return 0.0;
        }
        if !self.beside[half][row] {
            return early;
        }
        let late = self.steps[0] as f64 / self.steps[1] as f64;
        smoothstep(0.5 * (since - late) / (1.0 - late)) as f32
    }

    /// The photons whose way to their partner, or to it around the meeting, meets a wall.
    fn blocked(
        &self,
        fields: &MeetingFields,
        halves: [&HalfTracks; 2],
        progress: &Progress,
    ) -> Result<Vec<u32>> {
        let [late, count] = self.steps;
        let (x, y) = (halves[0].end(), halves[1].end());
        let mut blocked = vec![false; x.len()];
        if let Some(graph) = fields.walls_at_meeting() {
            let barriers = graph.barriers();
            let pairs = blocked.par_iter_mut().zip(x).zip(y).with_min_len(4096);
            pairs.for_each(|((blocked, a), b)| *blocked = barriers.blocks(*a, *b));
        }
        for half in [0, 1] {
            let mut at = halves[half].after(late).to_vec();
            for done in late..count {
                progress.check()?;
                let gap = |row: usize| if half == 0 { y[row] - x[row] } else { x[row] - y[row] };
                let free = |row: usize| {
                    let since = (done + 1) as f64 / count as f64;
                    halves[half].after(done + 1)[row] + self.share(half, row, since, 0.0) * gap(row)
                };
                let step = HalfStep::new(fields, half, done, halves[half]);
                let Some(walls) = step.walls() else {
                    at.par_iter_mut().enumerate().for_each(|(row, at)| *at = free(row));
                    continue;
                };
                let each = at.par_iter_mut().zip(&mut blocked).enumerate().with_min_len(1024);
                each.for_each(|(row, (at, blocked))| {
                    let gap = gap(row);
                    if *blocked || !self.beside[half][row] || step.is_clear(row, gap) {
                        *at = free(row);
                        return;
                    }
                    for part in 1..=SUBSTEPS {
                        let x = part as f32 / SUBSTEPS as f32;
                        let since = (done as f64 + f64::from(x)) / count as f64;
                        let next = step.position(row, x) + self.share(half, row, since, 0.0) * gap;
                        *blocked |= walls.blocks(*at, next);
                        *at = next;
                    }
                });
            }
        }
        Ok((0u32..).zip(blocked).filter_map(|(row, blocked)| blocked.then_some(row)).collect())
    }

    /// Puts the photons that are on a detour at time `t` where they are.
    pub(super) fn place(&self, t: f64, out: &mut [Vec2]) {
        for Detour { row, begin, path, .. } in &self.detours {
            if t <= *begin || t >= 1.0 - begin {
                continue;
            }
            let at = (t - begin) / (1.0 - 2.0 * begin) * (path.len() - 1) as f64;
            let first = (at as usize).min(path.len().saturating_sub(2));
            out[*row as usize] = path[first].lerp(path[first + 1], (at - first as f64) as f32);
        }
    }
}

/// The detour of a photon: as late as its speed allows, straight through the walls where no path leads around.
fn detour(fields: &MeetingFields, halves: [&HalfTracks; 2], graph: &VisibilityGraph, row: u32) -> Detour {
    let count = halves[0].count();
    let limit = FASTEST * fields.mean_way();
    let from = |leaves: f64| {
        let done = ((count as f64 * leaves) as usize).min(count - 1);
        let ends = halves.map(|half| half.after(done)[row as usize]);
        (done as f64 / fields.steps() as f64, ends, 2 * SUBSTEPS * (count - done))
    };
    let clear = |leaves: &f64| {
        let (begin, [a, b], points) = from(*leaves);
        Some(Detour { row, begin, path: around(graph, a, b, points)?, clear: true })
    };
    let slow = |Detour { begin, path, .. }: &Detour| {
        let length: f32 = path.windows(2).map(|ends| ends[0].distance(ends[1])).sum();
        length <= limit * (1.0 - 2.0 * begin) as f32
    };
    let mut last = None;
    for found in LEAVES.iter().filter_map(clear) {
        if slow(&found) {
            return found;
        }
        last = Some(found);
    }
    last.or_else(|| LEAVES_LATE.iter().find_map(clear)).unwrap_or_else(|| {
        let (begin, [a, b], points) = from(LEAVES[0]);
        let path = (0..=points).map(|i| a.lerp(b, i as f32 / points as f32)).collect();
        Detour { row, begin, path, clear: false }
    })
}

/// Whether each photon comes near a wall on its track, or while it makes up for its gap.
fn beside(fields: &MeetingFields, half: usize, halves: [&HalfTracks; 2]) -> Vec<bool> {
    let tracks = halves[half];
    let gap = |row: usize| halves[1].end()[row] - halves[0].end()[row];
    let mut beside = vec![false; tracks.end().len()];
    for done in 0..tracks.count() {
        let step = HalfStep::new(fields, half, done, tracks);
        if step.walls().is_some() {
            let each = beside.par_iter_mut().enumerate().with_min_len(4096);
            each.for_each(|(row, beside)| *beside = *beside || !step.is_clear(row, gap(row)));
        }
    }
    beside
}

/// The shortest path from `a` to `b` as `points` even moves, each of which meets no wall: a corner is always one of the ends. None
/// where walls separate them, or the path has more corners than moves.
fn around(graph: &VisibilityGraph, a: Vec2, b: Vec2, points: usize) -> Option<Vec<Vec2>> {
    let mut path: WallPath = graph.path(a, b, &mut SearchBuffers::default())?;
    let mut corners = vec![a];
    while !path.is_straight() {
        corners.push(graph.next_point(path, b));
        path = graph.after_corner(path);
    }
    corners.push(b);
    let legs = corners.len() - 1;
    let lengths: Vec<f32> = corners.windows(2).map(|leg| leg[0].distance(leg[1])).collect();
    let all: f32 = lengths.iter().sum::<f32>().max(f32::MIN_POSITIVE);
    // Whole moves for each leg, at least one, by its share of the length.
    let spare = points.checked_sub(legs)?;
    let mut moves: Vec<usize> =
        lengths.iter().map(|length| 1 + (spare as f32 * length / all) as usize).collect();
    let missing = points - moves.iter().sum::<usize>().min(points);
    let longest = (0..legs).max_by(|&i, &k| lengths[i].total_cmp(&lengths[k]))?;
    moves[longest] += missing;
    let mut places = vec![a];
    for (leg, count) in corners.windows(2).zip(moves) {
        places.extend((1..=count).map(|i| leg[0].lerp(leg[1], i as f32 / count as f32)));
    }
    Some(places)
}
