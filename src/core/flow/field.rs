//! The vector field u = J grad psi + grad phi of Eq. (1) in cubic B-splines.
//!
//! Both potentials are smooth functions, not samples: without phi the divergence of u is zero at every point, and
//! without psi the curl is.

use std::array::from_fn;

use glam::{Mat2, Vec2};
use wide::f32x8;

use crate::math::bspline::{self, EXTRA};

/// M x N cells over `[0, extent.x] x [0, extent.y]`: (M+3)(N+3) coefficients for each potential.
#[derive(Clone, Copy, PartialEq, Debug, serde::Deserialize, serde::Serialize)]
pub struct Grid {
    /// Cells along x and y, M and N.
    pub cells: [usize; 2],
    /// Size of the rectangle in plane units; its longer side is 1.
    pub extent: Vec2,
}

impl Grid {
    /// Coefficients along x and y, M + 3 and N + 3.
    pub fn nodes(&self) -> [usize; 2] {
        self.cells.map(|cells| cells + EXTRA)
    }

    /// Width and height of a cell in plane units.
    pub fn cell_size(&self) -> [f64; 2] {
        [f64::from(self.extent.x) / self.cells[0] as f64, f64::from(self.extent.y) / self.cells[1] as f64]
    }

    /// The rectangle's area |D|.
    pub fn area(&self) -> f64 {
        f64::from(self.extent.x) * f64::from(self.extent.y)
    }
}

/// One fitted field. Its potentials carry their weights: psi stands for (1-gamma) psi of Eq. (1), phi for gamma phi.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub struct Field {
    grid: Grid,
    per_plane: Vec2,
    /// psi and phi of a node side by side, node rows from y = 0 upwards.
    coefficients: Vec<f32>,
}

impl Field {
    /// The field that is zero everywhere.
    pub fn zero(grid: Grid) -> Self {
        let [nx, ny] = grid.nodes();
        let per_plane = Vec2::new(grid.cells[0] as f32, grid.cells[1] as f32) / grid.extent;
        Self { grid, per_plane, coefficients: vec![0.0; 2 * nx * ny] }
    }

    /// The field of weighted potentials given by their coefficients, (N+3) rows of M+3 from y = 0 upwards.
    ///
    /// # Panics
    /// When a slice has not (M+3)(N+3) values.
    pub fn from_potentials(grid: Grid, psi: &[f32], phi: &[f32]) -> Self {
        let mut field = Self::zero(grid);
        assert!(2 * psi.len() == field.coefficients.len() && psi.len() == phi.len(), "one value per node");
        for (node, (&psi, &phi)) in field.coefficients.chunks_exact_mut(2).zip(psi.iter().zip(phi)) {
            node.copy_from_slice(&[psi, phi]);
        }
        field
    }

    /// The grid.
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Coefficients of the weighted psi and phi, each (N+3) rows of M+3 from y = 0 upwards.
    pub fn potentials(&self) -> (Vec<f32>, Vec<f32>) {
        self.coefficients.chunks_exact(2).map(|node| (node[0], node[1])).unzip()
    }

    /// `out` = `wa` a + `wb` b.
    ///
    /// # Panics
    /// When the three grids differ.
    pub fn blend(a: &Field, wa: f32, b: &Field, wb: f32, out: &mut Field) {
        assert!(a.grid == b.grid && a.grid == out.grid, "fields of one grid");
        for ((out, a), b) in out.coefficients.iter_mut().zip(&a.coefficients).zip(&b.coefficients) {
            *out = wa * a + wb * b;
        }
    }

    /// The velocity at `p` in plane units per unit of t. Beyond the rectangle the velocity of the nearest border point.
    #[inline]
    pub fn velocity(&self, p: Vec2) -> Vec2 {
        let [velocity] = self.velocities([p]);
        velocity
    }

