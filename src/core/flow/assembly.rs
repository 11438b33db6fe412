//! The normal equations of velocities wanted at points, Terms (3) and (6).
//!
//! With g the gradients of the basis functions at a point, both potentials see S = sum of g_x g_x^T + g_y g_y^T, and
//! they see each other by C = sum of g_x g_y^T - g_y g_x^T. Points are sorted by cell; those of a cell are summed into
//! one element matrix, which is then added to the stencils.

use glam::Vec2;
use rayon::prelude::*;

use super::bending::bending;
use super::field::Grid;
use crate::math::bspline::{slopes, values};
use crate::math::operator::{Parts, Tilt};
use crate::math::stencil::{OFFSETS, Stencil, offset, offset_index};
use crate::math::vector::{GridVector, HALO, Layout};

/// Velocities wanted at points, each with the same weight: the term weight/2 sum |u(p) - v|^2.
#[derive(Clone, Copy)]
pub struct Rows<'a> {
    /// Points on the plane; one beyond the rectangle counts at the nearest border point, as the field does.
    pub positions: &'a [Vec2],
    /// Velocity wanted at each.
    pub velocities: &'a [Vec2],
    /// 1/K for Term (3), beta/P for Term (6).
    pub weight: f64,
}

/// Walls that the field shall not cross: the term weight/2 sum (n.u(p))^2.
#[derive(Clone, Copy)]
pub struct WallRows<'a> {
    /// Points on the walls, plane units.
    pub positions: &'a [Vec2],
    /// Their normals, of length 1.
    pub normals: &'a [Vec2],
    /// Weight of each.
    pub weight: f64,
}

/// Sums of S, C and the right sides over rows.
pub struct Assembly {
    grid: Grid,
    /// S, C where it is wanted, and the bending B.
    pub parts: Parts,
    /// Right sides, psi and phi without their weights: sums of g_x v_y - g_y v_x and of g_x v_x + g_y v_y.
    pub right: GridVector<f64>,
    table: Vec<Entry>,
    sorted: Sorted,
}

/// A point in its cell: place 0..=1 along x and y, velocity.
type Point = [f32; 4];

#[derive(Default)]
struct Sorted {
    cells: Vec<u32>,
    points: Vec<Point>,
    /// First point of each cell, and the end of the last.
    starts: Vec<u32>,
}

/// Where a number of the element matrix belongs.
struct Entry {
    /// Row and column of the node in its cell, 0..4.
    row: usize,
    column: usize,
    offset: usize,
    /// Index in `direct`.
    direct: usize,
    /// Indices in `cross`, the second to be subtracted.
    cross: [usize; 2],
}

/// Sums over the points of a cell, products of one number along x and one along y.
struct Element {
    /// Pairs (i, k) along x with i <= k, all pairs (j, l) along y: x'_i x'_k y_j y_l + x_i x_k y'_j y'_l.
    direct: [[f64; 16]; 10],
    /// All pairs (i, k) along x, all (j, l) along y: x'_i x_k y_j y'_l. C is this minus its transpose.
    cross: [[f64; 16]; 16],
    right: [[[f64; 4]; 4]; 2],
}

impl Assembly {
    /// All sums zero; `coupled` when C is needed.
    pub fn new(grid: Grid, coupled: bool) -> Self {
        let layout = Layout::new(grid.nodes());
        Self {
            grid,
            parts: Parts {
                direct: Stencil::zero(layout),
                cross: coupled.then(|| Stencil::zero(layout)),
                smooth: bending(grid),
                tilt: None,
            },
            right: GridVector::zero(layout, 2),
            table: table(),
            sorted: Sorted::default(),
        }
    }

    /// All sums zero again.
    pub fn clear(&mut self) {
        self.parts.direct.clear();
        self.parts.cross.iter_mut().for_each(Stencil::clear);
        self.right.clear();
    }

