//! Walls: lines that no photon crosses.
//!
//! Paths around a wall keep half its thickness away from its line. Gaps narrower than the thickness, between two walls,
//! between a wall's two ends, or between a wall and the border of the receiver, count as closed. Photons whose target no
//! path reaches go straight, and are counted.

use glam::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::common::{Common, enabled, is_false};
use super::span::{Span, Window};
use super::stroke;
use crate::Result;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};

/// A line that no light crosses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Describe(Common::SETTINGS), transform = Describe(Self::SETTINGS))]
pub struct Wall {
    /// The artist's name for it.
    #[serde(default)]
    pub name: String,
    /// The line in plane coordinates (x to the right, y upwards, the receiver's longer side 1), each -10 to 10; at most
    /// 10000 points. A loop ends where it begins.
    pub points: Vec<[f32; 2]>,
    /// Twice the distance that light keeps from the line, plane units ([`Self::THICKNESS`]).
    #[serde(default = "default_thickness")]
    pub thickness: f32,
    /// The frames during which it stands (default: all). Light that it holds back meanwhile goes on afterwards.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub span: Option<Span>,
    /// Whether it stands at all.
    #[serde(default = "enabled")]
    pub enabled: bool,
    /// Whether the editor keeps it from being changed.
    #[serde(default, skip_serializing_if = "is_false")]
    pub locked: bool,
    /// The group to which the artist puts it ([`Common::GROUP`]).
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub group: String,
}

settings! { Wall {
    /// Thickness of the wall, by default three cells of the default grid: light on its way around keeps half of it away
    /// from the line. Narrower gaps count as closed.
    THICKNESS = Setting::real("constraints[wall].thickness", [1e-4, 0.5], &[3.0 / 128.0]).unit("plane units");
} }

fn default_thickness() -> f32 {
    Wall::THICKNESS.value()
}

/// A wall in one segment of the animation.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct ActiveWall {
    /// Its line, at least two points, plane units.
    pub points: Vec<Vec2>,
    /// Half its thickness: the distance that paths keep from the line, plane units.
    pub clearance: f32,
    /// When it stands, in the segment's flow time.
    pub window: Window,
}

impl Wall {
    /// A wall of default thickness that always stands.
    pub fn new(points: Vec<[f32; 2]>) -> Self {
        Self {
            name: String::new(),
            points,
            thickness: default_thickness(),
            span: None,
            enabled: true,
            locked: false,
            group: String::new(),
        }
    }

    pub(super) fn check(&self, place: &str) -> Result<()> {
        stroke::check(&self.points, place)?;
        Self::THICKNESS.check(self.thickness, place)?;
        self.span.as_ref().map_or(Ok(()), |span| span.check(place))
    }

    /// The wall in one segment; none where it is disabled or no longer than a point.
    pub fn active(&self, window: Window) -> Option<ActiveWall> {
        let points = stroke::clean(&self.points);
        (self.enabled && !points.is_empty()).then_some(ActiveWall {
            points,
            clearance: 0.5 * self.thickness,
            window,
        })
    }
}
