//! What each method needs for a segment: its continuous map, and what moves its photons.

use glam::Vec2;

use super::meter::Meter;
use super::supply::KeyPhotons;
use crate::flow::{Course, FlowReport, Movement, Paths, fit_segment, watch_paths};
use crate::matching::{ContinuousMap, Method, StylizedMap, transport_map};
use crate::project::Project;
use crate::{Progress, Result};

/// The map by which the project's method pairs these points; none where rows are paired as given.
pub(super) fn continuous_map(
    project: &Project,
    from: &[Vec2],
    to: &[Vec2],
    extent: Vec2,
    progress: &Progress,
) -> Result<Option<ContinuousMap>> {
    Ok(match (project.matching, project.method) {
        (Method::Given, _) => None,
        (Method::Transport, Movement::Flow | Movement::Linear) => {
            Some(ContinuousMap::Transport(transport_map(from, to, extent, progress)?))
        }
        (Method::Transport, Movement::Stylized) => {
            Some(ContinuousMap::Stylized(StylizedMap::new(from, to, progress)?))
        }
    })
}

/// What moves the photons from key to key, and how they move.
pub(super) fn course(
    project: &Project,
    from: &KeyPhotons,
    to: &KeyPhotons,
    extent: Vec2,
    meter: &mut Meter,
    progress: &Progress,
) -> Result<(Course, FlowReport)> {
    let (source, target, flow) = (&from.positions, &to.positions, &project.flow);
    match project.method {
        Movement::Flow => meter.measure("fit", || {
            let (fields, report) = fit_segment(source, target, extent, flow, progress, None)?;
            Ok((Course::Fields(fields), report))
        }),
        Movement::Stylized | Movement::Linear => meter.measure("watch", || {
            let paths = Paths::new(source, target, &to.bows);
            let report = watch_paths(&paths, extent, flow.guides as usize, flow.steps as usize, progress)?;
            Ok((Course::Paths, report))
        }),
    }
}
