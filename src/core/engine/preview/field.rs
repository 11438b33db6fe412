//! The velocity field at one frame, for arrows, streamlines and maps.

use std::ops::Range;

use glam::{Mat2, Vec2};

use crate::flow::field::{Field, Grid};

/// The velocity field of some caustics at one frame: the fitted field plus the turbulence.
pub struct FieldAt {
    /// The fitted field first.
    fields: Vec<Field>,
    rows: Vec<Range<usize>>,
}

impl FieldAt {
    /// The sum of these fields, the fitted one first; none where there is no field.
    pub(super) fn new(fields: Vec<Field>, rows: Vec<Range<usize>>) -> Option<Self> {
        (!fields.is_empty()).then_some(Self { fields, rows })
    }

    /// The rows of its photons.
    pub fn rows(&self) -> &[Range<usize>] {
        &self.rows
    }

    /// The grid of the fitted field; turbulence has its own.
    pub fn grid(&self) -> Grid {
        self.fields[0].grid()
    }

    /// The velocity u at a plane point, plane units per segment.
    pub fn velocity(&self, p: Vec2) -> Vec2 {
        self.fields.iter().map(|field| field.velocity(p)).sum()
    }

    /// Divergence at a plane point, per segment: above 0 the flow spreads.
    pub fn divergence(&self, p: Vec2) -> f32 {
        let gradient = self.gradient(p);
        gradient.x_axis.x + gradient.y_axis.y
    }

    /// Curl at a plane point, per segment: above 0 the flow turns counter-clockwise.
    pub fn curl(&self, p: Vec2) -> f32 {
        let gradient = self.gradient(p);
        gradient.x_axis.y - gradient.y_axis.x
    }

    fn gradient(&self, p: Vec2) -> Mat2 {
        self.fields.iter().fold(Mat2::ZERO, |sum, field| sum + field.gradient(p))
    }
}
