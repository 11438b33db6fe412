//! Implicit figures: smooth functions, negative inside, put together by smooth unions.
//!
//! Everything here has all derivatives near the surface (hence the exponential union rather than a polynomial one): a crease in
//! the curvature, though hardly seen, would draw a line into the caustic.

use glam::{DMat3, DVec3};

/// An ellipsoid anywhere in space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ellipsoid {
    centre: DVec3,
    /// Per axis: direction in the frame of the ellipsoid divided by its radius.
    shrink: DMat3,
    shrink_twice: DMat3,
}

impl Ellipsoid {
    /// An ellipsoid whose own axes are turned by `tilt` degrees around z, after `roll` degrees around x and `yaw` around y.
    pub(crate) fn new(centre: [f64; 3], radii: [f64; 3], [roll, yaw, tilt]: [f64; 3]) -> Self {
        let turn = around(2, tilt) * around(1, yaw) * around(0, roll);
        let shrink = DMat3::from_diagonal(DVec3::from(radii).recip()) * turn.transpose();
        let shrink_twice = DMat3::from_diagonal(DVec3::from(radii).recip()) * shrink;
        Self { centre: centre.into(), shrink, shrink_twice }
    }

    /// The same ellipsoid on the other side of the plane z = 0.
    pub(crate) fn mirrored(self) -> Self {
        let flip = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
        let [shrink, shrink_twice] = [self.shrink, self.shrink_twice].map(|m| m * flip);
        Self { centre: flip * self.centre, shrink, shrink_twice }
    }

    /// Nearly the signed distance: exact to first order at the surface.
    pub(crate) fn at(&self, point: DVec3) -> f64 {
        let p = point - self.centre;
        let k = (self.shrink * p).length();
        // At the very centre the quotient is 0 / 0; its size there does not matter as long as it is inside.
        k * (k - 1.0) / (self.shrink_twice * p).length().max(1e-9)
    }
}

/// Smooth union of two figures; the seam is rounded over about `radius`.
pub(crate) fn join(a: f64, b: f64, radius: f64) -> f64 {
    let apart = (a - b).abs() / radius;
    // Beyond 40 the second term is less than a rounding of the first.
    if apart > 40.0 { a.min(b) } else { a.min(b) - radius * libm::log1p(libm::exp(-apart)) }
}

/// `a` without `b`, the edge rounded over about `radius`.
pub(crate) fn carve(a: f64, b: f64, radius: f64) -> f64 {
    -join(-a, b, radius)
}

/// Gradient of a field by central differences of the given step.
pub(crate) fn gradient(field: impl Fn(DVec3) -> f64, point: DVec3, step: f64) -> DVec3 {
    let slope = |axis: DVec3| (field(point + step * axis) - field(point - step * axis)) / (2.0 * step);
    DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z))
}

/// Rotation by an angle in degrees around one coordinate axis.
fn around(axis: usize, degrees: f64) -> DMat3 {
    let (sin, cos) = (libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians()));
    let (next, last) = (DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]);
    let mut columns = DVec3::AXES;
    columns[(axis + 1) % 3] = cos * next + sin * last;
    columns[(axis + 2) % 3] = cos * last - sin * next;
    DMat3::from_cols(columns[0], columns[1], columns[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ellipsoid_vanishes_on_its_surface_with_unit_slope() {
        let figure = Ellipsoid::new([1.0, 2.0, 3.0], [3.0, 1.0, 2.0], [0.0, 0.0, 90.0]);
        for tip in [DVec3::new(0.0, 3.0, 0.0), DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 0.0, 2.0)] {
            let point = DVec3::new(1.0, 2.0, 3.0) + tip;
            assert!(figure.at(point).abs() < 1e-12);
            assert!((gradient(|p| figure.at(p), point, 1e-4).length() - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn a_mirrored_ellipsoid_is_the_mirror_image() {
        let figure = Ellipsoid::new([1.0, 2.0, 3.0], [3.0, 1.0, 2.0], [10.0, 20.0, 30.0]);
        let point = DVec3::new(0.3, -1.0, 2.0);
        let there = figure.mirrored().at(point * DVec3::new(1.0, 1.0, -1.0));
        assert!((figure.at(point) - there).abs() < 1e-12);
    }

    #[test]
    fn joining_and_carving_only_matter_near_the_seam() {
        assert!((join(1.0, 3.0, 0.05) - 1.0).abs() < 1e-12);
        assert!((carve(1.0, 3.0, 0.05) - 1.0).abs() < 1e-12);
        assert!((carve(-3.0, -1.0, 0.05) - 1.0).abs() < 1e-12);
        assert!(join(0.0, 0.0, 0.1) < 0.0 && carve(0.0, 0.0, 0.1) > 0.0);
    }
}
