//! A flower as one would draw it with light: soft petals that brighten outwards, fine veins, bright outlines.

use glam::DVec2;
use image::GrayImage;

use crate::canvas::{Pixel, Stroke, distance, draw};

const SIZE: u32 = 1024;
/// Dark gap that sets a shape off from what lies behind it.
const GAP: f64 = 0.02;
const OUTLINE: f64 = 0.013;
const CENTRE: DVec2 = DVec2::new(0.07, 0.36);
/// The blossom is seen a little from below its face: turned by `LEAN` and foreshortened by `SQUASH`.
const LEAN: f64 = -0.3;
const SQUASH: f64 = 0.8;

/// The picture: leaves, stem, blossom, painted from back to front.
pub(crate) fn flower() -> GrayImage {
    let stem = Stroke::along(&[(0.05, 0.3), (-0.01, 0.1), (-0.1, -0.2), (-0.13, -0.55), (-0.07, -0.96)]);
    let leaves = [
        Stroke::along(&[(-0.115, -0.62), (-0.27, -0.5), (-0.5, -0.33), (-0.68, -0.1)]),
        Stroke::along(&[(-0.12, -0.42), (0.06, -0.28), (0.28, -0.26), (0.53, -0.12)]),
    ];
    let petals = petals();
    draw(SIZE, |pixel| {
        for leaf in &leaves {
            paint_leaf(pixel, leaf);
        }
        paint_stem(pixel, &stem);
        for petal in &petals {
            petal.paint(pixel);
        }
        paint_heart(pixel);
    })
}

/// One petal, in the plane of the blossom.
struct Petal {
    /// Direction from the heart, and length.
    axis: DVec2,
    length: f64,
    /// Half its greatest width over its length.
    width: f64,
    /// Multiplies its inner tones.
    light: f64,
}

/// Seven petals behind and, between them, seven smaller ones in front.
fn petals() -> Vec<Petal> {
    const COUNT: usize = 7;
    let ring = |start: f64, length: f64, width: f64, light: f64| {
        (0..COUNT).map(move |k| {
            // Neighbours differ a little, as grown things do.
            let sway = libm::sin(2.4 * k as f64 + 10.0 * start);
            let angle = start + std::f64::consts::TAU * k as f64 / COUNT as f64 + 0.05 * sway;
            let axis = DVec2::new(libm::cos(angle), libm::sin(angle));
            Petal { axis, length: length * (1.0 + 0.045 * sway), width, light }
        })
    };
    ring(0.2, 0.6, 0.36, 0.62).chain(ring(0.65, 0.45, 0.4, 1.0)).collect()
}

impl Petal {
    /// Coordinates along and across the petal: 0 to 1 from heart to tip, and -1 to 1 between its edges.
    fn local(&self, at: DVec2) -> DVec2 {
        let p = (at - CENTRE).rotate(DVec2::new(libm::cos(LEAN), -libm::sin(LEAN)));
        let p = DVec2::new(p.x, p.y / SQUASH) / self.length;
        let (t, s) = (self.axis.dot(p), self.axis.perp_dot(p) / self.width);
        // A shallow notch in the tip.
        DVec2::new(t + 0.06 * libm::exp(-16.0 * s * s), s)
    }

    /// Negative inside: narrow at the heart, broad in the outer half, blunt at the tip.
    fn outline(&self, at: DVec2) -> f64 {
        let q = self.local(at);
        let edge = q.y / libm::pow(q.x, 0.62);
        edge * edge + libm::pow(q.x, 5.0) - 1.0
    }

