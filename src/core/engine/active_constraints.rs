//! The drawn constraints: those that act in a segment, their picture on a contact sheet, and notes on odd ones.

use glam::Vec2;

use crate::Note;
use crate::constraint::{ActiveLine, ActiveWall, Barriers, Closed, Constraint, Window, stroke};
use crate::export::{MAGENTA, ORANGE, OverlayLine};
use crate::note::About;
use crate::project::Project;

/// Cells along the longer side in which lines are looked at for conflicts.
const CELLS: f32 = 64.0;

/// The lines and walls that act in one segment.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ActiveConstraints {
    pub(super) lines: Vec<ActiveLine>,
    pub(super) walls: Vec<ActiveWall>,
}

/// A constraint that acts in one segment.
enum Acting {
    Line(ActiveLine),
    Wall(ActiveWall),
}

/// The constraints that act from key frame `segment` to the next, on the rectangle `extent`.
pub(super) fn active(project: &Project, segment: usize, extent: Vec2) -> ActiveConstraints {
    let mut active = ActiveConstraints::default();
    for (_, acting) in acting(project, segment, extent) {
        match acting {
            Acting::Line(line) => active.lines.push(line),
            Acting::Wall(wall) => active.walls.push(wall),
        }
    }
    active
}

/// The same, each with its index among all constraints.
fn acting(project: &Project, segment: usize, extent: Vec2) -> impl Iterator<Item = (usize, Acting)> {
    let drawn = project.constraints.iter().enumerate().filter(|_| project.fits());
    drawn.filter_map(move |(index, constraint)| {
        let window = window(project, constraint, segment)?;
        let acting = match constraint {
            Constraint::DirectedLine(line) => Acting::Line(line.active(window, extent)?),
            Constraint::Wall(wall) => Acting::Wall(wall.active(window)?),
        };
        Some((index, acting))
    })
}

/// The window of a segment in which a constraint acts; none where it does not.
fn window(project: &Project, constraint: &Constraint, segment: usize) -> Option<Window> {
    let [from, to] = [&project.keys[segment], &project.keys[segment + 1]];
    match constraint.span() {
        None => Some(Window::ALWAYS),
        Some(span) => span.window([from.frame, to.frame], |share| from.ease.apply(share)),
    }
}

/// The enabled constraints as they are drawn on a sheet: lines in orange, walls in magenta; none unless the project asks
/// for them.
pub(super) fn drawn(project: &Project) -> Vec<OverlayLine> {
    let drawn = |constraint: &Constraint| {
        let points = stroke::clean(constraint.points());
        match constraint {
            Constraint::DirectedLine(_) => OverlayLine { points, colour: ORANGE, arrow: true },
            Constraint::Wall(_) => OverlayLine { points, colour: MAGENTA, arrow: false },
        }
    };
    let shown = project.constraints.iter().filter(|constraint| constraint.is_enabled());
    shown.filter(|_| project.output.draws_constraints).map(drawn).collect()
}

/// Notes on constraints that do nothing, contradict each other, or do other than they look.
pub(super) fn notes(project: &Project, extent: Vec2) -> Vec<Note> {
    if !project.fits() || project.keys.len() < 2 {
        return Vec::new();
    }
    let cells = project.flow.grid.cells(extent);
    let cell = (extent / Vec2::new(cells[0] as f32, cells[1] as f32)).max_element();
    let mut notes = Vec::new();
    for (i, constraint) in project.constraints.iter().enumerate().filter(|(_, c)| c.is_enabled()) {
        let windows = (1..project.keys.len()).filter_map(|next| window(project, constraint, next - 1));
        let odd = if stroke::clean(constraint.points()).is_empty() {
            Some("is no longer than a dot and does nothing; draw at least two points".to_owned())
        } else if windows.count() == 0 {
            Some("never acts: its frames lie beside the animation".to_owned())
        } else {
            odd(constraint, extent, cell)
        };
        notes.extend(odd.map(|odd| About::Constraint(i).note(format!("{} {odd}", constraint.called(i)))));
    }
    for segment in 0..project.keys.len() - 1 {
        notes.extend(notes_on_segment(project, segment, extent));
    }
    notes.sort();
    notes.dedup();
    notes
}

/// Notes on the constraints that act in one segment.
fn notes_on_segment(project: &Project, segment: usize, extent: Vec2) -> Vec<Note> {
    let (mut lines, mut walls, mut drawn_as) = (Vec::new(), Vec::new(), Vec::new());
    for (index, acting) in acting(project, segment, extent) {
        match acting {
            Acting::Line(line) => lines.push((index, line)),
            Acting::Wall(wall) => {
                walls.push(wall);
                drawn_as.push(index);
            }
        }
    }
    let barriers = Barriers::new(&walls.iter().collect::<Vec<_>>(), extent);
    let called = |index: usize| project.constraints[index].called(index);
    let of_walls = barriers.closed().iter().map(|closed| match *closed {
        Closed::Between(a, b) => {
            let [a, b] = [a, b].map(|wall| drawn_as[wall]);
            About::Constraint(a).note(format!(
                "{} and {} touch, or leave a gap narrower than they are thick: it is closed",
                called(a),
                called(b)
            ))
        }
        Closed::Across(wall) => {
            let wall = drawn_as[wall];
            let what = "reaches the border at both ends: no way leads around it";
            About::Constraint(wall).note(format!("{} {what}", called(wall)))
        }
    });
    of_walls.chain(conflict(&lines, called)).collect()
}

/// A note on one constraint on the receiver.
fn odd(constraint: &Constraint, extent: Vec2, cell: f32) -> Option<String> {
    match constraint {
        Constraint::DirectedLine(line) => {
            if line.active(Window::ALWAYS, extent).is_none() {
                return Some("lies off the receiver, or has no weight, and does nothing".into());
            }
            (line.width < cell).then(|| {
                format!("is {:.2} cells wide; the field cannot follow it so closely", line.width / cell)
            })
        }
        Constraint::Wall(wall) => {
            let on = |p: &&[f32; 2]| {
                Vec2::from(**p).cmpge(Vec2::ZERO).all() && Vec2::from(**p).cmple(extent).all()
            };
            if wall.points.iter().find(on).is_none() {
                return Some("lies off the receiver; only light that strays there meets it".into());
            }
            (wall.thickness < cell).then(|| {
                format!(
                    "is {:.2} cells thick: no light crosses it, but the field is too coarse to lead light along it",
                    wall.thickness / cell
                )
            })
        }
    }
}

/// Lines that ask for opposite directions in one place.
fn conflict(lines: &[(usize, ActiveLine)], called: impl Fn(usize) -> String) -> Option<Note> {
    let mut seen: std::collections::BTreeMap<[i32; 2], (usize, Vec2)> = Default::default();
    let places = lines
        .iter()
        .flat_map(|(index, line)| line.positions.iter().zip(&line.directions).map(|of| (*index, of)));
    for (index, (place, &direction)) in places {
        let cell = (*place * CELLS).floor().as_ivec2().to_array();
        let (other, first) = *seen.entry(cell).or_insert((index, direction));
        if first.dot(direction) < -0.5 {
            let who = match other == index {
                true => format!("{} contradicts itself", called(index)),
                false => format!("{} and {} contradict each other", called(other), called(index)),
            };
            return Some(About::Constraint(index).note(format!(
                "{who} near ({:.2}, {:.2}): the field takes the mean of what is asked for",
                place.x, place.y
            )));
        }
    }
    None
}
