//! The runs: each parameter of the plan varied alone, without walls and, where the project has some, around them.

use super::parameter::{Parameter, Setting};
use crate::effort::Effort;
use crate::meeting_film::MeetingFilm;
use lightloom_core::bridge::BridgeSettings;
use lightloom_core::constraint::ActiveWall;
use lightloom_core::continuity::{Continuity, measure};
use lightloom_core::engine::MovingSegment;
use lightloom_core::flow::FlowSettings;
use lightloom_core::flow::meeting::MeetingSegment;
use lightloom_core::{Progress, Result};

/// A setting and what came of it.
pub(super) struct Run {
    pub(super) setting: Setting,
    /// The parameter that differs from the project's own; none in that itself.
    pub(super) varied: Option<Parameter>,
    /// Seconds of the plans, and of the fits.
    pub(super) seconds: [f64; 2],
    /// Misplaced share of the light after the first plan.
    pub(super) misplaced: f64,
    pub(super) gap: f64,
    pub(super) figures: Continuity,
}

/// The runs with the same walls.
pub(super) struct Series {
    pub(super) walls: bool,
    /// The project's own first.
    pub(super) runs: Vec<Run>,
}

/// The measurements of the section.
pub(super) struct Measured {
    pub(super) series: Vec<Series>,
}

/// The photons for which plans are compared.
pub(super) struct Trial<'a> {
    pub(super) photons: &'a MovingSegment,
    pub(super) flow: &'a FlowSettings,
    pub(super) effort: Effort,
    pub(super) progress: &'a Progress,
}

impl Trial<'_> {
    pub(super) fn measure(&self) -> Result<Measured> {
        let walls = &*self.photons.walls;
        let with_walls = (!walls.is_empty()).then_some(walls);
        let all = Parameter::ALL.map(|parameter| parameter.varied(NONE, self.effort).len());
        let runs = 1 + all.iter().sum::<usize>();
        self.progress.begin("plan", (runs * (1 + usize::from(with_walls.is_some()))) as u64);
        let free: &[ActiveWall] = &[];
        let series = [free].into_iter().chain(with_walls).map(|walls| self.series(walls));
        Ok(Measured { series: series.collect::<Result<_>>()? })
    }

    fn series(&self, walls: &[ActiveWall]) -> Result<Series> {
        let own = self.run(None, walls, None)?;
        let setting = own.setting;
        let mut runs = vec![own];
        for parameter in Parameter::ALL {
            for setting in parameter.varied(setting, self.effort) {
                if runs.iter().any(|run| run.setting == setting) {
                    self.progress.advance(1);
                    continue;
                }
                runs.push(self.run(Some(setting), walls, Some(parameter))?);
            }
        }
        Ok(Series { walls: !walls.is_empty(), runs })
    }

    /// The project's own setting where `setting` is none.
    fn run(&self, setting: Option<Setting>, walls: &[ActiveWall], varied: Option<Parameter>) -> Result<Run> {
        let MovingSegment { source, target, extent, number, lines, .. } = self.photons;
        let steps = setting.map_or(self.flow.steps, |setting| setting.steps);
        let flow = FlowSettings { steps, ..self.flow.clone() };
        let groups = [[&**source, &**target]];
        let segment = MeetingSegment {
            groups: &groups,
            extent: *extent,
            settings: &flow,
            lines,
            walls,
            number: *number,
        };
        let refine = |plan: BridgeSettings| match setting {
            Some(Setting { cells, sweeps, .. }) => BridgeSettings { cells, sweeps, ..plan },
            None => plan,
        };
        let inner = self.progress.inner();
        let film = MeetingFilm::new(&segment, refine, &inner)?;
        let setting = setting.unwrap_or(Setting { cells: film.plan.cells, steps, sweeps: 1.0 });
        let figures = measure(&film.frames(&inner)?, *extent, &inner)?;
        let gap = film.report(&inner)?.gap;
        self.progress.advance(1);
        let (seconds, misplaced) = (film.plan.seconds, film.plan.error);
        Ok(Run { setting, varied, seconds, misplaced, gap, figures })
    }
}

/// A setting of which only others are made.
const NONE: Setting = Setting { cells: 0, steps: 0, sweeps: 0.0 };

impl Series {
    pub(super) fn own(&self) -> &Run {
        // It is measured first.
        &self.runs[0]
    }

    /// The runs in which one parameter differs, and the project's own, from coarse to fine.
    pub(super) fn along(&self, parameter: Parameter) -> Vec<&Run> {
        let on = |run: &&Run| run.varied.is_none_or(|varied| varied == parameter);
        let mut runs: Vec<&Run> = self.runs.iter().filter(on).collect();
        let key = |run: &Run| (run.setting.cells, run.setting.steps, run.setting.sweeps);
        runs.sort_by(|a, b| key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal));
        runs
    }
}
