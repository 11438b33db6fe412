//! The optimal transport map between two densities.

use glam::{DVec2, Vec2};
use rayon::prelude::*;

use super::back_and_forth;
use super::lattice::Lattice;
use super::push_forward::corner_map;
use super::settings::MapSettings;
use crate::{Error, Progress, Result};

/// Limits of the cells along the longer side.
const FINEST: usize = 256;
const COARSEST: usize = 32;
/// Points per cell that a lattice of fewer cells aims at.
const POINTS_PER_CELL: f64 = 4.0;
/// Share of uniform density mixed into both: without it the iteration stalls where one of them is empty. At 1 M points
/// 0.01 costs 0.37 % over the dual bound, 0.002 0.21 %, 0.0005 0.17 %, for the same time.
const FLOOR: f64 = 0.001;

/// The optimal (Brenier) map between two densities.
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
pub struct TransportMap {
    lattice: Lattice,
    /// T at the corners of the cells, cell units.
    corners: Vec<DVec2>,
    /// The target's dual potential at the cells' centres, for |x - y|^2 / 2 in cell units.
    phi: Vec<f64>,
}

/// The map from the density of `source` to that of `target` (plane coordinates; any two counts).
///
/// `extent` is the rectangle's size; points may lie outside it. Deterministic.
///
/// # Errors
/// `Value` when a set is empty or holds a point that is not finite; `Cancelled`.
pub fn transport_map(
    source: &[Vec2],
    target: &[Vec2],
    extent: Vec2,
    progress: &Progress,
) -> Result<TransportMap> {
    transport_map_with(source, target, extent, &MapSettings::default(), progress)
}

/// As [`transport_map`], with these settings.
///
/// # Errors
/// As [`transport_map`].
pub fn transport_map_with(
    source: &[Vec2],
    target: &[Vec2],
    extent: Vec2,
    settings: &MapSettings,
    progress: &Progress,
) -> Result<TransportMap> {
    require_points("source", source)?;
    require_points("target", target)?;
    let finest = match settings.cells {
        Some(cells) => cells.max(1).next_multiple_of(16),
        None => {
            let points = source.len().min(target.len()) as f64;
            ((points / POINTS_PER_CELL).sqrt() as usize).next_multiple_of(16).clamp(COARSEST, FINEST)
        }
    };
    let lattice = Lattice::covering(source, target, extent, finest);
    progress.begin("transport map", back_and_forth::work(&lattice));
    let mu = lattice.density(source, FLOOR, progress)?;
    let nu = lattice.density(target, FLOOR, progress)?;
    let potentials = back_and_forth::solve(&lattice, &mu, &nu, settings, progress)?;
    Ok(TransportMap { lattice, corners: corner_map(&lattice, &potentials.psi), phi: potentials.phi })
}

impl TransportMap {
    /// The image of `point`; a point outside the lattice has that of the nearest one inside.
    pub fn apply(&self, point: Vec2) -> Vec2 {
        let lattice = &self.lattice;
        let p = lattice.cells_from_plane(point);
        let [width, height] = lattice.size;
        let (column, row) = ((p.x as usize).min(width - 1), (p.y as usize).min(height - 1));
        let (u, v) = (p.x - column as f64, p.y - row as f64);
        let corner = row * (width + 1) + column;
        let below = self.corners[corner].lerp(self.corners[corner + 1], u);
        let above = self.corners[corner + width + 1].lerp(self.corners[corner + width + 2], u);
        (lattice.origin + below.lerp(above, v) * lattice.cell).as_vec2()
    }

    /// [`Self::apply`] for a whole column.
    pub fn apply_all(&self, points: &[Vec2]) -> Vec<Vec2> {
        points.par_iter().with_min_len(4096).map(|point| self.apply(*point)).collect()
    }

    /// The target's dual potential at `point`, for the cost |x - y|^2 in plane units.
    pub(super) fn target_potential(&self, point: Vec2) -> f64 {
        self.potential_at(self.lattice.cells_from_plane(point))
    }

    /// Its central differences over about `reach` (at least a cell) to each side.
    pub(super) fn target_potential_slope(&self, point: DVec2, reach: f64) -> DVec2 {
        let step = (reach / self.lattice.cell).max(1.0);
        let at = (point - self.lattice.origin) / self.lattice.cell;
        let difference = |step: DVec2| self.potential_at(at + step) - self.potential_at(at - step);
        DVec2::new(difference(DVec2::X * step), difference(DVec2::Y * step))
            / (2.0 * step * self.lattice.cell)
    }

    fn potential_at(&self, cells: DVec2) -> f64 {
        2.0 * self.lattice.cell * self.lattice.cell * self.lattice.smooth(&self.phi, cells)
    }
}

pub(super) fn require_points(name: &str, points: &[Vec2]) -> Result<()> {
    if points.is_empty() {
        return Err(Error::value(format!("matching.{name}"), "there are no points to match"));
    }
    match points.iter().position(|point| !point.is_finite()) {
        Some(i) => Err(Error::value(format!("matching.{name}"), format!("point {i} is not finite"))),
        None => Ok(()),
    }
}
