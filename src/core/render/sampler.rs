//! Low-discrepancy sample points: the Sobol sequence in pairs of dimensions, shuffled and scrambled by hashing (Burley 2020,
//! *Practical hash-based Owen scrambling*, JCGT 9(4)). Any first 2^k points of a pair are stratified in every
//! elementary way, so noise falls faster than with independent numbers.

use glam::Vec2;

/// Sample points of one pixel.
#[derive(Clone, Copy, Debug, serde::Deserialize, serde::Serialize)]
pub(super) struct Sampler {
    seed: u32,
}

impl Sampler {
    /// The points of a random `seed`, such as one per pixel.
    pub(super) fn new(seed: u32) -> Self {
        Self { seed }
    }

    /// Sample `index` of dimension pair `pair`, in [0, 1)^2. Pairs are independent of each other.
    pub(super) fn pair(self, index: u32, pair: u32) -> [f32; 2] {
        let seed = hash(self.seed ^ hash(pair));
        let index = scramble(index, seed);
        [
            unit(scramble(index.reverse_bits(), hash(seed ^ 1))),
            unit(scramble(second_sobol(index), hash(seed ^ 2))),
        ]
    }
}

/// The second dimension of the Sobol sequence; the first is the reversed index.
fn second_sobol(mut index: u32) -> u32 {
    let (mut direction, mut x) = (1_u32 << 31, 0);
    while index != 0 {
        if index & 1 == 1 {
            x ^= direction;
        }
        index >>= 1;
        direction ^= direction >> 1;
    }
    x
}

/// Owen scrambling: every bit is flipped or not depending on all higher bits.
fn scramble(x: u32, seed: u32) -> u32 {
    let mut x = x.reverse_bits();
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

/// A 32-bit finalizer (Wellons 2018, *hash prospector*, lowbias32).
fn hash(mut x: u32) -> u32 {
    x = (x ^ (x >> 16)).wrapping_mul(0x21f0_aaad);
    x = (x ^ (x >> 15)).wrapping_mul(0xd35a_2d97);
    x ^ (x >> 15)
}

fn unit(x: u32) -> f32 {
    (x >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// An offset from the pixel centre, in pixels, sampled in proportion to the reconstruction filter: a tent of radius one
/// pixel (Ernst, Stamminger and Greiner 2006, *Filter importance sampling*).
pub(super) fn tent(u: [f32; 2]) -> Vec2 {
    let warp = |u: f32| if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() };
    Vec2::new(warp(u[0]), warp(u[1]))
}