    fn paint(&self, pixel: &mut Pixel) {
        let q = self.local(pixel.at);
        // The foot of the petal, where its width vanishes, lies hidden under the heart; the rest is far away.
        if !(0.1..1.2).contains(&q.x) || q.y.abs() > 1.2 {
            return;
        }
        let edge = distance(|p| self.outline(p), pixel.at);
        if edge > 2.0 * GAP {
            return;
        }
        let across = q.y / libm::pow(q.x, 0.62);
        let soft = 0.05 + 0.52 * q.x * q.x + 0.09 * across;
        pixel.fill(edge - GAP, 0.0);
        pixel.fill(edge, self.light * soft);
        for vein in [-0.6, -0.3, 0.0, 0.3, 0.6_f64] {
            let reach = 0.86 - 0.25 * vein * vein;
            let fade = smooth((q.x - 0.16) / 0.2) * (1.0 - smooth((q.x - reach + 0.3) / 0.3));
            let away = distance(
                |p| {
                    let q = self.local(p);
                    q.y / libm::pow(q.x, 0.62) - vein
                },
                pixel.at,
            );
            pixel.line(away, 0.006, (self.light * (soft + 0.45)).min(0.95) * fade);
        }
        pixel.line(edge + OUTLINE / 2.0, OUTLINE, 0.66 + 0.34 * self.light);
    }
}

/// The heart: a disc of florets in the golden spiral.
fn paint_heart(pixel: &mut Pixel) {
    const RADIUS: f64 = 0.115;
    const FLORETS: usize = 64;
    const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
    let p = (pixel.at - CENTRE).rotate(DVec2::new(libm::cos(LEAN), -libm::sin(LEAN)));
    let p = DVec2::new(p.x, p.y / SQUASH);
    if p.length() > RADIUS + 2.0 * GAP {
        return;
    }
    pixel.fill(p.length() - RADIUS - GAP, 0.0);
    for k in 0..FLORETS {
        let angle = GOLDEN_ANGLE * k as f64;
        let radius = RADIUS * ((k as f64 + 0.5) / FLORETS as f64).sqrt();
        let floret = radius * DVec2::new(libm::cos(angle), libm::sin(angle));
        pixel.fill(p.distance(floret) - 0.0095, 0.55 + 0.45 * radius / RADIUS);
    }
}

/// The stem, brighter on its lit side, a little thicker below.
fn paint_stem(pixel: &mut Pixel, stem: &Stroke) {
    let nearest = stem.nearest(pixel.at);
    let half = 0.013 + 0.007 * nearest.along;
    pixel.fill(nearest.distance - half, 0.42 + 0.4 * nearest.side / half);
    pixel.line(nearest.side - half + 0.004, 0.008, 0.95 * pixel.coverage(nearest.distance - half));
}

/// A leaf around its midrib: pointed, with side veins that sweep forward.
fn paint_leaf(pixel: &mut Pixel, midrib: &Stroke) {
    const BREADTH: f64 = 0.24;
    /// Of both midribs, nearly.
    const LENGTH: f64 = 0.75;
    let n = midrib.nearest(pixel.at);
    if n.distance > BREADTH {
        return;
    }
    // The breadth changes so slowly that this is nearly the distance from the edge.
    let edge = n.distance - BREADTH * libm::pow(n.along, 0.75) * libm::pow(1.0 - n.along, 0.9) - 1e-3;
    pixel.fill(edge - GAP, 0.0);
    let shade = if n.side > 0.0 { 0.36 } else { 0.18 };
    pixel.fill(edge, shade * (0.5 + n.along));
    let inside = pixel.coverage(edge);
    // Nine lines that leave the midrib forwards, where `sweep` is a whole number; its gradient hardly changes over the leaf.
    let sweep = 10.0 * n.along - 7.5 * n.distance;
    let slope = DVec2::new(10.0 / LENGTH, 7.5).length();
    if (1.0..9.0).contains(&sweep.round()) {
        pixel.line((sweep - sweep.round()) / slope, 0.005, 0.6 * inside);
    }
    pixel.line(n.distance, 0.009, 0.85 * inside);
    pixel.line(edge + OUTLINE / 2.0, OUTLINE, 0.8);
}

/// Smooth step from 0 at 0 to 1 at 1.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
