//! Synthetic turbulence (Sec. 3, "Synthetic Turbulence"): random swirls added to the field.
//!
//! The velocity is the co-gradient of a random stream function, as in Bridson et al. 2007, but of a cubic spline in place
//! of Perlin noise: divergence-free at every point. Each noise grid gives the swirls of one size, about two cells wide;
//! by Kolmogorov's law, or any slope asked for, smaller ones are slower.
//!
//! In time, key noises follow each other `rate` times from key frame to key frame. Two neighbours a, b are blended as
//! cos(w) a + sin(w) b. Both have unit root mean square velocity over the plane and are orthogonal, so that every blend has
//! it too: the strength does not pulse within a segment, in which it grows from nothing and dies before the target forms. w rises smoothly from 0 to a right angle, and nothing jumps at a key.
//!
//! The noise is part of u: it carries guide photons and those of all passes alike. The fit does not
//! contain it, but sees where it has carried the photons. Time goes on from segment to segment.
//!
//! # The unit and its look
//!
//! Strength 20 is a root mean square speed of 0.2 of the plane's longer side from key to key: of the plane and not of the
//! photons' paths, so that one strength gives one size of swirls whether the target is near or far. Letter C to letter
//! S (mean distance 0.08, 64 x 64 cells, rate 1 and 4): at 20 on 30 x 30 cells the stroke winds into hooks and curls of its own
//! width and is wholly stirred at half the time; on 100 x 100 its edge frays into fine hair and its body to grain. 5 ruffles
//! the edge, 50 leaves nothing of the letter until the fade. At rate 1 photons stay with their swirl, which draws
//! threads like ink; at 4 they change from one to the next, which scatters them.

mod noise;
mod settings;
mod stored;

use std::f64::consts::FRAC_PI_2;

use glam::Vec2;

pub use settings::TurbulenceSettings;

use self::noise::{NoiseMaker, fields};
use super::field::Field;
use crate::math::smoothstep::smoothstep;

/// Times at which the turbulence has grown to full strength, begins to fade, and is gone: the target's outline forms
/// undisturbed.
const GROWN: f64 = 0.15;
const FADES: f64 = 0.4;
const GONE: f64 = 0.8;

/// The strength at time `t`, 0 to 1.
fn envelope(t: f64) -> f64 {
    smoothstep(t / GROWN) * (1.0 - smoothstep((t - FADES) / (GONE - FADES)))
}

/// The turbulence of one segment.
#[derive(serde::Deserialize, serde::Serialize)]
pub struct Turbulence {
    /// Key noises in order, of each one field per grid.
    keys: Vec<Vec<Field>>,
    /// Number of the first of them.
    first: u64,
    /// Key noises per unit of t.
    rate: f64,
    /// The segment, from 0.
    number: usize,
    speed: f32,
}

impl Turbulence {
    /// The turbulence of segment `number` on a plane of this extent; none where its strength is 0.
    pub fn new(settings: &TurbulenceSettings, extent: Vec2, number: usize) -> Option<Self> {
        if !settings.is_on() {
            return None;
        }
        let mut turbulence =
            Self { keys: Vec::new(), first: 0, rate: settings.rate.into(), number, speed: settings.speed() };
        let [first, last] = [0.0, 1.0].map(|t| turbulence.place(t).0);
        turbulence.first = first;
        let maker = NoiseMaker::new(settings, extent);
        let keys = maker.keys(first, last + 1);
        turbulence.keys =
            keys.iter().map(|key| fields(maker.grids(), key, turbulence.speed.into())).collect();
        Some(turbulence)
    }

    /// The noise at time `t`, 0 to 1, of the segment: fields whose velocities add up.
    pub fn at(&self, t: f64) -> Vec<Field> {
        let (key, between) = self.place(t.clamp(0.0, 1.0));
        let index = (key - self.first) as usize;
        let angle = FRAC_PI_2 * smoothstep(between);
        let strength = envelope(t);
        let (a, b) = ((strength * angle.cos()) as f32, (strength * angle.sin()) as f32);
        let pairs = self.keys[index].iter().zip(&self.keys[index + 1]);
        pairs
            .map(|(before, after)| {
                let mut field = before.clone();
                Field::blend(before, a, after, b, &mut field);
                field
            })
            .collect()
    }

    /// Root mean square speed over the plane at full strength, in plane units per unit of t.
    pub fn speed(&self) -> f32 {
        self.speed
    }

    /// Number of the key noise before time `t`, and the place 0 to 1 between it and the next.
    fn place(&self, t: f64) -> (u64, f64) {
        let time = (self.number as f64 + t) * self.rate;
        (time as u64, time.fract())
    }
}
