//! What the artist draws to steer the light: directed lines it follows, walls it never crosses.
//!
//! [`Constraint`] is what is saved. [`lines`](ActiveLine) pull at the fit; [`Barriers`] and [`Detour`] are the walls as
//! the flow and the matching see them: what blocks a straight way, and which is the shortest way around.

pub mod barrier;
pub mod detour;
pub mod directed_line;
pub mod span;
pub mod stroke;
pub mod wall;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use barrier::Barriers;
pub use detour::{Detour, Way};
pub use directed_line::{ActiveLine, DirectedLine};
pub use span::{Span, Window};
pub use wall::{ActiveWall, Wall};

use crate::Result;
use crate::setting::{Choice, Setting, settings};

/// Something drawn on the plane, as saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Constraint {
    /// Flow here, this way.
    DirectedLine(DirectedLine),
    /// Not through here.
    Wall(Wall),
}

settings! { Constraint {
    /// The artist's name for it.
    NAME = Setting::text("constraints[].name");
    /// The frames during which it acts. Light that a wall holds back meanwhile goes on afterwards.
    SPAN = Setting::choice("constraints[].span", &[
        Choice { value: "", help: "in all frames" },
        Choice { value: "", help: "from one frame to another" },
    ]);
    /// Whether it acts at all: the eye in the editor's list.
    ENABLED = Setting::switch("constraints[].enabled", true);
    /// Whether the editor keeps it from being changed: the padlock in its list.
    LOCKED = Setting::switch("constraints[].locked", false);
} }

impl Constraint {
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

    /// The points it was drawn through, plane units.
    pub fn points(&self) -> &[[f32; 2]] {
        match self {
            Self::DirectedLine(line) => &line.points,
            Self::Wall(wall) => &wall.points,
        }
    }

    /// When it acts; always where there is no span.
    pub fn span(&self) -> Option<&Span> {
        match self {
            Self::DirectedLine(line) => line.span.as_ref(),
            Self::Wall(wall) => wall.span.as_ref(),
        }
    }
}

pub(crate) fn enabled() -> bool {
    Constraint::ENABLED.is_on()
}

/// What is not said need not be written.
pub(crate) fn is_false(value: &bool) -> bool {
    !value
}
