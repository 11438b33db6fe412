//! What the fit makes of walls otherwise than they look, said at its place: gaps that count as closed, walls thinner than a cell.

use egui::{Color32, FontId, Pos2, Rect, Stroke, pos2};
use glam::Vec2;
use lightloom_core::constraint::{ActiveWall, Barriers, Constraint, Wall, Window};

use super::Overlay;
use crate::editor::theme;
use crate::editor::tools::{Ghost, ToolContext};

/// Most points of all walls for which gaps are looked for in each frame of the window.
const MOST: usize = 3000;

/// A warning, the plane points that it marks, and its words.
#[derive(Debug, PartialEq)]
struct Warning {
    marks: [Vec2; 2],
    words: &'static str,
}

const CLOSED: &str = "closed: the gap is narrower than the wall is thick";
const THIN: &str = "thinner than a cell of the grid: light may be held back beside it";

/// Distance of words from the middle of a mark, points.
const BESIDE: f32 = 18.0;
/// Border of the ground of words, points.
const MARGIN: f32 = 3.0;
/// Width of the shortest lines, points.
const NARROWEST: f32 = 80.0;

impl Overlay<'_> {
    /// Marks what is wrong with walls while one is drawn or selected.
    pub(super) fn warnings(&self, context: &ToolContext, ghosts: &[Ghost]) {
        for Warning { marks, words } in warnings(context, ghosts) {
            let [Some(from), Some(to)] = marks.map(|p| (self.screen)(p)) else { continue };
            let middle = from + 0.5 * (to - from);
            self.painter.line_segment([from, to], Stroke::new(2.0, theme::WARN));
            for (width, colour) in [(4.0, Color32::from_black_alpha(150)), (2.0, theme::WARN)] {
                let radius = 6.0 + 0.5 * from.distance(to);
                self.painter.circle_stroke(middle, radius.min(14.0), Stroke::new(width, colour));
            }
            self.words_beside(middle, words);
        }
    }

    /// Words beside a mark, on the side with more room, in lines that fit there.
    fn words_beside(&self, mark: Pos2, words: &str) {
        let view = self.painter.clip_rect();
        let room = [mark.x - view.left(), view.right() - mark.x].map(|room| room - BESIDE - MARGIN);
        let font = FontId::proportional(12.0);
        let lines =
            self.painter.layout(words.to_owned(), font, theme::WARN, room[0].max(room[1]).max(NARROWEST));
        let size = lines.size();
        let left = if room[1] >= room[0] { mark.x + BESIDE } else { mark.x - BESIDE - size.x };
        let place = Rect::from_min_size(pos2(left, mark.y - 0.5 * size.y), size);
        self.painter.rect_filled(place.expand(MARGIN), MARGIN, Color32::from_black_alpha(190));
        self.painter.galley(place.min, lines, theme::WARN);
    }
}

fn warnings(context: &ToolContext, ghosts: &[Ghost]) -> Vec<Warning> {
    let (project, frame) = (context.project, context.session.playhead);
    let drawn = ghosts.iter().find_map(|ghost| match ghost {
        Ghost::Wall(points, thickness) if points.len() > 1 => {
            let points = points.iter().map(|p| (*p).into()).collect();
            Wall { thickness: *thickness, ..Wall::new(points) }.active(Window::ALWAYS)
        }
        _ => None,
    });
    let walls = project.constraints.iter().enumerate().filter_map(|(i, constraint)| match constraint {
        Constraint::Wall(wall) => Some((i, wall)),
        Constraint::DirectedLine(_) => None,
    });
    let stands = |wall: &Wall| wall.span.as_ref().is_none_or(|span| span.contains(frame));
    let chosen = |i: usize| context.session.selection.contains(i);
    let standing: Vec<(bool, ActiveWall)> = walls
        .filter(|(_, wall)| stands(wall))
        .filter_map(|(i, wall)| Some((chosen(i), wall.active(Window::ALWAYS)?)))
        .chain(drawn.map(|wall| (true, wall)))
        .collect();
    if !standing.iter().any(|(chosen, _)| *chosen) {
        return Vec::new();
    }
    let cells = project.flow.grid.cells(context.extent);
    let cell = (context.extent.x / cells[0].max(1) as f32).max(context.extent.y / cells[1].max(1) as f32);
    let thin = standing.iter().filter(|(chosen, wall)| *chosen && 2.0 * wall.clearance < cell);
    let mut all: Vec<Warning> = thin
        .filter_map(|(_, wall)| wall.points.get(wall.points.len() / 2))
        .map(|&p| Warning { marks: [p, p], words: THIN })
        .collect();
    if standing.iter().map(|(_, wall)| wall.points.len()).sum::<usize>() <= MOST {
        let walls: Vec<&ActiveWall> = standing.iter().map(|(_, wall)| wall).collect();
        all.extend(Barriers::closed_gaps(&walls).into_iter().map(|marks| Warning { marks, words: CLOSED }));
    }
    all
}

#[cfg(test)]
mod tests {
    use lightloom_core::import::empty_project;
    use lightloom_core::project::Project;

    use super::*;
    use crate::editor::selection::Selection;
    use crate::editor::session::Session;
    use crate::editor::tools::HeldKeys;

    fn said(walls: &[Wall], selection: Selection, ghosts: &[Ghost]) -> Vec<&'static str> {
        let constraints = walls.iter().cloned().map(Constraint::Wall).collect();
        let project = Project { constraints, ..empty_project() };
        let session = Session { selection, ..Session::default() };
        let context = ToolContext {
            project: &project,
            session: &session,
            extent: Vec2::ONE,
            per_point: 0.002,
            held: HeldKeys::default(),
            picture: None,
            photons: &[],
        };
        warnings(&context, ghosts).into_iter().map(|warning| warning.words).collect()
    }

    #[test]
    fn a_closed_gap_is_said_while_the_second_wall_is_drawn_and_a_thin_wall_while_it_is_selected() {
        let wall = Wall::new(vec![[0.5, 0.1], [0.5, 0.5]]);
        let ahead = |y: f32| [Ghost::Wall(vec![Vec2::new(0.5, y), Vec2::new(0.5, 0.9)], wall.thickness)];
        let walls = [wall.clone()];
        assert_eq!(said(&walls, Selection::default(), &ahead(0.51)), [CLOSED]);
        assert!(said(&walls, Selection::default(), &ahead(0.6)).is_empty());
        let thin = [Wall { thickness: 1e-3, ..wall.clone() }];
        assert_eq!(said(&thin, Selection::one(0), &[]), [THIN]);
        assert!(said(&thin, Selection::default(), &[]).is_empty());
    }
}