    /// As [`Self::velocity`] at N points, evaluated side by side.
    #[inline(always)]
    pub fn velocities<const N: usize>(&self, p: [Vec2; N]) -> [Vec2; N] {
        let (columns, fx) = locate(p.map(|p| p.x * self.per_plane.x), self.grid.cells[0]);
        let (rows, fy) = locate(p.map(|p| p.y * self.per_plane.y), self.grid.cells[1]);
        let (by, dy) = (fy.map(values), fy.map(slopes));
        from_fn(|j| self.weigh([columns[j], rows[j]], fx[j], by[j], dy[j]))
    }

    /// The velocity in a cell, from the place in it along x and the splines and their slopes along y.
    #[inline(always)]
    fn weigh(&self, [column, row]: [u32; 2], fx: f32, by: [f32; 4], dy: [f32; 4]) -> Vec2 {
        // Eight lanes: psi and phi of four nodes of a row.
        let (mut along, mut across) = (f32x8::ZERO, f32x8::ZERO);
        for k in 0..4 {
            let nodes = self.nodes_at(column as usize, row as usize + k);
            let Some(&nodes) = nodes.first_chunk() else { return Vec2::ZERO };
            let nodes = f32x8::new(nodes);
            along = nodes.mul_add(f32x8::splat(by[k]), along);
            across = nodes.mul_add(f32x8::splat(dy[k]), across);
        }
        let fx = f32x8::splat(fx);
        // [d psi/dx, d phi/dx] and [d psi/dy, d phi/dy].
        let [psi_x, phi_x] = pairs(SLOPES.at(fx) * along);
        let [psi_y, phi_y] = pairs(VALUES.at(fx) * across);
        let s = self.per_plane;
        Vec2::new(phi_x * s.x - psi_y * s.y, psi_x * s.x + phi_y * s.y)
    }

    /// The Jacobian of the velocity at `p`, columns du/dx and du/dy: divergence x_axis.x + y_axis.y, curl
    /// x_axis.y - y_axis.x. Beyond the rectangle nothing changes along the outward direction.
    pub fn gradient(&self, p: Vec2) -> Mat2 {
        let ([column], [fx]) = locate([p.x * self.per_plane.x], self.grid.cells[0]);
        let ([row], [fy]) = locate([p.y * self.per_plane.y], self.grid.cells[1]);
        let (column, row) = (column as usize, row as usize);
        let (x, y) = ([values(fx), slopes(fx), curvatures(fx)], [values(fy), slopes(fy), curvatures(fy)]);
        // Second derivatives xx, xy, yy of psi and phi.
        let mut d = [[0.0f32; 2]; 3];
        for k in 0..4 {
            let c = self.nodes_at(column, row + k);
            for i in 0..8 {
                for (order, sum) in d.iter_mut().enumerate() {
                    sum[i % 2] += x[2 - order][i / 2] * y[order][k] * c[i];
                }
            }
        }
        let s = self.per_plane;
        let scale = [s.x * s.x, s.x * s.y, s.y * s.y];
        let [[psi_xx, phi_xx], [psi_xy, phi_xy], [psi_yy, phi_yy]] =
            [0, 1, 2].map(|k| d[k].map(|v| v * scale[k]));
        let inside = |v: f32, end: f32| if (0.0..=end).contains(&v) { 1.0 } else { 0.0 };
        Mat2::from_cols(
            Vec2::new(phi_xx - psi_xy, phi_xy + psi_xx) * inside(p.x, self.grid.extent.x),
            Vec2::new(phi_xy - psi_yy, phi_yy + psi_xy) * inside(p.y, self.grid.extent.y),
        )
    }

