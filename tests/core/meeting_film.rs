//! Light that meets half way between two keys, planned, fitted, paired and carried, for the tests that judge it.

use glam::{Vec2, vec2};
use lightloom_core::constraint::ActiveWall;
use lightloom_core::continuity::{Continuity, measure};
use lightloom_core::flow::meeting::{
    BridgeReport, HalfTracks, MeetingFields, MeetingFit, MeetingSegment, MeetingTrajectories, fit_meeting,
    meeting_report,
};
use lightloom_core::flow::{FlowReport, FlowSettings, GridSize, Trajectories as _};
use lightloom_core::matching::{ContinuousMap, transport_map};
use lightloom_core::{Progress, Result};

/// A plan of 72 cells.
pub(crate) fn settings() -> FlowSettings {
    FlowSettings { grid: GridSize::Longer(48), steps: 20, ..FlowSettings::default() }
}

/// A cell of the plan of [`settings`], plane units.
pub(crate) const CELL: f32 = 1.0 / 72.0;

/// The plan and the fit between two keys on the unit square.
pub(crate) fn fit(
    source: &[Vec2],
    target: &[Vec2],
    settings: &FlowSettings,
    walls: &[ActiveWall],
) -> Result<MeetingFit> {
    let groups = [[source, target]];
    let segment =
        MeetingSegment { groups: &groups, extent: Vec2::ONE, settings, lines: &[], walls, number: 0 };
    fit_meeting(&segment, &Progress::new())
}

/// All that can be seen of one segment.
pub(crate) struct Film {
    /// Places at the begin of each move and at the end.
    pub(crate) frames: Vec<Vec<Vec2>>,
    /// The later key in the rows of the photons.
    pub(crate) target: Vec<Vec2>,
    pub(crate) report: FlowReport,
    pub(crate) plan: BridgeReport,
}

/// The film from `source` to `target`, paired where they meet.
pub(crate) fn film(source: &[Vec2], target: &[Vec2], settings: &FlowSettings, walls: &[ActiveWall]) -> Film {
    let progress = Progress::new();
    let MeetingFit { fields, fits, plan } = fit(source, target, settings, walls).unwrap();
    let [forward, backward] =
        [(0, source), (1, target)].map(|(half, at)| HalfTracks::new(&fields, half, at, &progress).unwrap());
    let order = paired(&fields, &forward, &backward);
    let backward = backward.permuted(&order);
    let target: Vec<Vec2> = order.iter().map(|&row| target[row as usize]).collect();
    let mut photons = MeetingTrajectories::with_tracks(&fields, (source, &target), [&forward, &backward]);
    let frame = |n: usize| {
        let mut out = vec![Vec2::ZERO; source.len()];
        photons.positions_at(n as f64 / fields.moves() as f64, &mut out, &progress).unwrap();
        out
    };
    let frames = (0..=fields.moves()).map(frame).collect();
    let report =
        meeting_report(&fields, (source, &target), (Vec2::ONE, source.len()), &fits, &progress).unwrap();
    Film { frames, target, report, plan }
}

/// The row of the later key to which each photon goes.
fn paired(fields: &MeetingFields, forward: &HalfTracks, backward: &HalfTracks) -> Vec<u32> {
    let progress = Progress::new();
    let map = transport_map(forward.end(), backward.end(), Vec2::ONE, &progress).unwrap();
    let map = match fields.walls_at_meeting() {
        Some(graph) => ContinuousMap::Beside(map, graph),
        None => ContinuousMap::Transport(map),
    };
    map.pair(forward.end(), backward.end(), 1, 0, &progress).unwrap().matching.target_of
}

impl Film {
    /// How well the light holds together, by 41 of the frames at most.
    pub(crate) fn continuity(&self) -> Continuity {
        let every = (self.frames.len() - 1).div_ceil(40).max(1);
        let frames: Vec<_> = self.frames.iter().step_by(every).cloned().collect();
        measure(&frames, Vec2::ONE, &Progress::new()).unwrap()
    }

    /// Places half way.
    pub(crate) fn middle(&self) -> &[Vec2] {
        &self.frames[self.frames.len() / 2]
    }

    /// Asserts that every photon is somewhere at all times, starts at its source and arrives at its target.
    pub(crate) fn arrives(&self, source: &[Vec2]) {
        assert!(self.frames.iter().flatten().all(|p| p.is_finite()));
        assert_eq!(self.frames[0], source);
        assert_eq!(self.frames.last(), Some(&self.target));
        assert_eq!(self.report.endpoint_error, 0.0);
        let numbers =
            [self.report.gap, self.report.peak_speed_ratio, self.report.dispersion, self.plan.error];
        assert!(numbers.iter().all(|number| number.is_finite()), "{numbers:?}");
    }
}

/// `count` points spread evenly over a rectangle.
pub(crate) fn rectangle([low, high]: [[f32; 2]; 2], count: usize) -> Vec<Vec2> {
    // The plastic number makes a sequence of low discrepancy.
    let point = |i: usize| vec2((i as f32 * 0.754_877_7).fract(), (i as f32 * 0.569_840_3).fract());
    let (low, high) = (Vec2::from(low), Vec2::from(high));
    (1..=count).map(|i| low + (high - low) * point(i)).collect()
}

/// `count` points spread evenly over a disc.
pub(crate) fn disc(centre: [f32; 2], radius: f32, count: usize) -> Vec<Vec2> {
    let golden = 2.399_963_2f32;
    let spiral = |i: usize| ((i as f32 + 0.5) / count as f32).sqrt() * Vec2::from_angle(i as f32 * golden);
    (0..count).map(|i| Vec2::from(centre) + radius * spiral(i)).collect()
}

/// `count` points spread evenly over strokes, each a rectangle.
pub(crate) fn strokes(rectangles: &[[[f32; 2]; 2]], count: usize) -> Vec<Vec2> {
    let area = |[low, high]: &[[f32; 2]; 2]| (high[0] - low[0]) * (high[1] - low[1]);
    let all: f32 = rectangles.iter().map(area).sum();
    let mut points = Vec::new();
    for (i, stroke) in rectangles.iter().enumerate() {
        let rest = count - points.len();
        let share = (count as f32 * area(stroke) / all).round() as usize;
        points.extend(rectangle(*stroke, if i + 1 == rectangles.len() { rest } else { share }));
    }
    points
}
