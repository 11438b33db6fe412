//! Sizes of the lanes, and the constraints that have one.

use lightloom_core::constraint::Constraint;
use lightloom_core::project::Project;

use crate::editor::selection::Selection;

/// Width of the lane titles at the left, points.
pub(super) const GUTTER: f32 = 84.0;

/// Height of the lane of key frames, points.
pub(super) const KEYS: f32 = 74.0;
/// Height of one bar with its gap, points.
pub(super) const ROW: f32 = 20.0;

/// Indices of the constraints with a bar: those with a span, and the selected.
pub(super) fn with_bar(project: &Project, selection: &Selection) -> Vec<usize> {
    let has_bar = |(i, c): &(usize, &Constraint)| c.span().is_some() || selection.contains(*i);
    project.constraints.iter().enumerate().filter(has_bar).map(|(i, _)| i).collect()
}
