//! The blocks of the normal matrix of Eq. (7), each potential's part apart, before they are weighted.

use super::kronecker::Kronecker;
use super::stencil::Stencil;

/// The parts of the matrix of Eq. (7) over a grid. With A^T A standing for the weighted sum A^T A / K + beta/P D^T D:
///
/// ```text
/// A^T A = [ psi S, cross C; -cross C, phi S ]     B^T B = [ H, 0; 0, H ]
/// ```
///
/// S and H are symmetric, C is antisymmetric; psi, phi and cross are [`Weights`].
#[derive(Clone, Debug)]
pub struct NormalBlocks {
    /// S, the diagonal block of A^T A and D^T D.
    pub ata: Stencil<f64>,
    /// C, the off-diagonal block of A^T A and D^T D; where two potentials are coupled.
    pub ata_cross: Option<Stencil<f64>>,
    /// H, the diagonal block of B^T B: bending.
    pub btb: Kronecker,
    /// The walls' no-penetration term, beside its half in `ata`.
    pub no_penetration: Option<NoPenetration>,
}

/// The anisotropic half of N^T N, where rows of N ask for n.u = 0 along one direction n:
/// `N^T N = [ S - E, C + Y; -C + Y, S + E ]`, E and Y symmetric, S and C over the same points at half the weight.
#[derive(Clone, Debug)]
pub struct NoPenetration {
    /// E.
    pub diagonal: Stencil<f64>,
    /// Y, where two potentials are coupled.
    pub cross: Option<Stencil<f64>>,
}

/// The factors of the blocks.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Weights {
    /// Of `ata` for the first potential, or for the only one.
    pub psi: f64,
    /// Of `ata` for the second potential.
    pub phi: f64,
    /// Of `ata_cross`.
    pub cross: f64,
    /// Of `btb`.
    pub alpha: f64,
    /// Sign of E for the first potential, or for the only one: -1 for psi, 1 for phi.
    pub no_penetration: f64,
}

impl NormalBlocks {
    /// The weighted sum's entry between potential `i` of node (x, y) and potential `k` of the node at offset (dx, dy).
    pub fn entry(&self, weights: Weights, [i, k]: [usize; 2], at: [usize; 2], offset: [isize; 2]) -> f64 {
        let ([x, y], [dx, dy]) = (at, offset);
        let walls = self.no_penetration.as_ref();
        if i == k {
            let (weight, sign) = if i == 0 { (weights.psi, 1.0) } else { (weights.phi, -1.0) };
            let walls = walls.map_or(0.0, |walls| walls.diagonal.entry(x, y, dx, dy, 1.0));
            let data = self.ata.entry(x, y, dx, dy, 1.0) + sign * weights.no_penetration * walls;
            return weight * data + weights.alpha * self.btb.entry(at, offset);
        }
        let sign = if i == 0 { 1.0 } else { -1.0 };
        let antisymmetric = self.ata_cross.as_ref().map_or(0.0, |cross| cross.entry(x, y, dx, dy, -1.0));
        let symmetric = walls.and_then(|walls| walls.cross.as_ref());
        weights.cross * (sign * antisymmetric + symmetric.map_or(0.0, |cross| cross.entry(x, y, dx, dy, 1.0)))
    }

    /// The largest share of photons, lines and walls in a diagonal entry of node (x, y) over the bending in it.
    pub fn stiffness(&self, weights: Weights, components: usize, at: [usize; 2]) -> f64 {
        let bending = weights.alpha * self.btb.entry(at, [0, 0]);
        let over = |k: usize| self.entry(weights, [k, k], at, [0, 0]) / bending - 1.0;
        if bending > 0.0 { (0..components).map(over).fold(0.0, f64::max) } else { 0.0 }
    }

    /// The Galerkin blocks on a coarser grid; an axis whose number of `nodes` stays is left as it is.
    pub fn coarsened(&self, nodes: [usize; 2]) -> Self {
        Self {
            ata: self.ata.coarsened(nodes, 1.0),
            ata_cross: self.ata_cross.as_ref().map(|cross| cross.coarsened(nodes, -1.0)),
            btb: self.btb.coarsened(nodes),
            no_penetration: self.no_penetration.as_ref().map(|walls| NoPenetration {
                diagonal: walls.diagonal.coarsened(nodes, 1.0),
                cross: walls.cross.as_ref().map(|cross| cross.coarsened(nodes, 1.0)),
            }),
        }
    }
}
