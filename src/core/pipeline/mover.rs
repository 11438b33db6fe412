//! What each method needs for a segment: its continuous map, and what moves its photons.

use std::sync::Arc;

use glam::Vec2;

use super::acting::{Acting, acting};
use super::meter::Meter;
use crate::constraint::{ActiveWall, Detour};
use crate::flow::{Course, FlowReport, Movement, Mover, Paths, fit_segment, watch_paths};
use crate::matching::{AroundMap, ContinuousMap, Method, StylizedMap, transport_map};
use crate::project::Project;
use crate::{Progress, Result};

/// Share of a segment that a wall stands to have a say in who goes where; others are only gone around.
const LASTING: f64 = 0.5;

/// The map by which the project's method pairs these points in segment `segment`; none where rows are paired as given.
pub(super) fn continuous_map(
    project: &Project,
    segment: usize,
    (from, to): (&[Vec2], &[Vec2]),
    extent: Vec2,
    progress: &Progress,
) -> Result<Option<ContinuousMap>> {
    Ok(match (project.matching, project.method) {
        (Method::Given, _) => None,
        (Method::Transport, Movement::Flow) => {
            let Acting { walls, .. } = acting(project, segment, extent);
            let lasting: Vec<&ActiveWall> =
                walls.iter().filter(|wall| wall.window.duration() >= LASTING).collect();
            if lasting.is_empty() {
                Some(ContinuousMap::Transport(transport_map(from, to, extent, progress)?))
            } else {
                let detour = Arc::new(Detour::new(&lasting, extent, progress)?);
                Some(ContinuousMap::Around(AroundMap::new(from, to, &detour, progress)?, detour))
            }
        }
        (Method::Transport, Movement::Linear) => {
            Some(ContinuousMap::Transport(transport_map(from, to, extent, progress)?))
        }
        (Method::Transport, Movement::Stylized) => {
            Some(ContinuousMap::Stylized(StylizedMap::new(from, to, progress)?))
        }
    })
}

/// What moves photons along a course by this method, and how they move. `bows` are those of their pairing.
pub(super) fn mover(
    method: Movement,
    course: &Course,
    bows: &[Vec2],
    meter: &mut Meter,
    progress: &Progress,
) -> Result<(Mover, FlowReport)> {
    match method {
        Movement::Flow => meter.measure("fit", || {
            let (fields, report) = fit_segment(course, progress, None)?;
            Ok((Mover::Fields(fields), report))
        }),
        Movement::Stylized | Movement::Linear => meter.measure("watch", || {
            let Course { source, target, extent, settings, .. } = *course;
            let (guides, steps) = (settings.guides as usize, settings.steps as usize);
            let report = watch_paths(&Paths::new(source, target, bows), extent, guides, steps, progress)?;
            Ok((Mover::Paths, report))
        }),
    }
}
