//! The title of a constraint.

use lightloom_core::constraint::Constraint;

/// The title of a constraint in lists: its name, or its kind and number.
pub(crate) fn title(constraint: &Constraint, index: usize) -> String {
    let (kind, name) = match constraint {
        Constraint::DirectedLine(line) => ("Line", &line.name),
        Constraint::Wall(wall) => ("Wall", &wall.name),
    };
    if name.is_empty() { format!("{kind} {}", index + 1) } else { name.clone() }
}
