//! Directed lines that the flow follows, Term (6).
//!
//! A line asks the field for its own direction, along itself and, with falling weight, up to `width` beside it; its
//! strength is beta times its weight; beyond four widths it changes nothing. The speed asked for is that of the photons
//! around it times a factor. Houdini's POP Curve Incompressible Flow is the same idea at gamma 0.

use glam::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::common::{Common, enabled, is_false};
use super::span::{Span, Window};
use super::stroke;
use crate::Result;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};

/// Distance of the samples along a line, plane units: half a cell of the default grid.
const SPACING: f32 = 1.0 / 256.0;
/// Limit of samples along one line.
const MOST_SAMPLES: usize = 2000;
/// Samples across a line.
const ACROSS: usize = 9;

/// A line that the light shall follow, from its first point to its last.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Describe(Common::SETTINGS), transform = Describe(Self::SETTINGS))]
pub struct DirectedLine {
    /// The artist's name for it.
    #[serde(default)]
    pub name: String,
    /// Points in plane coordinates (x to the right, y upwards, the receiver's longer side 1), each -10 to 10; at most
    /// 10000 points.
    pub points: Vec<[f32; 2]>,
    /// Factor on `flow.beta` ([`Self::WEIGHT`]).
    #[serde(default = "default_weight")]
    pub weight: f32,
    /// Its speed over that of the light around it ([`Self::SPEED`]).
    #[serde(default = "default_speed")]
    pub speed: f32,
    /// Reach to each side, plane units ([`Self::WIDTH`]).
    #[serde(default = "default_width")]
    pub width: f32,
    /// The frames during which it pulls (default: all).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub span: Option<Span>,
    /// Whether it pulls at all.
    #[serde(default = "enabled")]
    pub enabled: bool,
    /// Whether the editor keeps it from being changed.
    #[serde(default, skip_serializing_if = "is_false")]
    pub locked: bool,
    /// The group to which the artist puts it ([`Common::GROUP`]).
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub group: String,
}

settings! { DirectedLine {
    /// Strength of the line: a factor on beta. Raise it where light ignores this line alone.
    WEIGHT = Setting::real("constraints[directed_line].weight", [0.0, 1000.0], &[1.0]);
    /// Speed along the line over that of the light around it. 1 steers without hurrying.
    SPEED = Setting::real("constraints[directed_line].speed", [0.0, 100.0], &[1.0]);
    /// How far beside the line it pulls, ever less; the plane's longer side is 1.
    WIDTH = Setting::real("constraints[directed_line].width", [0.001, 1.0], &[0.05]).unit("plane units");
} }

fn default_weight() -> f32 {
    DirectedLine::WEIGHT.value()
}

fn default_speed() -> f32 {
    DirectedLine::SPEED.value()
}

fn default_width() -> f32 {
    DirectedLine::WIDTH.value()
}

/// A directed line in one segment of the animation, sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct ActiveLine {
    /// Sample points along and beside the line, d_p of Term (6), plane units; their density falls with the weight.
    pub positions: Vec<Vec2>,
    /// The line itself, at least two points.
    pub points: Vec<Vec2>,
    /// Unit directions at the samples.
    pub directions: Vec<Vec2>,
    /// Factor on beta.
    pub weight: f32,
    /// Factor on the speed of the photons around it.
    pub speed: f32,
    /// Distance up to which it acts, plane units.
    pub width: f32,
    /// When it acts, in the segment's flow time.
    pub window: Window,
}

impl DirectedLine {
    /// A line of default strength and width that always pulls.
    pub fn new(points: Vec<[f32; 2]>) -> Self {
        Self {
            name: String::new(),
            points,
            weight: default_weight(),
            speed: default_speed(),
            width: default_width(),
            span: None,
            enabled: true,
            locked: false,
            group: String::new(),
        }
    }

    pub(super) fn check(&self, place: &str) -> Result<()> {
        stroke::check(&self.points, place)?;
        Self::WEIGHT.check(self.weight, place)?;
        Self::SPEED.check(self.speed, place)?;
        Self::WIDTH.check(self.width, place)?;
        self.span.as_ref().map_or(Ok(()), |span| span.check(place))
    }

    /// The line in one segment, on the rectangle `extent`; none where it is disabled, without weight, no longer than a
    /// point, or off the receiver.
    pub fn active(&self, window: Window, extent: Vec2) -> Option<ActiveLine> {
        if !self.enabled || self.weight == 0.0 {
            return None;
        }
        let points = stroke::clean(&self.points);
        let (mut positions, mut directions) = (Vec::new(), Vec::new());
        for (place, direction) in stroke::resample(&points, SPACING, MOST_SAMPLES) {
            for i in 0..ACROSS {
                let beside = quantile((i as f32 + 0.5) / ACROSS as f32) * self.width;
                let position = place + direction.perp() * beside;
                if position.cmpge(Vec2::ZERO).all() && position.cmple(extent).all() {
                    positions.push(position);
                    directions.push(direction);
                }
            }
        }
        (!positions.is_empty()).then_some(ActiveLine {
            points: stroke::simplify(&points, 0.02 * self.width),
            positions,
            directions,
            weight: self.weight,
            speed: self.speed,
            width: self.width,
            window,
        })
    }
}

/// The inverse distribution function of the weight (1 - x^2)^2 over -1..=1, whose integral is
/// (15 x - 10 x^3 + 3 x^5) / 16 + 1/2.
fn quantile(p: f32) -> f32 {
    let below = |x: f32| (15.0 * x - 10.0 * x.powi(3) + 3.0 * x.powi(5)) / 16.0 + 0.5;
    let (mut low, mut high) = (-1.0, 1.0);
    for _ in 0..24 {
        let middle = 0.5 * (low + high);
        if below(middle) < p { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_line_pulls_along_itself_most_and_not_beyond_its_width() {
        let line = DirectedLine { width: 0.1, ..DirectedLine::new(vec![[0.2, 0.5], [0.8, 0.5]]) };
        let active = line.active(Window::ALWAYS, Vec2::ONE).unwrap();
        assert!(active.directions.iter().all(|d| *d == Vec2::X));
        let beside: Vec<f32> = active.positions.iter().map(|p| (p.y - 0.5).abs()).collect();
        assert!(beside.iter().all(|b| *b < 0.1));
        let near = beside.iter().filter(|b| **b < 0.05).count();
        // Of (1 - x^2)^2, 79 % lie within half the width; nine samples across tell that to one of them.
        assert!((near as f32 / beside.len() as f32 - 0.79).abs() < 0.12);
    }

    #[test]
    fn dots_lines_off_the_receiver_and_lines_switched_off_do_not_pull() {
        let active = |line: DirectedLine| line.active(Window::ALWAYS, Vec2::ONE);
        assert!(active(DirectedLine::new(vec![])).is_none());
        assert!(active(DirectedLine::new(vec![[0.5, 0.5]; 4])).is_none());
        assert!(active(DirectedLine::new(vec![[2.0, 2.0], [3.0, 2.0]])).is_none());
        let off = DirectedLine { enabled: false, ..DirectedLine::new(vec![[0.2, 0.5], [0.8, 0.5]]) };
        assert!(active(off).is_none());
    }
}
