//! Plain targets: letters, a star, a spiral.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use image::GrayImage;

use crate::canvas::{Stroke, draw};

const SIZE: u32 = 1024;
/// Width of the strokes of the letters, and half their height from middle line to middle line.
const WEIGHT: f64 = 0.24;
const HALF_HEIGHT: f64 = 0.62;

/// The letter C: an arc, open by 100 degrees.
pub(crate) fn letter_c() -> GrayImage {
    let radii = DVec2::new(0.56, HALF_HEIGHT);
    letter(&Stroke::arc(DVec2::new(0.06, 0.0), radii, [50.0, 310.0]))
}

/// The letter S: two arcs that meet in the middle with a common tangent.
pub(crate) fn letter_s() -> GrayImage {
    let radii = DVec2::new(0.44, HALF_HEIGHT / 2.0);
    let upper = Stroke::arc(DVec2::new(0.0, radii.y), radii, [28.0, 270.0]);
    let lower = Stroke::arc(DVec2::new(0.0, -radii.y), radii, [90.0, -152.0]);
    letter(&upper.then(lower))
}

fn letter(stroke: &Stroke) -> GrayImage {
    draw(SIZE, |pixel| pixel.fill(stroke.nearest(pixel.at).distance - WEIGHT / 2.0, 1.0))
}

/// A five-pointed star cut in facets, bright and less bright by turns, with slightly rounded points.
pub(crate) fn star() -> GrayImage {
    const OUTER: f64 = 0.86;
    const INNER: f64 = 0.36;
    const ROUNDING: f64 = 0.02;
    let corner = |angle: f64, radius: f64| radius * DVec2::new(libm::sin(angle), libm::cos(angle));
    draw(SIZE, |pixel| {
        let angle = libm::atan2(pixel.at.x, pixel.at.y);
        // Folded into half an arm: the tip upwards, the notch on its right.
        let turn = (angle / (TAU / 5.0)).round() * (TAU / 5.0);
        let folded = corner(angle - turn, pixel.at.length());
        let (tip, notch) = (corner(0.0, OUTER), corner(PI / 5.0, INNER));
        let to = DVec2::new(folded.x.abs(), folded.y) - tip;
        let side = notch - tip;
        let within = (to.dot(side) / side.length_squared()).clamp(0.0, 1.0);
        let distance = (to - within * side).length().copysign(to.perp_dot(side));
        let outline = -distance - ROUNDING;
        let facet = if folded.x < 0.0 { 1.0 } else { 0.42 };
        pixel.fill(outline, facet + 0.1 * (1.0 - pixel.at.length() / OUTER));
        pixel.line(outline + 0.008, 0.016, 1.0);
    })
}

/// A spiral of three turns whose stroke swells from the middle outwards.
pub(crate) fn spiral() -> GrayImage {
    const TURNS: f64 = 3.0;
    const STEPS: usize = 480;
    let point = |k: usize| {
        let t = k as f64 / STEPS as f64;
        let angle = TAU * TURNS * t;
        let radius = 0.04 + 0.8 * t;
        // A quarter turn back and a little to the left: the figure fills its square evenly.
        (radius * libm::sin(angle) - 0.04, -radius * libm::cos(angle) + 0.05)
    };
    let points: Vec<_> = (0..=STEPS).map(point).collect();
    let stroke = Stroke::along(&points);
    draw(SIZE, |pixel| {
        let nearest = stroke.nearest(pixel.at);
        pixel.fill(nearest.distance - 0.012 - 0.045 * nearest.along, 1.0);
    })
}
