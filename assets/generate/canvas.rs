//! Drawing by signed distance: every pixel asks every shape how far away it is, and is covered accordingly.
//!
//! Pictures span [-1, 1] x [-1, 1] with y upwards.

use glam::DVec2;
use image::{GrayImage, Luma};

use crate::curve::{Curve, Fineness};

/// A square picture; `tone` paints one pixel.
pub(crate) fn draw(size: u32, tone: impl Fn(&mut Pixel)) -> GrayImage {
    GrayImage::from_fn(size, size, |column, row| {
        let mut pixel = Pixel::new(size, column, row);
        tone(&mut pixel);
        Luma([(255.0 * pixel.tone.clamp(0.0, 1.0)).round() as u8])
    })
}

/// One pixel being painted over, black at first.
pub(crate) struct Pixel {
    /// Its centre.
    pub at: DVec2,
    /// Its brightness, 0 to 1.
    pub tone: f64,
    width: f64,
}

impl Pixel {
    /// The pixel in a column from the left and a row from the top.
    pub(crate) fn new(size: u32, column: u32, row: u32) -> Self {
        let width = 2.0 / f64::from(size);
        let step = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5) * width;
        Self { at: DVec2::new(step.x - 1.0, 1.0 - step.y), tone: 0.0, width }
    }

    /// How much of the pixel lies inside a shape at this signed distance, 0 to 1.
    pub(crate) fn coverage(&self, distance: f64) -> f64 {
        (0.5 - distance / self.width).clamp(0.0, 1.0)
    }

    /// Paints over the inside of a shape.
    pub(crate) fn fill(&mut self, distance: f64, tone: f64) {
        self.tone += (tone - self.tone) * self.coverage(distance);
    }

    /// Draws a line of this width along the outline of a shape, where it is brighter than what is there.
    pub(crate) fn line(&mut self, distance: f64, width: f64, tone: f64) {
        let covered = self.coverage(distance.abs() - width / 2.0);
        self.tone = self.tone.max(tone * covered + self.tone * (1.0 - covered));
    }
}

/// Signed distance, exact to first order at its zero, of any smooth function that is negative inside.
pub(crate) fn distance(shape: impl Fn(DVec2) -> f64, at: DVec2) -> f64 {
    const STEP: f64 = 1e-4;
    let slope = |axis: DVec2| (shape(at + STEP * axis) - shape(at - STEP * axis)) / (2.0 * STEP);
    // Where the function is flat (far inside), any size will do.
    shape(at) / DVec2::new(slope(DVec2::X), slope(DVec2::Y)).length().max(1e-6)
}

/// A curve as a chain of segments, to draw strokes along.
pub(crate) struct Stroke {
    points: Vec<DVec2>,
}

/// Where a stroke comes nearest to a point.
pub(crate) struct Nearest {
    /// Distance from the curve.
    pub distance: f64,
    /// Distance with a sign: positive on the left of the curve.
    pub side: f64,
    /// Way along the curve, from 0 at its start to 1 at its end.
    pub along: f64,
}

impl Stroke {
    /// Along a smooth curve through the first and the last of its control points.
    pub(crate) fn along(control: &[(f64, f64)]) -> Self {
        let control: Vec<_> = control.iter().copied().map(DVec2::from).collect();
        let stations = Curve::open(&control).stations(Fineness { step: 0.03, turn: 0.1 });
        Self { points: stations.iter().map(|s| s.point).collect() }
    }

    /// Along an elliptic arc between two angles in degrees, counter-clockwise if the second is larger.
    pub(crate) fn arc(centre: DVec2, radii: DVec2, [from, to]: [f64; 2]) -> Self {
        let steps = libm::ceil((to - from).abs() / 2.0) as usize;
        let point = |k: usize| {
            let angle = (from + (to - from) * k as f64 / steps as f64).to_radians();
            centre + radii * DVec2::new(libm::cos(angle), libm::sin(angle))
        };
        Self { points: (0..=steps).map(point).collect() }
    }

    /// This stroke followed by another.
    pub(crate) fn then(mut self, next: Self) -> Self {
        self.points.extend(next.points);
        self
    }

    /// Where the stroke comes nearest to a point.
    pub(crate) fn nearest(&self, at: DVec2) -> Nearest {
        let mut best = (f64::INFINITY, 0, 0.0);
        for (k, pair) in self.points.windows(2).enumerate() {
            let side = pair[1] - pair[0];
            let within = ((at - pair[0]).dot(side) / side.length_squared().max(1e-12)).clamp(0.0, 1.0);
            let squared = (pair[0] + within * side).distance_squared(at);
            if squared < best.0 {
                best = (squared, k, within);
            }
        }
        let (squared, k, within) = best;
        let turn = (self.points[k + 1] - self.points[k]).perp_dot(at - self.points[k]);
        let distance = squared.sqrt();
        Nearest {
            distance,
            side: distance.copysign(turn),
            along: (k as f64 + within) / (self.points.len() - 1) as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disc_covers_its_area() {
        let picture = draw(64, |pixel| {
            let distance = pixel.at.length() - 0.7;
            pixel.fill(distance, 1.0);
        });
        let mean = picture.pixels().map(|p| f64::from(p.0[0]) / 255.0).sum::<f64>() / 4096.0;
        // Rounding to 8 bits leaves 0.002 at most on the rim pixels; the coverage itself is exact to 1e-3.
        assert!((4.0 * mean - 0.49 * std::f64::consts::PI).abs() < 4e-3);
    }

    #[test]
    fn a_stroke_knows_its_sides_and_its_length() {
        let stroke = Stroke::arc(DVec2::ZERO, DVec2::ONE, [0.0, 90.0]);
        let inside = stroke.nearest(0.5 * DVec2::from_angle(0.25 * std::f64::consts::PI));
        // The chord of two degrees lies 1.5e-4 inside the arc.
        assert!(
            (inside.distance - 0.5).abs() < 2e-4 && inside.side > 0.0 && (inside.along - 0.5).abs() < 1e-6
        );
        assert!(stroke.nearest(DVec2::new(2.0, 0.0)).side < 0.0);
    }

    #[test]
    fn distances_of_stretched_shapes_are_right_at_the_outline() {
        let ellipse = |p: DVec2| p.x * p.x / 0.25 + p.y * p.y - 1.0;
        assert!((distance(ellipse, DVec2::new(0.51, 0.0)) - 0.01).abs() < 3e-4);
        assert!((distance(ellipse, DVec2::new(0.0, 1.01)) - 0.01).abs() < 3e-4);
    }
}
