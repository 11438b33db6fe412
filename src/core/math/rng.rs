//! Random numbers from (seed, purpose, pass, index): photon `i` of pass `p` draws the same numbers whichever
//! thread traces it, in a preview, a full run or a resumed one.

use rand_pcg::Pcg32;
use rand_pcg::rand_core::{Rng as _, SeedableRng};

/// The purpose of a stream; streams of different purposes are independent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Purpose {
    /// Light paths.
    Trace = 1,
    /// Points drawn from a target picture.
    Target = 2,
    /// Choice of split directions in the matching.
    Match = 3,
    /// Camera paths of the background.
    Background = 4,
    /// Camera paths that look for the receiver.
    Visible = 5,
    /// Noises of the turbulence.
    Turbulence = 6,
}

/// A small, fast generator.
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
pub struct Stream(Pcg32);

impl Stream {
    /// The stream of `index` in `pass`.
    pub fn new(seed: u64, purpose: Purpose, pass: u64, index: u64) -> Self {
        let key = mix(mix(mix(seed ^ 0x9e37_79b9_7f4a_7c15) ^ purpose as u64) ^ pass) ^ index;
        Self(Pcg32::seed_from_u64(mix(key)))
    }

    /// Uniform in [0, 1) with 24 bits.
    pub fn f32(&mut self) -> f32 {
        (self.0.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0)
    }

    /// Uniform in [0, 1) with 53 bits.
    pub fn f64(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// Uniform 32 bits.
    pub fn u32(&mut self) -> u32 {
        self.0.next_u32()
    }
}

/// The finalizer of SplitMix64 (Steele, Lea, Flood 2014): every input bit reaches every output bit.
fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}
