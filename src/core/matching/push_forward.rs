//! The push-forward of a density by the map of a potential, T(x) = x - grad psi(x).

use glam::DVec2;
use rayon::prelude::*;

use super::lattice::Lattice;

/// Parts of the rows; fixed, so that sums do not depend on the number of threads.
const PARTS: usize = 8;

/// The map's values at the cells' corners, `(width + 1) x (height + 1)`, in cell units, inside the lattice.
///
/// Beyond the border the potential is mirrored: the border goes to the border.
pub(super) fn corner_map(lattice: &Lattice, potential: &[f64]) -> Vec<DVec2> {
    let [width, height] = lattice.size;
    let upper = DVec2::new(width as f64, height as f64);
    (0..(width + 1) * (height + 1))
        .into_par_iter()
        .with_min_len(4096)
        .map(|i| {
            let (x, y) = (i % (width + 1), i / (width + 1));
            let (left, right) = (x.saturating_sub(1), x.min(width - 1));
            let (below, above) = (y.saturating_sub(1) * width, y.min(height - 1) * width);
            let [sw, se, nw, ne] =
                [below + left, below + right, above + left, above + right].map(|cell| potential[cell]);
            let gradient = DVec2::new(se - sw + ne - nw, nw - sw + ne - se) / 2.0;
            (DVec2::new(x as f64, y as f64) - gradient).clamp(DVec2::ZERO, upper)
        })
        .collect()
}

/// The push-forward of `density`: each cell's mass is spread over the image of the cell.
pub(super) fn push_forward(lattice: &Lattice, density: &[f64], potential: &[f64]) -> Vec<f64> {
    let corners = corner_map(lattice, potential);
    let height = lattice.size[1];
    let rows = height.div_ceil(PARTS);
    let parts: Vec<Vec<f64>> = (0..PARTS)
        .into_par_iter()
        .map(|part| {
            let mut pushed = vec![0.0; lattice.len()];
            for row in part * rows..((part + 1) * rows).min(height) {
                push_row(lattice, row, density, &corners, &mut pushed);
            }
            pushed
        })
        .collect();
    let mut pushed = vec![0.0; lattice.len()];
    pushed.par_chunks_mut(4096).enumerate().for_each(|(chunk, sums)| {
        for part in &parts {
            sums.iter_mut().zip(&part[chunk * 4096..]).for_each(|(sum, value)| *sum += value);
        }
    });
    pushed
}

/// Each cell is cut into as many pieces as its image spans cells, each piece placed by bilinear interpolation.
fn push_row(lattice: &Lattice, row: usize, density: &[f64], corners: &[DVec2], pushed: &mut [f64]) {
    let width = lattice.size[0];
    for column in 0..width {
        let corner = row * (width + 1) + column;
        let [sw, se, nw, ne] =
            [corner, corner + 1, corner + width + 1, corner + width + 2].map(|c| corners[c]);
        let span = |a: DVec2, b: DVec2| (b - a).abs().max_element();
        let across = (span(sw, se).max(span(nw, ne)).ceil() as usize).max(1);
        let along = (span(sw, nw).max(span(se, ne)).ceil() as usize).max(1);
        let mass = density[row * width + column] / (across * along) as f64;
        for j in 0..along {
            let v = (j as f64 + 0.5) / along as f64;
            let (left, right) = (sw.lerp(nw, v), se.lerp(ne, v));
            for i in 0..across {
                lattice.deposit(left.lerp(right, (i as f64 + 0.5) / across as f64), mass, pushed);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mass_is_kept_and_no_potential_moves_nothing() {
        let lattice = Lattice { size: [32, 16], origin: DVec2::ZERO, cell: 1.0 };
        let density: Vec<f64> = (0..lattice.len()).map(|i| (i % 7) as f64).collect();
        assert_eq!(push_forward(&lattice, &density, &vec![0.0; lattice.len()]), density);
        let potential: Vec<f64> = (0..lattice.len()).map(|i| ((i * i) % 97) as f64).collect();
        let (before, after): (f64, f64) =
            (density.iter().sum(), push_forward(&lattice, &density, &potential).iter().sum());
        // 512 cells cut into at most 1e4 pieces each: rounding only.
        assert!((before - after).abs() < 1e-9 * before);
    }
}
