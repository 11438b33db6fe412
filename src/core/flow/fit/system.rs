//! The linear systems of a fit: weights and right side of Eq. (7).

use super::line_mask;
use super::settings::FitSettings;
use crate::math::normal_blocks::Weights;
use crate::math::null_space::NullSpace;
use crate::math::vector::{GridVector, Layout};

/// One linear system: psi' and phi' coupled, Eq. (7), or one of the two alone.
pub(super) struct System {
    pub(super) unknown: Unknown,
    pub(super) weights: Weights,
    pub(super) null: NullSpace,
    pub(super) null_vectors: Vec<GridVector<f64>>,
    pub(super) solution: GridVector<f64>,
    /// The solution with directed lines, and the blend of both.
    pub(super) with_lines: Option<[GridVector<f64>; 2]>,
}

/// The unknowns of a system.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Unknown {
    Both,
    Psi,
    Phi,
}

impl System {
    /// The weights of the blocks for these settings, and the null space of their sum.
    pub(super) fn new(settings: &FitSettings, unknown: Unknown) -> Self {
        let FitSettings { grid, gamma, alpha, .. } = *settings;
        let layout = Layout::new(grid.nodes());
        let (p, q) = ((1.0 - gamma).sqrt(), gamma.sqrt());
        let (weights, null) = if unknown == Unknown::Both {
            // u = p J grad psi' + q grad phi': psi' = q y has the velocity (-p q, 0), phi' = p x has (p q, 0).
            let linear = vec![[[0.0, 0.0, q], [0.0, p, 0.0]], [[0.0, q, 0.0], [0.0, 0.0, -p]]];
            let weights = Weights { psi: 1.0 - gamma, phi: gamma, cross: p * q, alpha, no_penetration: -1.0 };
            (weights, NullSpace::new(2, linear))
        } else {
            let no_penetration = if unknown == Unknown::Psi { -1.0 } else { 1.0 };
            let weights = Weights { psi: 1.0, phi: 0.0, cross: 0.0, alpha, no_penetration };
            (weights, NullSpace::new(1, Vec::new()))
        };
        let null_vectors = null.vectors(layout, grid.cell_size());
        let solution = GridVector::zero(layout, null.components());
        Self { unknown, weights, solution, with_lines: None, null, null_vectors }
    }

    /// The right side A^T a / K + beta/P D^T d, from its sums over the points for unit potentials.
    pub(super) fn set_right(
        &self,
        settings: &FitSettings,
        sums: &GridVector<f64>,
        right: &mut GridVector<f64>,
    ) {
        let weights = [(1.0 - settings.gamma).sqrt(), settings.gamma.sqrt()];
        let picked: &[(usize, f64)] = match self.unknown {
            Unknown::Both => &[(0, weights[0]), (1, weights[1])],
            Unknown::Psi => &[(0, 1.0)],
            Unknown::Phi => &[(1, 1.0)],
        };
        for (component, &(from, weight)) in picked.iter().enumerate() {
            right.set_component(component, weight, sums, from);
        }
    }

    /// The solution with directed lines; starts from the one without.
    pub(super) fn with_lines(&mut self) -> &mut GridVector<f64> {
        let [solution, _] =
            self.with_lines.get_or_insert_with(|| [self.solution.clone(), self.solution.clone()]);
        solution
    }

    /// Blends the solutions with and without directed lines by `mask`.
    pub(super) fn blend(&mut self, mask: &[f64]) {
        if let Some([with_lines, blended]) = &mut self.with_lines {
            line_mask::blend(&self.solution, with_lines, mask, &self.null_vectors, blended);
        }
    }
}
