//! Light that meets half way, followed independently of the numbers that its flow reports.

use glam::Vec2;

use super::case::{Input, Limits, Measured};
use super::flow_case::{CrossingObserver, disc};
use crate::effort::Effort;
use crate::meeting_film::MeetingFilm;
use lightloom_core::constraint::ActiveWall;
use lightloom_core::flow::meeting::MeetingSegment;
use lightloom_core::flow::{FlowSettings, GridSize};
use lightloom_core::{Progress, Result};

/// Photons at both keys, and the settings and walls of their flow.
pub(super) struct MeetingCase {
    pub(super) source: Vec<Vec2>,
    pub(super) target: Vec<Vec2>,
    pub(super) settings: FlowSettings,
    pub(super) walls: Vec<ActiveWall>,
}

impl MeetingCase {
    /// The plain case: a disc to another, with the default settings where the effort is full.
    pub(super) fn new(effort: Effort) -> Self {
        let count = effort.pick(2000, 100_000);
        let plain = FlowSettings::default();
        let settings = FlowSettings {
            grid: effort.pick(GridSize::Longer(32), plain.grid),
            steps: effort.pick(16, plain.steps),
            ..plain
        };
        let [source, target] = [[0.25, 0.5], [0.75, 0.5]].map(|at| disc(at, 0.15, count));
        Self { source, target, settings, walls: Vec::new() }
    }

    /// Length of a cell of the plan beside walls, plane units.
    pub(super) fn cell(effort: Effort) -> f32 {
        1.0 / effort.pick(48.0, 128.0)
    }
}

impl Input for MeetingCase {
    fn limits(&self) -> Limits {
        Limits {
            endpoint_error: Some(0.0),
            crossings: Some(0),
            unreachable: Some([0, 0]),
            // A tenth of the light that a plan leaves at the wrong place would be seen.
            misplaced: Some(0.1),
            // Below half the hold no piece of the body is out of place.
            gap: Some(0.5 * f64::from(self.settings.hold)),
            ..Limits::FINITE
        }
    }

    fn check(&self) -> Result<()> {
        self.settings.check("flow")
    }

    fn run(&self, progress: &Progress) -> Result<Measured> {
        let Self { source, target, settings, walls } = self;
        let groups = [[&**source, &**target]];
        let segment =
            MeetingSegment { groups: &groups, extent: Vec2::ONE, settings, lines: &[], walls, number: 0 };
        let film = MeetingFilm::new(&segment, |plan| plan, progress)?;
        let report = film.report(progress)?;
        let mut observer = CrossingObserver::new(walls);
        let frames = film.frames(progress)?;
        frames.iter().for_each(|frame| observer.observe(frame));
        let ends = frames.iter().last().into_iter().flatten().zip(film.targets());
        let missed = ends.map(|(c, b)| f64::from(c.distance(*b))).fold(0.0, f64::max);
        let numbers =
            [report.peak_speed_ratio, report.dispersion, film.plan.seconds[0], film.plan.seconds[1]];
        Ok(Measured {
            finite: observer.is_finite() && numbers.into_iter().all(f64::is_finite),
            endpoint_error: Some(missed.max(report.endpoint_error)),
            // Unreachable photons may go through a wall.
            crossings: Some(report.wall_crossings + observer.crossed().saturating_sub(report.unreachable)),
            unreachable: Some(report.unreachable),
            misplaced: Some(film.plan.error),
            gap: Some(report.gap),
            ..Measured::default()
        })
    }
}
