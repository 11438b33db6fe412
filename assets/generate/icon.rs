//! The icon of the application: threads of light woven into a caustic.
//!
//! Chords from each point of a circle to the point at twice its angle envelope a cardioid, the caustic of a round cup.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use image::{Rgba, RgbaImage};

use crate::canvas::Pixel;

const SIZE: u32 = 256;
const THREADS: usize = 60;
const RADIUS: f64 = 0.84;

/// A rounded dark tile with the woven threads on it; transparent outside.
pub(crate) fn icon() -> RgbaImage {
    let threads: Vec<_> = (1..THREADS).map(thread).collect();
    RgbaImage::from_fn(SIZE, SIZE, |column, row| {
        let pixel = Pixel::new(SIZE, column, row);
        let night =
            DVec3::new(0.002, 0.002, 0.006).lerp(DVec3::new(0.008, 0.01, 0.032), 0.5 + 0.5 * pixel.at.y);
        let light = threads.iter().map(|t| t.glow(pixel.at)).sum::<DVec3>();
        let colour = (night + light).to_array().map(display);
        Rgba([colour[0], colour[1], colour[2], (255.0 * pixel.coverage(tile(pixel.at))).round() as u8])
    })
}

/// Signed distance from the outline of the tile.
fn tile(at: DVec2) -> f64 {
    const ROUNDING: f64 = 0.42;
    let beyond = at.abs() - DVec2::splat(1.0 - ROUNDING);
    beyond.max(DVec2::ZERO).length() + beyond.max_element().min(0.0) - ROUNDING
}

struct Thread {
    ends: [DVec2; 2],
    colour: DVec3,
}

fn thread(k: usize) -> Thread {
    let angle = TAU * k as f64 / THREADS as f64;
    // The cusp of the cardioid points up.
    let on_circle = |angle: f64| RADIUS * DVec2::new(libm::sin(angle), libm::cos(angle));
    let (gold, sea) = (DVec3::new(1.0, 0.55, 0.16), DVec3::new(0.1, 0.5, 0.75));
    let colour = gold.lerp(sea, 0.5 + 0.5 * libm::cos(angle));
    Thread { ends: [on_circle(angle), on_circle(2.0 * angle)], colour }
}

impl Thread {
    /// Light at a point: a fine core with a faint halo.
    fn glow(&self, at: DVec2) -> DVec3 {
        let side = self.ends[1] - self.ends[0];
        let within = ((at - self.ends[0]).dot(side) / side.length_squared().max(1e-12)).clamp(0.0, 1.0);
        let distance = at.distance(self.ends[0] + within * side);
        let core = libm::exp(-(distance / 0.0085) * (distance / 0.0085));
        let halo = 0.014 / (1.0 + (distance / 0.02) * (distance / 0.02));
        self.colour * (0.42 * core + halo)
    }
}

/// Linear light to an 8-bit display value: rolls off towards white, then the sRGB curve.
fn display(linear: f64) -> u8 {
    let x = 1.0 - libm::exp(-1.6 * linear);
    let curved = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * libm::pow(x, 1.0 / 2.4) - 0.055 };
    (255.0 * curved).round() as u8
}
