//! The photon that is followed: its way, its target, its detour.

use std::sync::Arc;

use glam::Vec2;
use lightloom_core::Progress;
use lightloom_core::constraint::visibility::SearchBuffers;
use lightloom_core::constraint::{ActiveWall, Constraint, VisibilityGraph, Window};
use lightloom_core::project::Project;

use super::picture::{Followed, Request};
use super::sample;

/// Most corners of a way that are drawn: more than the table of ways has.
const MOST_CORNERS: usize = 10_000;

/// The ways around the walls of one moment, remembered.
#[derive(Default)]
pub(super) struct Roads {
    last: Option<(Vec<ActiveWall>, VisibilityGraph)>,
}

impl Roads {
    /// Follows the photon of a row; none where there is no such photon now.
    pub(super) fn follow(&mut self, request: &Request, row: usize, progress: &Progress) -> Option<Followed> {
        let at = *request.preview.positions(request.frame)?.get(row)?;
        let target = *request.preview.targets(request.frame).get(row)?;
        let detour = self.detour(request, at, target, progress)?;
        Some(Followed { way: sample::way(request, row), at, target, detour })
    }

    /// None when cancelled.
    fn detour(
        &mut self,
        request: &Request,
        at: Vec2,
        target: Vec2,
        progress: &Progress,
    ) -> Option<Vec<Vec2>> {
        let walls = standing(&request.project, request.frame);
        if walls.is_empty() {
            return Some(vec![at, target]);
        }
        if self.last.as_ref().is_none_or(|(of, _)| *of != walls) {
            let all: Vec<&ActiveWall> = walls.iter().collect();
            match VisibilityGraph::new(&all, request.preview.extent(), progress) {
                Ok(detour) => self.last = Some((walls, detour)),
                Err(_) if progress.is_cancelled() => return None,
                // More walls than ways are made for: what is wrong is told by the animation.
                Err(_) => return Some(Vec::new()),
            }
        }
        let (_, detour) = self.last.as_ref()?;
        let Some(mut way) = detour.path(at, target, &mut SearchBuffers::default()) else {
            return Some(Vec::new());
        };
        let mut corners = vec![at];
        while !way.is_straight() && corners.len() < MOST_CORNERS {
            corners.push(detour.next_point(way, target));
            way = detour.after_corner(way);
        }
        corners.push(target);
        Some(corners)
    }
}

/// The walls that stand at a frame.
fn standing(project: &Arc<Project>, frame: i32) -> Vec<ActiveWall> {
    let now = |c: &&Constraint| c.span().is_none_or(|span| (span.from..=span.to).contains(&frame));
    let walls = project.constraints.iter().filter(now).filter_map(|constraint| match constraint {
        Constraint::Wall(wall) => wall.active(Window::ALWAYS),
        Constraint::DirectedLine(_) => None,
    });
    walls.collect()
}
