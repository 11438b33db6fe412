//! The optimal transport potentials between two densities, by the back-and-forth method.
//!
//! Jacobs and Leger, *A fast approach to optimal transport: the back-and-forth method*, Numer. Math. 2020
//! (arXiv 1905.12154): ascend the dual in the potential of the target, then in that of the source, each in the
//! H^1 metric, with a c-transform after each. Here started from coarser lattices.

use super::lattice::Lattice;
use super::legendre::c_transform;
use super::poisson::Poisson;
use super::push_forward::push_forward;
use super::settings::MapSettings;
use crate::{Progress, Result};

/// The coarsest lattice still has this many cells along its shorter side.
const COARSEST: usize = 8;

/// A dual pair: phi(y) + psi(x) <= |x - y|^2 / 2, cell units.
pub(super) struct Potentials {
    /// Of the source: T(x) = x - grad psi(x).
    pub(super) psi: Vec<f64>,
    /// Of the target.
    pub(super) phi: Vec<f64>,
}

/// The potentials between the densities `mu` of the source and `nu` of the target, both positive and of mean 1.
pub(super) fn solve(
    lattice: &Lattice,
    mu: &[f64],
    nu: &[f64],
    settings: &MapSettings,
    progress: &Progress,
) -> Result<Potentials> {
    let (start, iterations) = if let Some(coarser) = coarser(lattice) {
        let coarse = solve(&coarser, &lattice.restrict(mu), &lattice.restrict(nu), settings, progress)?;
        (lattice.prolong(&coarse.phi), settings.iterations)
    } else {
        (vec![0.0; lattice.len()], 2 * settings.iterations)
    };
    let potentials = Ascent::new(lattice, mu, nu, start).run(iterations, settings.tolerance, progress)?;
    progress.advance(lattice.len() as u64);
    Ok(potentials)
}

/// The progress units of [`solve`]: the cells of all its lattices.
pub(super) fn work(lattice: &Lattice) -> u64 {
    lattice.len() as u64 + coarser(lattice).map_or(0, |coarser| work(&coarser))
}

fn coarser(lattice: &Lattice) -> Option<Lattice> {
    lattice.size.iter().all(|n| n % 2 == 0 && n / 2 >= COARSEST).then(|| lattice.coarser())
}

struct Ascent<'a> {
    lattice: &'a Lattice,
    mu: &'a [f64],
    nu: &'a [f64],
    poisson: Poisson,
    potentials: Potentials,
    /// Step length.
    sigma: f64,
    /// Dual value of the potentials.
    value: f64,
}

impl<'a> Ascent<'a> {
    fn new(lattice: &'a Lattice, mu: &'a [f64], nu: &'a [f64], phi: Vec<f64>) -> Self {
        let psi = c_transform(lattice, &phi);
        let phi = c_transform(lattice, &psi);
        let densest = mu.iter().chain(nu).fold(1.0, |a: f64, b| a.max(*b));
        let value = dual_value(&psi, mu) + dual_value(&phi, nu);
        let potentials = Potentials { psi, phi };
        Self { lattice, mu, nu, poisson: Poisson::new(lattice), potentials, sigma: 4.0 / densest, value }
    }

    fn run(mut self, iterations: usize, tolerance: f64, progress: &Progress) -> Result<Potentials> {
        for _ in 0..iterations {
            progress.check()?;
            let before = self.value;
            // Forth: phi rises where the pushed source is short of the target.
            let Potentials { psi, phi } = self.potentials;
            let (phi, psi, value) = half_step(
                self.lattice,
                &self.poisson,
                (self.mu, &psi),
                (self.nu, phi),
                &mut self.sigma,
                self.value,
            );
            // And back: psi rises where the pulled target is short of the source.
            let (psi, phi, value) = half_step(
                self.lattice,
                &self.poisson,
                (self.nu, &phi),
                (self.mu, psi),
                &mut self.sigma,
                value,
            );
            self.potentials = Potentials { psi, phi };
            self.value = value;
            if (self.value - before).abs() <= tolerance * self.value.abs() {
                break;
            }
        }
        Ok(self.potentials)
    }
}

/// One ascent in the potential of `to`, then both made c-concave: returns (to, from, dual value).
fn half_step(
    lattice: &Lattice,
    poisson: &Poisson,
    from: (&[f64], &[f64]),
    to: (&[f64], Vec<f64>),
    sigma: &mut f64,
    value: f64,
) -> (Vec<f64>, Vec<f64>, f64) {
    let mut rest = push_forward(lattice, from.0, from.1);
    rest.iter_mut().zip(to.0).for_each(|(pushed, wanted)| *pushed = wanted - *pushed);
    let (direction, norm) = poisson.solve(&rest);
    let mut potential = to.1;
    potential.iter_mut().zip(&direction).for_each(|(p, d)| *p += *sigma * d);
    let other = c_transform(lattice, &potential);
    let potential = c_transform(lattice, &other);
    let risen = dual_value(&potential, to.0) + dual_value(&other, from.0);
    // Armijo and Goldstein: the promised rise is sigma |gradient|^2.
    let promised = *sigma * norm;
    let factor = if risen - value < 0.25 * promised {
        0.8
    } else if risen - value > 0.75 * promised {
        1.25
    } else {
        1.0
    };
    *sigma *= factor;
    (potential, other, risen)
}

fn dual_value(potential: &[f64], density: &[f64]) -> f64 {
    potential.iter().zip(density).map(|(p, d)| p * d).sum()
}