    /// Adds the sums over `rows`, always in the same order.
    pub fn add(&mut self, rows: Rows) {
        self.sorted.sort(self.grid, rows);
        // Tasks own 16 node rows each and may take the cell rows that touch no other; the three cell rows between two
        // tasks come in a second round.
        self.add_round(0, rows.weight);
        self.add_round(PERIOD - 3, rows.weight);
    }

    /// Sets the part E and Y of walls, which stays until it is set anew. The other half of what walls add is that of
    /// [`Rows`] of half the weight at the same points, wanted velocity zero.
    pub fn set_tilt(&mut self, walls: Option<WallRows>) {
        self.parts.tilt = walls.map(|walls| {
            let layout = self.parts.direct.layout;
            let zero = || Stencil::zero(layout);
            let mut tilt = Tilt { direct: zero(), cross: self.parts.cross.as_ref().map(|_| zero()) };
            for (&position, &normal) in walls.positions.iter().zip(walls.normals) {
                self.add_tilt(&mut tilt, position, normal, walls.weight);
            }
            tilt
        });
    }

    /// With P = g_x g_x^T - g_y g_y^T, Q = g_x g_y^T + g_y g_x^T and the normal's double angle 2a:
    /// 2 E = cos 2a P + sin 2a Q and 2 Y = sin 2a P - cos 2a Q.
    fn add_tilt(&self, tilt: &mut Tilt, position: Vec2, normal: Vec2, weight: f64) {
        let (grid, layout) = (self.grid, tilt.direct.layout);
        let size = grid.cell_size();
        let [(column, x), (row, y)] = [0, 1].map(|axis| {
            let at = (f64::from(position[axis]) / size[axis]).clamp(0.0, grid.cells[axis] as f64);
            let cell = (at as usize).min(grid.cells[axis] - 1);
            (cell, at - cell as f64)
        });
        let (bx, by) = (values(x), values(y));
        let (dx, dy) = (slopes(x).map(|d| d / size[0]), slopes(y).map(|d| d / size[1]));
        let gradient = |row: usize, column: usize| [dx[column] * by[row], bx[column] * dy[row]];
        let (nx, ny) = (f64::from(normal.x), f64::from(normal.y));
        let (cos, sin) = (nx * nx - ny * ny, 2.0 * nx * ny);
        for entry in &self.table {
            let [gx, gy] = gradient(entry.row, entry.column);
            let (step_x, step_y) = offset(entry.offset);
            let [hx, hy] =
                gradient(entry.row.wrapping_add_signed(step_y), entry.column.wrapping_add_signed(step_x));
            let (p, q) = (gx * hx - gy * hy, gx * hy + gy * hx);
            let at =
                ((row + entry.row) * OFFSETS + entry.offset) * layout.stride + HALO + column + entry.column;
            tilt.direct.rows_mut()[at] += 0.5 * weight * (cos * p + sin * q);
            if let Some(cross) = &mut tilt.cross {
                cross.rows_mut()[at] += 0.5 * weight * (sin * p - cos * q);
            }
        }
    }

    fn add_round(&mut self, first: usize, weight: f64) {
        let (grid, sorted, table) = (self.grid, &self.sorted, &self.table);
        let layout = self.parts.direct.layout;
        if first >= layout.nodes[1] {
            return;
        }
        let (len, right_len) = (self.parts.direct.row_len(), self.right.row_len());
        let direct = self.parts.direct.rows_mut()[first * len..].par_chunks_mut(PERIOD * len);
        let right = self.right.rows_mut()[first * right_len..].par_chunks_mut(PERIOD * right_len);
        let taken = if first == 0 { PERIOD - 3 } else { 3 };
        let run = |task: usize, direct: &mut [f64], mut cross: Option<&mut [f64]>, right: &mut [f64]| {
            let start = first + task * PERIOD;
            for cell_row in start..(start + taken).min(grid.cells[1]) {
                let at = cell_row - start;
                let target = Target {
                    layout,
                    direct: &mut direct[at * len..],
                    cross: cross.as_deref_mut().map(|cross| &mut cross[at * len..]),
                    right: &mut right[at * right_len..],
                };
                sorted.add_cell_row(grid, cell_row, weight, table, target);
            }
        };
        match &mut self.parts.cross {
            None => direct.zip(right).enumerate().for_each(|(task, (d, r))| run(task, d, None, r)),
            Some(cross) => {
                let cross = cross.rows_mut()[first * len..].par_chunks_mut(PERIOD * len);
                direct.zip(cross).zip(right).enumerate().for_each(|(t, ((d, c), r))| run(t, d, Some(c), r));
            }
        }
    }
}

