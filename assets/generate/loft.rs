//! Surfaces between a profile and a cross-section: turned glass, and bottles that are square below and round above.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::curve::Station;
use crate::mesh::Mesh;

/// The round cross-section: the surface is one of revolution.
pub(crate) fn round(_angle: f64, _height: f64, _inside: bool) -> f64 {
    1.0
}

/// Radius of the superellipse |cos|^n + |sin|^n = 1 at an angle: n = 2 is a circle, larger n a rounded square.
pub(crate) fn superellipse(exponent: f64, angle: f64) -> f64 {
    let [c, s] = [libm::cos(angle), libm::sin(angle)].map(|x| libm::pow(libm::fabs(x), exponent));
    libm::pow(c + s, -1.0 / exponent)
}

/// The closed surface R(u, angle) = x(u) section(angle, y(u), inside) at height y(u), for a profile (x, y)(u) from axis to axis
/// that keeps the outside on its right; `inside` is true on its way down, in the hollow of a vessel. `sides` vertices stand
/// on each ring; the two ends are single vertices.
pub(crate) fn loft(profile: &[Station], section: impl Fn(f64, f64, bool) -> f64, sides: usize) -> Mesh {
    let last = profile.len() - 1;
    let mut mesh = Mesh::default();
    for (i, station) in profile.iter().enumerate() {
        if i == 0 || i == last {
            mesh.positions.push(DVec3::new(0.0, station.point.y, 0.0));
            mesh.normals.push(DVec3::new(0.0, -station.tangent.x.signum(), 0.0));
            continue;
        }
        for side in 0..sides {
            let (position, normal) = vertex(station, &section, TAU * side as f64 / sides as f64);
            mesh.positions.push(position);
            mesh.normals.push(normal);
        }
    }
    mesh.triangles = triangles(last - 1, sides);
    mesh
}

/// Position and outward normal, the cross product of the derivatives along the profile and around the axis.
fn vertex(station: &Station, section: impl Fn(f64, f64, bool) -> f64, angle: f64) -> (DVec3, DVec3) {
    /// Step of the central differences of the section, which is smooth over degrees and millimetres.
    const STEP: f64 = 1e-5;
    let (x, y) = station.point.into();
    let (dx, dy) = station.tangent.into();
    let section = |angle, height| section(angle, height, dy < 0.0);
    let scale = section(angle, y);
    let by_angle = (section(angle + STEP, y) - section(angle - STEP, y)) / (2.0 * STEP);
    let by_height = (section(angle, y + STEP) - section(angle, y - STEP)) / (2.0 * STEP);
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let outward = DVec3::new(cos, 0.0, sin);
    let along = outward * (dx * scale + x * by_height * dy) + DVec3::Y * dy;
    let around = outward * by_angle + DVec3::new(-sin, 0.0, cos) * scale;
    (outward * (x * scale) + DVec3::Y * y, along.cross(around).normalize())
}

/// Triangles of `rings` closed rings between two poles; vertices are numbered pole, rings, pole.
fn triangles(rings: usize, sides: usize) -> Vec<[u32; 3]> {
    let index = |ring: usize, side: usize| (1 + ring * sides + side % sides) as u32;
    let (start, end) = (0, (1 + rings * sides) as u32);
    let mut triangles = Vec::with_capacity(2 * rings * sides);
    for side in 0..sides {
        triangles.push([start, index(0, side), index(0, side + 1)]);
    }
    for ring in 0..rings - 1 {
        for side in 0..sides {
            let [a, b] = [index(ring, side), index(ring + 1, side)];
            let [d, c] = [index(ring, side + 1), index(ring + 1, side + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    for side in 0..sides {
        triangles.push([index(rings - 1, side), end, index(rings - 1, side + 1)]);
    }
    triangles
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use glam::DVec2;

    use super::*;

    /// Half a circle around the origin, travelled from the south pole to the north pole.
    fn half_circle(steps: usize) -> Vec<Station> {
        let station = |k: usize| {
            let angle = TAU / 2.0 * k as f64 / steps as f64;
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            Station { point: DVec2::new(sin, -cos), tangent: DVec2::new(cos, sin) }
        };
        (0..=steps).map(station).collect()
    }

    #[test]
    fn a_turned_half_circle_is_a_sphere() {
        let sphere = loft(&half_circle(40), round, 80);
        sphere.check().unwrap();
        assert_eq!(sphere.euler_characteristic(), 2);
        for (p, n) in sphere.positions.iter().zip(&sphere.normals) {
            assert!(p.distance(*n) < 1e-9, "{p} {n}");
        }
        // The polyhedron misses about 2 pi^2 / 6 (1 / sides^2 + ...) of the ball: 0.3 % at this fineness.
        assert!((sphere.volume() / (2.0 * TAU / 3.0) - 1.0).abs() < 4e-3);
    }

    #[test]
    fn normals_of_a_square_section_stand_on_its_tangents() {
        let section = |angle, height: f64, _| superellipse(4.0 + height, angle);
        let mesh = loft(&half_circle(60), section, 120);
        mesh.check().unwrap();
        let fine = half_circle(6000);
        for (k, station) in half_circle(60).iter().enumerate().skip(1).take(59) {
            let (_, normal) = vertex(station, section, 0.4);
            let position = |a, k: usize| vertex(&fine[k], section, a).0;
            let around = position(0.401, 100 * k) - position(0.399, 100 * k);
            let along = position(0.4, 100 * k + 1) - position(0.4, 100 * k - 1);
            // Central differences of this step are exact to about 1e-6.
            assert!(
                normal.dot(around.normalize()).abs() < 1e-5 && normal.dot(along.normalize()).abs() < 1e-5
            );
        }
    }

    #[test]
    fn a_superellipse_of_exponent_two_is_a_circle() {
        for k in 0..12 {
            assert!((superellipse(2.0, 0.5 * f64::from(k)) - 1.0).abs() < 1e-12);
        }
        assert!(superellipse(6.0, TAU / 8.0) > 1.2);
    }
}
