//! Photons of equal flux, as many as asked for, out of all that landed.
//!
//! Matching, fit and continuity take each photon for the same share of the light. Paths that were hard to find land with more
//! flux than others; so photons are drawn by flux and not by number, evenly spaced along the order in which they were
//! emitted (systematic resampling). A photon of twice the mean flux stands for two of them at its place, one of less is
//! kept with that probability, and its neighbours in the beam make up for it.

use super::Photons;

/// Strided rounds of the output order, a power of 2.
const ROUNDS: u64 = 256;

/// `count` photons of equal flux from `landed`, each in proportion to its flux, of which they keep the sum times `factor`.
/// `offset` within 0..1 is where the even spacing starts. Their order is by strided rounds, so that the first n are an even
/// sample too.
pub(super) fn equal_flux(landed: &[Photons], count: usize, offset: f64, factor: f64) -> Photons {
    let weights =
        || landed.iter().flat_map(|photons| &photons.flux).map(|flux| f64::from(flux.element_sum()));
    let total: f64 = weights().sum();
    let flux = (total * factor / count as f64) as f32;
    let mut drawn = Photons::with_capacity(count);
    let mut sum = 0.0;
    for photons in landed {
        for i in 0..photons.len() {
            let weight = photons.flux[i].element_sum();
            sum += f64::from(weight);
            // The last sum is the total to the bit, so exactly `count` are drawn.
            let below = ((sum / total * count as f64 + offset) as usize).min(count);
            for _ in drawn.len()..below {
                let flux = photons.flux[i] * (flux / weight);
                drawn.push(photons.positions[i], flux, photons.light[i], photons.mesh[i]);
            }
        }
    }
    let order = || {
        let rounds = (0..ROUNDS).map(|round| round.reverse_bits() >> (u64::BITS - ROUNDS.trailing_zeros()));
        rounds.flat_map(|start| (start as usize..drawn.len()).step_by(ROUNDS as usize))
    };
    Photons {
        positions: order().map(|i| drawn.positions[i]).collect(),
        flux: order().map(|i| drawn.flux[i]).collect(),
        light: order().map(|i| drawn.light[i]).collect(),
        mesh: order().map(|i| drawn.mesh[i]).collect(),
    }
}
