//! The energy that a fit minimizes, evaluated.

use glam::Vec2;

use super::bending::bending;
use super::settings::FitSettings;
use crate::flow::field::Field;
use crate::math::vector::{GridVector, Layout};

/// The energy E of a field, Terms (3) to (5): `alpha` and `gamma` of the settings, points and velocities as in a fit.
/// A potential that the settings leave out must be zero; its bending is not counted.
pub fn energy(field: &Field, settings: &FitSettings, positions: &[Vec2], velocities: &[Vec2]) -> f64 {
    let misfit: f64 = (positions.iter().zip(velocities))
        .map(|(&p, &v)| {
            let [ux, uy] = field.velocity_f64([f64::from(p.x), f64::from(p.y)]);
            (ux - f64::from(v.x)).powi(2) + (uy - f64::from(v.y)).powi(2)
        })
        .sum();
    let (psi, phi) = field.potentials();
    let bends = bending(field.grid());
    let layout = Layout::new(field.grid().nodes());
    let bend = |coefficients: &[f32], weight: f64| {
        if weight == 0.0 {
            return 0.0;
        }
        let mut vector = GridVector::<f64>::zero(layout, 1);
        for (i, &value) in coefficients.iter().enumerate() {
            vector.set(0, i % layout.nodes[0], i / layout.nodes[0], f64::from(value));
        }
        // The potentials carry their weight w in u, so w times the bending of psi is 1/w times that of w psi.
        bends.quadratic_form(&vector, 0) / weight
    };
    let bent = bend(&psi, 1.0 - settings.gamma) + bend(&phi, settings.gamma);
    0.5 * misfit / positions.len().max(1) as f64 + 0.5 * settings.alpha * bent
}
