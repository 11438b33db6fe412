//! The neighbours of photons in a key, and whether they are still together at another time.

use glam::{DMat2, DVec2, Vec2};
use rayon::prelude::*;
use rstar::RTree;
use rstar::primitives::GeomWithData;

/// Neighbours of a photon.
const COUNT: usize = 12;
/// Keeps the least squares of neighbours on one line, or in one place, solvable.
const REGULARISER: f64 = 1e-18;

/// A photon whose residual exceeds so many neighbour distances is torn.
pub const TORN: f64 = 2.0;

/// The nearest neighbours of some photons at one time.
pub struct Neighbourhoods {
    all: Vec<Neighbourhood>,
}

/// A photon with its neighbours.
struct Neighbourhood {
    /// Rows, its own first.
    members: Vec<u32>,
    /// Places of the members about their mean.
    centred: Vec<DVec2>,
    /// Inverse of the members' scatter matrix.
    inverse: DMat2,
    /// Distance of the farthest.
    distance: f64,
}

impl Neighbourhoods {
    /// Those of the photons in `rows`, among all photons at `positions`, which are finite.
    pub fn new(positions: &[Vec2], rows: &[usize]) -> Self {
        let entry = |(p, row): (&Vec2, u32)| GeomWithData::new(p.to_array(), row);
        let tree = RTree::bulk_load(positions.iter().zip(0..).map(entry).collect());
        let around = |&row: &usize| {
            let nearest = tree.nearest_neighbor_iter(positions[row].to_array()).take(COUNT + 1);
            Neighbourhood::new(positions, row, nearest.map(|entry| entry.data).collect())
        };
        Self { all: rows.par_iter().map(around).collect() }
    }

    /// How far the neighbours leave the one affine map that fits them best, when all photons are at `positions`: root mean
    /// square, in neighbour distances. By row that was asked for.
    pub fn residuals(&self, positions: &[Vec2]) -> Vec<f64> {
        self.all.par_iter().map(|neighbourhood| neighbourhood.residual(positions)).collect()
    }

    /// The share of the photons that are torn from their neighbours when all are at `positions`.
    pub fn torn(&self, positions: &[Vec2]) -> f64 {
        let torn = self.residuals(positions).into_iter().filter(|residual| *residual > TORN).count();
        torn as f64 / self.all.len().max(1) as f64
    }
}

impl Neighbourhood {
    fn new(positions: &[Vec2], row: usize, members: Vec<u32>) -> Self {
        let at = |row: &u32| positions[*row as usize];
        let distance = members.last().map_or(0.0, |last| at(last).as_dvec2().distance(positions[row].into()));
        let centred = centred(positions, &members);
        let scatter = centred.iter().fold(DMat2::IDENTITY * REGULARISER, |sum, p| sum + outer(*p, *p));
        Self { members, centred, inverse: scatter.inverse(), distance }
    }

    fn residual(&self, positions: &[Vec2]) -> f64 {
        let now = centred(positions, &self.members);
        let pairs = || self.centred.iter().zip(&now);
        let map = pairs().fold(DMat2::ZERO, |sum, (x, y)| sum + outer(*y, *x)) * self.inverse;
        let squares: f64 = pairs().map(|(x, y)| (*y - map * *x).length_squared()).sum();
        let residual = (squares / now.len() as f64).sqrt();
        // Neighbours that were in one place are together as long as they stay so.
        if residual > 0.0 { residual / self.distance } else { 0.0 }
    }
}

/// The places of some rows about their mean.
fn centred(positions: &[Vec2], rows: &[u32]) -> Vec<DVec2> {
    let at = |row: &u32| positions[*row as usize].as_dvec2();
    let mean = rows.iter().map(at).sum::<DVec2>() / rows.len() as f64;
    rows.iter().map(|row| at(row) - mean).collect()
}

/// The matrix a bᵀ.
fn outer(a: DVec2, b: DVec2) -> DMat2 {
    DMat2::from_cols(a * b.x, a * b.y)
}