/// Node rows of a task.
const PERIOD: usize = 16;

/// Memory from the lowest node row of a cell row upwards.
struct Target<'a> {
    layout: Layout,
    direct: &'a mut [f64],
    cross: Option<&'a mut [f64]>,
    right: &'a mut [f64],
}

impl Sorted {
    /// Counting sort by cell.
    fn sort(&mut self, grid: Grid, rows: Rows) {
        let [width, height] = grid.cells;
        let per_plane = grid.cell_size().map(|size| (1.0 / size) as f32);
        let locate = |x: f32, cells: usize| {
            let x = x.clamp(0.0, cells as f32);
            let cell = (x as usize).min(cells - 1);
            (cell, x - cell as f32)
        };
        let place = |p: Vec2| (locate(p.x * per_plane[0], width), locate(p.y * per_plane[1], height));
        self.cells.clear();
        self.cells.par_extend(rows.positions.par_iter().map(|&p| {
            let ((column, _), (row, _)) = place(p);
            (row * width + column) as u32
        }));
        self.starts.clear();
        self.starts.resize(width * height + 1, 0);
        for &cell in &self.cells {
            self.starts[cell as usize + 1] += 1;
        }
        for i in 0..width * height {
            self.starts[i + 1] += self.starts[i];
        }
        self.points.resize(self.cells.len(), [0.0; 4]);
        // The start of each cell moves to its end, which is the start of the next.
        for ((&cell, &position), &velocity) in self.cells.iter().zip(rows.positions).zip(rows.velocities) {
            let ((_, x), (_, y)) = place(position);
            let slot = &mut self.starts[cell as usize];
            self.points[*slot as usize] = [x, y, velocity.x, velocity.y];
            *slot += 1;
        }
    }

    /// Points of a cell, after `sort`.
    fn points_of(&self, cell: usize) -> &[Point] {
        let start = if cell == 0 { 0 } else { self.starts[cell - 1] };
        &self.points[start as usize..self.starts[cell] as usize]
    }

    fn add_cell_row(&self, grid: Grid, row: usize, weight: f64, table: &[Entry], mut target: Target) {
        let scale = grid.cell_size().map(|size| 1.0 / size);
        let coupled = target.cross.is_some();
        let mut element = Element::zero();
        for column in 0..grid.cells[0] {
            let points = self.points_of(row * grid.cells[0] + column);
            if points.is_empty() {
                continue;
            }
            element.clear(coupled);
            for point in points {
                element.add(point, scale, coupled);
            }
            element.scatter(column, weight, table, &mut target);
        }
    }
}

impl Element {
    fn zero() -> Self {
        Self { direct: [[0.0; 16]; 10], cross: [[0.0; 16]; 16], right: [[[0.0; 4]; 4]; 2] }
    }

    fn clear(&mut self, coupled: bool) {
        self.direct = [[0.0; 16]; 10];
        self.right = [[[0.0; 4]; 4]; 2];
        if coupled {
            self.cross = [[0.0; 16]; 16];
        }
    }

