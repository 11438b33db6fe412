//! What the artist drew, as it acts in one segment.

use glam::Vec2;

use crate::constraint::{ActiveLine, ActiveWall, Constraint, Window};
use crate::project::Project;

/// Lines and walls of one segment.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Drawn {
    pub(super) lines: Vec<ActiveLine>,
    pub(super) walls: Vec<ActiveWall>,
}

/// What acts from key `segment` to the next, on the rectangle `extent`.
pub(super) fn drawn(project: &Project, segment: usize, extent: Vec2) -> Drawn {
    let mut drawn = Drawn::default();
    let [from, to] = [&project.keys[segment], &project.keys[segment + 1]];
    for constraint in &project.constraints {
        let time_of = |share| from.ease.apply(share);
        let window = match constraint.span() {
            None => Some(Window::ALWAYS),
            Some(span) => span.window([from.frame, to.frame], time_of),
        };
        let Some(window) = window else { continue };
        match constraint {
            Constraint::DirectedLine(line) => drawn.lines.extend(line.active(window, extent)),
            Constraint::Wall(wall) => drawn.walls.extend(wall.active(window)),
        }
    }
    drawn
}

/// What acts in each segment.
pub(super) fn all_drawn(project: &Project, extent: Vec2) -> Vec<Drawn> {
    (1..project.keys.len()).map(|next| drawn(project, next - 1, extent)).collect()
}
