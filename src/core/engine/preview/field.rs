//! The velocity at one frame, for arrows, streamlines and maps.

use std::ops::Range;

use glam::{Mat2, Vec2};

use crate::flow::field::{Field, Grid};

/// Everything that moves some caustics at one frame: the fitted field and the turbulence together.
pub struct FieldAt {
    /// The fitted field first.
    fields: Vec<Field>,
    rows: Vec<Range<usize>>,
}

impl FieldAt {
    /// Of fields whose velocities add up, the fitted one first; none where there is no field.
    pub(super) fn new(fields: Vec<Field>, rows: Vec<Range<usize>>) -> Option<Self> {
        (!fields.is_empty()).then_some(Self { fields, rows })
    }

    /// The rows of the photons that it moves.
    pub fn rows(&self) -> &[Range<usize>] {
        &self.rows
    }

    /// The grid on which it was fitted; turbulence has its own.
    pub fn grid(&self) -> Grid {
        self.fields[0].grid()
    }

    /// The velocity u at a plane point, plane units per segment.
    pub fn velocity(&self, p: Vec2) -> Vec2 {
        self.fields.iter().map(|field| field.velocity(p)).sum()
    }

    /// How much the flow spreads (above 0) or gathers (below) at a plane point, per segment.
    pub fn divergence(&self, p: Vec2) -> f32 {
        let gradient = self.gradient(p);
        gradient.x_axis.x + gradient.y_axis.y
    }

    /// How fast the flow turns at a plane point, counter-clockwise above 0, radians per segment times two.
    pub fn curl(&self, p: Vec2) -> f32 {
        let gradient = self.gradient(p);
        gradient.x_axis.y - gradient.y_axis.x
    }

    fn gradient(&self, p: Vec2) -> Mat2 {
        self.fields.iter().fold(Mat2::ZERO, |sum, field| sum + field.gradient(p))
    }
}
