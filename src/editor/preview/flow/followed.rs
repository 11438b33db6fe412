//! The followed photon: its trajectory, its target, its shortest path around walls.

use std::sync::Arc;

use glam::Vec2;
use lightloom_core::Progress;
use lightloom_core::constraint::visibility::SearchBuffers;
use lightloom_core::constraint::{ActiveWall, Constraint, VisibilityGraph, Window};
use lightloom_core::project::Project;

use super::picture::{Followed, Request};
use super::sample;

/// Most corners of a path that are drawn: more than any path has.
const MOST_CORNERS: usize = 10_000;

/// The visibility graph of the walls of one moment, remembered.
#[derive(Default)]
pub(super) struct WallGraph {
    last: Option<(Vec<ActiveWall>, VisibilityGraph)>,
}

impl WallGraph {
    /// Follows the photon of a row; none where there is no such photon now.
    pub(super) fn follow(&mut self, request: &Request, row: usize, progress: &Progress) -> Option<Followed> {
        let at = *request.preview.positions(request.frame)?.get(row)?;
        let target = *request.preview.targets(request.frame).get(row)?;
        let path_around_walls = self.path_around_walls(request, at, target, progress)?;
        Some(Followed { trajectory: sample::trajectory(request, row), at, target, path_around_walls })
    }

    /// None when cancelled.
    fn path_around_walls(
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
                Ok(graph) => self.last = Some((walls, graph)),
                Err(_) if progress.is_cancelled() => return None,
                // Too many walls; the preview worker reports it.
                Err(_) => return Some(Vec::new()),
            }
        }
        let (_, graph) = self.last.as_ref()?;
        let Some(mut path) = graph.path(at, target, &mut SearchBuffers::default()) else {
            return Some(Vec::new());
        };
        let mut corners = vec![at];
        while !path.is_straight() && corners.len() < MOST_CORNERS {
            corners.push(graph.next_point(path, target));
            path = graph.after_corner(path);
        }
        corners.push(target);
        Some(corners)
    }
}

/// The walls that stand at a frame.
fn standing(project: &Arc<Project>, frame: i32) -> Vec<ActiveWall> {
    let now = |c: &&Constraint| c.span().is_none_or(|span| span.contains(frame));
    let walls = project.constraints.iter().filter(now).filter_map(|constraint| match constraint {
        Constraint::Wall(wall) => wall.active(Window::ALWAYS),
        Constraint::DirectedLine(_) => None,
    });
    walls.collect()
}
