//! Drawn constraints: directed lines that the light follows, walls that it never crosses.
//!
//! [`Constraint`] is the saved form. [`ActiveLine`] and [`ActiveWall`] are lines and walls within one segment;
//! [`Barriers`] tells which straight moves a wall blocks, [`VisibilityGraph`] finds the shortest paths around walls.

pub mod barrier;
pub mod directed_line;
pub mod span;
pub mod stroke;
pub mod visibility;
pub mod wall;

mod common;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use barrier::{Barriers, Closed};
pub use common::Common;
pub use directed_line::{ActiveLine, DirectedLine};
pub use span::{Span, Window};
pub use visibility::{VisibilityGraph, WallPath};
pub use wall::{ActiveWall, Wall};

use crate::Result;

/// A constraint drawn on the plane, as saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Constraint {
    /// Flow here, this way.
    DirectedLine(DirectedLine),
    /// Not through here.
    Wall(Wall),
}

/// What all kinds of constraints have in common, to be changed.
#[derive(Debug)]
pub struct CommonFields<'a> {
    /// The artist's name of it.
    pub name: &'a mut String,
    /// The group to which the artist puts it; empty without one.
    pub group: &'a mut String,
    /// Whether it acts at all.
    pub enabled: &'a mut bool,
    /// Whether the editor keeps it from being changed.
    pub locked: &'a mut bool,
}

impl Constraint {
    /// Its name as the artist reads it, such as `wall "upper hollow"`; one without is called by its number among all, from 1.
    pub fn called(&self, index: usize) -> String {
        let (kind, name) = match self {
            Self::DirectedLine(line) => ("directed line", &line.name),
            Self::Wall(wall) => ("wall", &wall.name),
        };
        if name.is_empty() { format!("{kind} {}", index + 1) } else { format!("{kind} \"{name}\"") }
    }

    /// Refuses values out of range; `place` is the path of this constraint, such as `constraints[0]`.
    ///
    /// # Errors
    /// `Value` names what is out of range.
    pub fn check(&self, place: &str) -> Result<()> {
        match self {
            Self::DirectedLine(line) => line.check(place),
            Self::Wall(wall) => wall.check(place),
        }
    }

    /// Whether it acts at all.
    pub fn is_enabled(&self) -> bool {
        match self {
            Self::DirectedLine(line) => line.enabled,
            Self::Wall(wall) => wall.enabled,
        }
    }

    /// Whether the editor keeps it from being changed.
    pub fn is_locked(&self) -> bool {
        match self {
            Self::DirectedLine(line) => line.locked,
            Self::Wall(wall) => wall.locked,
        }
    }

    /// The group to which the artist puts it; empty without one.
    pub fn group(&self) -> &str {
        match self {
            Self::DirectedLine(line) => &line.group,
            Self::Wall(wall) => &wall.group,
        }
    }

    /// The same after a change of what all kinds have in common.
    #[must_use]
    pub fn with(&self, change: impl FnOnce(CommonFields)) -> Self {
        let mut constraint = self.clone();
        change(match &mut constraint {
            Self::DirectedLine(DirectedLine { name, group, enabled, locked, .. })
            | Self::Wall(Wall { name, group, enabled, locked, .. }) => {
                CommonFields { name, group, enabled, locked }
            }
        });
        constraint
    }

    /// The points it was drawn through, plane units.
    pub fn points(&self) -> &[[f32; 2]] {
        match self {
            Self::DirectedLine(line) => &line.points,
            Self::Wall(wall) => &wall.points,
        }
    }

    /// When it acts; always without a span.
    pub fn span(&self) -> Option<&Span> {
        match self {
            Self::DirectedLine(line) => line.span.as_ref(),
            Self::Wall(wall) => wall.span.as_ref(),
        }
    }
}