    /// The velocity in double precision, for sums that must not see rounding.
    pub fn velocity_f64(&self, p: [f64; 2]) -> [f64; 2] {
        let size = self.grid.cell_size();
        let place = [0, 1].map(|axis| {
            let x = (p[axis] / size[axis]).clamp(0.0, self.grid.cells[axis] as f64);
            let cell = (x as usize).min(self.grid.cells[axis] - 1);
            (cell, bspline::values(x - cell as f64), bspline::slopes(x - cell as f64))
        });
        let [(column, bx, dx), (row, by, dy)] = place;
        let mut u = [0.0; 2];
        for k in 0..4 {
            let c = self.nodes_at(column, row + k);
            for i in 0..4 {
                let (gx, gy) = (dx[i] * by[k] / size[0], bx[i] * dy[k] / size[1]);
                let (psi, phi) = (f64::from(c[2 * i]), f64::from(c[2 * i + 1]));
                u[0] += gx * phi - gy * psi;
                u[1] += gx * psi + gy * phi;
            }
        }
        u
    }

    /// Coefficients of four neighbouring nodes of a row.
    #[inline(always)]
    fn nodes_at(&self, column: usize, row: usize) -> &[f32] {
        let start = 2 * (row * (self.grid.cells[0] + EXTRA) + column);
        &self.coefficients[start..start + 8]
    }
}

/// The cells of grid coordinates and the positions 0..=1 within them; clipped to the border.
#[inline(always)]
fn locate<const N: usize>(x: [f32; N], cells: usize) -> ([u32; N], [f32; N]) {
    let x = x.map(|x| x.max(0.0).min(cells as f32));
    // Whole numbers below 2^24, so that the place in the last cell is exact, too.
    let cell = x.map(|x| (x as i32).min(cells as i32 - 1));
    (cell.map(|cell| cell as u32), from_fn(|i| x[i] - cell[i] as f32))
}

#[inline(always)]
fn values(f: f32) -> [f32; 4] {
    let g = 1.0 - f;
    let f2 = f * f;
    [
        g * g * g * SIXTH,
        (0.5 * f - 1.0).mul_add(f2, 4.0 * SIXTH),
        (0.5 * g - 1.0).mul_add(g * g, 4.0 * SIXTH),
        f2 * f * SIXTH,
    ]
}

#[inline(always)]
fn slopes(f: f32) -> [f32; 4] {
    let g = 1.0 - f;
    [-0.5 * g * g, f * 1.5f32.mul_add(f, -2.0), -g * 1.5f32.mul_add(g, -2.0), 0.5 * f * f]
}

/// The four functions as polynomials in the place within the cell, each in two lanes.
struct Lanes<const N: usize>([[f32; 8]; N]);

/// [`values`], from the highest power down.
const VALUES: Lanes<4> = Lanes([
    [-SIXTH, -SIXTH, 0.5, 0.5, -0.5, -0.5, SIXTH, SIXTH],
    [0.5, 0.5, -1.0, -1.0, 0.5, 0.5, 0.0, 0.0],
    [-0.5, -0.5, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0],
    [SIXTH, SIXTH, 4.0 * SIXTH, 4.0 * SIXTH, SIXTH, SIXTH, 0.0, 0.0],
]);
/// [`slopes`], from the highest power down.
const SLOPES: Lanes<3> = Lanes([
    [-0.5, -0.5, 1.5, 1.5, -1.5, -1.5, 0.5, 0.5],
    [1.0, 1.0, -2.0, -2.0, 1.0, 1.0, 0.0, 0.0],
    [-0.5, -0.5, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0],
]);
const SIXTH: f32 = 1.0 / 6.0;

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn at(&self, f: f32x8) -> f32x8 {
        let highest = f32x8::new(self.0[0]);
        self.0[1..].iter().fold(highest, |sum, &lower| sum.mul_add(f, f32x8::new(lower)))
    }
}

/// Sums of the even and of the odd lanes.
#[inline(always)]
fn pairs(lanes: f32x8) -> [f32; 2] {
    let [a, b, c, d, e, f, g, h] = lanes.to_array();
    [(a + e) + (c + g), (b + f) + (d + h)]
}

#[inline(always)]
fn curvatures(f: f32) -> [f32; 4] {
    [1.0 - f, 3.0 * f - 2.0, 1.0 - 3.0 * f, f]
}
