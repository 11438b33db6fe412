//! What each method needs for a segment: its continuous map, and what moves its photons.

use std::sync::Arc;

use glam::Vec2;

use super::acting::{Acting, acting};
use super::meter::Meter;
use crate::constraint::{ActiveWall, VisibilityGraph};
use crate::flow::{
    FlowReport, Movement, PathTrajectories, Segment, SegmentFlow, Snapshots, fit_with_snapshots, path_report,
};
use crate::matching::{ContinuousMap, Method, StylizedMap, WallMap, transport_map};
use crate::project::Project;
use crate::{Progress, Result};

/// Share of a segment that a wall stands to have a say in who goes where; others are only gone around.
const LASTING: f64 = 0.5;

/// Whether a wall has a say in who goes where.
pub(super) fn leads(wall: &ActiveWall) -> bool {
    wall.window.duration() >= LASTING
}

/// By what the points of a segment are paired.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    /// Row by row.
    Given,
    /// Optimal transport along straight ways.
    Straight,
    /// Optimal transport along the ways around these walls.
    Around(Vec<ActiveWall>),
    /// The method of 2016.
    Stylized,
}

impl Kind {
    /// By what the project pairs in segment `segment`.
    pub(super) fn of(project: &Project, segment: usize, extent: Vec2) -> Self {
        match (project.matching, project.method) {
            (Method::Given, _) => Self::Given,
            (Method::Transport, Movement::Linear) => Self::Straight,
            (Method::Transport, Movement::Stylized) => Self::Stylized,
            (Method::Transport, Movement::Flow) => {
                let Acting { mut walls, .. } = acting(project, segment, extent);
                walls.retain(leads);
                if walls.is_empty() { Self::Straight } else { Self::Around(walls) }
            }
        }
    }

    /// The map between these points, around walls by so many anchors at most; none where rows are paired as given.
    pub(super) fn map(
        &self,
        (from, to): (&[Vec2], &[Vec2]),
        (extent, anchors): (Vec2, usize),
        progress: &Progress,
    ) -> Result<Option<ContinuousMap>> {
        Ok(match self {
            Self::Given => None,
            Self::Straight => Some(ContinuousMap::Transport(transport_map(from, to, extent, progress)?)),
            Self::Around(walls) => {
                let walls: Vec<&ActiveWall> = walls.iter().collect();
                let detour = Arc::new(VisibilityGraph::new(&walls, extent, progress)?);
                let map = WallMap::with_anchors(anchors, from, to, &detour, progress)?;
                Some(ContinuousMap::Walls(map, detour))
            }
            Self::Stylized => Some(ContinuousMap::Stylized(StylizedMap::new(from, to, progress)?)),
        })
    }
}

/// What moves photons along a course by this method, and how they move. `bows` are those of their pairing. `moments` are
/// shown the photons that the method looks at.
pub(super) fn mover(
    method: Movement,
    course: &Segment,
    bows: &[Vec2],
    moments: Option<Snapshots>,
    meter: &mut Meter,
    progress: &Progress,
) -> Result<(SegmentFlow, FlowReport)> {
    match method {
        Movement::Flow => meter.measure("fit", || {
            let (fields, report) = fit_with_snapshots(course, moments, progress)?;
            Ok((SegmentFlow::Fields(fields), report))
        }),
        Movement::Stylized | Movement::Linear => meter.measure("watch", || {
            let Segment { source, target, extent, settings, .. } = *course;
            let (guides, steps) = (settings.guides as usize, settings.steps as usize);
            let paths = PathTrajectories::new(source, target, bows);
            if let Some(Snapshots { times, show }) = moments {
                let mut positions = vec![Vec2::ZERO; source.len()];
                for (i, &time) in times.iter().enumerate() {
                    progress.check()?;
                    paths.positions(time, &mut positions);
                    show(i, &positions);
                }
            }
            let report = path_report(&paths, extent, guides, steps, progress)?;
            Ok((SegmentFlow::Paths, report))
        }),
    }
}