    #[inline(always)]
    fn add(&mut self, &[x, y, vx, vy]: &Point, scale: [f64; 2], coupled: bool) {
        let (bx, by) = (values(f64::from(x)), values(f64::from(y)));
        let (dx, dy) =
            (slopes(f64::from(x)).map(|d| d * scale[0]), slopes(f64::from(y)).map(|d| d * scale[1]));
        let (by2, dy2) = (outer(by, by), outer(dy, dy));
        for (sum, (i, k)) in self.direct.iter_mut().zip(PAIRS) {
            let (b, d) = (bx[i] * bx[k], dx[i] * dx[k]);
            for q in 0..16 {
                sum[q] = d.mul_add(by2[q], b.mul_add(dy2[q], sum[q]));
            }
        }
        if coupled {
            let (xs, ys) = (outer(dx, bx), outer(by, dy));
            for (sum, x) in self.cross.iter_mut().zip(xs) {
                for q in 0..16 {
                    sum[q] = x.mul_add(ys[q], sum[q]);
                }
            }
        }
        let (vx, vy) = (f64::from(vx), f64::from(vy));
        for row in 0..4 {
            for i in 0..4 {
                let (gx, gy) = (dx[i] * by[row], bx[i] * dy[row]);
                self.right[0][row][i] += gx * vy - gy * vx;
                self.right[1][row][i] += gx * vx + gy * vy;
            }
        }
    }

    /// Adds the sums to the nodes of the cell in column `column`.
    fn scatter(&self, column: usize, weight: f64, table: &[Entry], target: &mut Target) {
        let stride = target.layout.stride;
        let first = HALO + column;
        let direct = self.direct.as_flattened();
        for entry in table {
            let at = (entry.row * OFFSETS + entry.offset) * stride + first + entry.column;
            target.direct[at] += weight * direct[entry.direct];
        }
        if let Some(out) = &mut target.cross {
            let cross = self.cross.as_flattened();
            for entry in table {
                let at = (entry.row * OFFSETS + entry.offset) * stride + first + entry.column;
                out[at] += weight * (cross[entry.cross[0]] - cross[entry.cross[1]]);
            }
        }
        for (component, right) in self.right.iter().enumerate() {
            for (row, right) in right.iter().enumerate() {
                let out = &mut target.right[(row * 2 + component) * stride + first..][..4];
                for (out, value) in out.iter_mut().zip(right) {
                    *out += weight * value;
                }
            }
        }
    }
}

/// a_i b_k for all i, k.
#[inline(always)]
fn outer(a: [f64; 4], b: [f64; 4]) -> [f64; 16] {
    let mut pairs = [0.0; 16];
    for (pairs, a) in pairs.chunks_exact_mut(4).zip(a) {
        for k in 0..4 {
            pairs[k] = a * b[k];
        }
    }
    pairs
}

/// Pairs i <= k in the order of `Element::direct`.
const PAIRS: [(usize, usize); 10] =
    [(0, 0), (0, 1), (0, 2), (0, 3), (1, 1), (1, 2), (1, 3), (2, 2), (2, 3), (3, 3)];

/// The stored half of an element matrix: all pairs of its 16 nodes whose offset is stored.
fn table() -> Vec<Entry> {
    let pair = |i: usize, k: usize| PAIRS.iter().position(|&p| p == (i.min(k), i.max(k))).unwrap_or(0);
    let nodes = || (0..4).flat_map(|row| (0..4).map(move |column| (row, column)));
    let mut table = Vec::new();
    for ((j, i), (l, k)) in nodes().flat_map(|a| nodes().map(move |b| (a, b))) {
        let (dx, dy) = (k as isize - i as isize, l as isize - j as isize);
        if dy < 0 || (dy == 0 && dx < 0) {
            continue;
        }
        let cross = [(4 * i + k) * 16 + 4 * j + l, (4 * k + i) * 16 + 4 * l + j];
        let direct = pair(i, k) * 16 + 4 * j + l;
        table.push(Entry { row: j, column: i, offset: offset_index(dx, dy), direct, cross });
    }
    table
}
