//! The fit by dense rows and a Cholesky factorisation, which share nothing with the core but the definition of the energy.

use glam::Vec2;
use lightloom_core::flow::fit::FitSettings;

/// An unknown with its factor, for each that a row sees.
type Row = Vec<(usize, f64)>;

/// Points at which the velocity is wanted, or only its share along a direction.
pub(crate) struct Points<'a> {
    pub(crate) positions: &'a [Vec2],
    pub(crate) velocities: &'a [Vec2],
    /// Directions n of rows n.u = 0 in place of velocities.
    pub(crate) normals: Option<&'a [Vec2]>,
    pub(crate) weight: f64,
}

impl<'a> Points<'a> {
    /// Photons, all together of weight 1.
    pub(crate) fn photons(positions: &'a [Vec2], velocities: &'a [Vec2]) -> Self {
        Self { positions, velocities, normals: None, weight: 1.0 / positions.len() as f64 }
    }
}

/// The cubic B-spline by de Boor's recursion, function `i` of an axis with cells of width 1.
fn basis(i: usize, x: f64, degree: usize, order: usize) -> f64 {
    fn spline(first: f64, x: f64, degree: usize) -> f64 {
        if degree == 0 {
            return if first <= x && x < first + 1.0 { 1.0 } else { 0.0 };
        }
        let n = degree as f64;
        ((x - first) * spline(first, x, degree - 1)
            + (first + n + 1.0 - x) * spline(first + 1.0, x, degree - 1))
            / n
    }
    fn derivative(first: f64, x: f64, degree: usize, order: usize) -> f64 {
        if order == 0 {
            return spline(first, x, degree);
        }
        derivative(first, x, degree - 1, order - 1) - derivative(first + 1.0, x, degree - 1, order - 1)
    }
    derivative(i as f64 - 3.0, x, degree, order)
}

/// The functions that do not vanish at a place, derived `order` times along x and y.
fn derivatives(settings: &FitSettings, [x, y]: [f64; 2], order: [usize; 2]) -> Row {
    let (grid, [hx, hy]) = (settings.grid, settings.grid.cell_size());
    let nx = grid.nodes()[0];
    let (x, y) = ((x / hx).min(grid.cells[0] as f64 - 1e-12), (y / hy).min(grid.cells[1] as f64 - 1e-12));
    let (column, row) = (x as usize, y as usize);
    let mut list = Vec::new();
    for (k, i) in (0..4).flat_map(|k| (0..4).map(move |i| (row + k, column + i))) {
        let [along_x, along_y] = [basis(i, x, 3, order[0]), basis(k, y, 3, order[1])];
        list.push((k * nx + i, along_x / hx.powi(order[0] as i32) * along_y / hy.powi(order[1] as i32)));
    }
    list
}

/// The rows of both components of the velocity at a point.
fn velocity_rows(settings: &FitSettings, p: Vec2) -> [Row; 2] {
    let (a, b) = ((1.0 - settings.gamma).sqrt(), settings.gamma.sqrt());
    let p = p.clamp(Vec2::ZERO, settings.grid.extent);
    let [nx, ny] = settings.grid.nodes();
    let [gx, gy] = [[1, 0], [0, 1]].map(|order| derivatives(settings, [p.x.into(), p.y.into()], order));
    let row = |psi: &[(usize, f64)], phi: &[(usize, f64)], sign: f64| {
        let psi = psi.iter().map(|&(i, g)| (i, sign * a * g));
        psi.chain(phi.iter().map(|&(i, g)| (nx * ny + i, b * g))).collect::<Row>()
    };
    [row(&gy, &gx, -1.0), row(&gx, &gy, 1.0)]
}

/// Rows of the least squares problem, weights included, with their right sides. The bending integrals by Gauss quadrature,
/// as rows too.
fn reference_rows(settings: &FitSettings, points: &[Points]) -> (Vec<Row>, Vec<f64>) {
    let grid = settings.grid;
    let ([nx, ny], [hx, hy]) = (grid.nodes(), grid.cell_size());
    let (mut rows, mut right) = (Vec::new(), Vec::new());
    let scaled = |row: &Row, by: f64| row.iter().map(|&(i, g)| (i, by * g)).collect::<Row>();
    for points in points {
        let scale = points.weight.sqrt();
        for (i, &p) in points.positions.iter().enumerate() {
            let [x, y] = velocity_rows(settings, p);
            if let Some(normals) = points.normals {
                let n = normals[i].as_dvec2();
                rows.push([scaled(&x, scale * n.x), scaled(&y, scale * n.y)].concat());
                right.push(0.0);
            } else {
                let v = points.velocities[i].as_dvec2();
                rows.extend([scaled(&x, scale), scaled(&y, scale)]);
                right.extend([scale * v.x, scale * v.y]);
            }
        }
    }
    // Four points are exact up to degree 7; the integrands have degree 6.
    let gauss = [(-0.8611363115940526, 0.3478548451374538), (-0.3399810435848563, 0.6521451548625461)];
    let gauss: Vec<_> = gauss.iter().flat_map(|&(x, w)| [(x, w), (-x, w)]).collect();
    for (cy, cx) in (0..grid.cells[1]).flat_map(|cy| (0..grid.cells[0]).map(move |cx| (cy, cx))) {
        for &(x, wx) in &gauss {
            for &(y, wy) in &gauss {
                let at = [(cx as f64 + 0.5 + 0.5 * x) * hx, (cy as f64 + 0.5 + 0.5 * y) * hy];
                for (ox, oy, twice) in [(2, 0, 1.0), (1, 1, 2.0), (0, 2, 1.0)] {
                    let weight = twice * settings.alpha * 0.25 * wx * wy * hx * hy / grid.area();
                    let list = derivatives(settings, at, [ox, oy]);
                    for offset in [0, nx * ny] {
                        rows.push(list.iter().map(|&(i, g)| (offset + i, weight.sqrt() * g)).collect());
                        right.push(0.0);
                    }
                }
            }
        }
    }
    (rows, right)
}

/// In eight sums, which run in vector registers.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    for (a, b) in a.chunks(8).zip(b.chunks(8)) {
        a.iter().zip(b).zip(&mut sums).for_each(|((a, b), sum)| *sum += a * b);
    }
    sums.iter().sum()
}

/// Solves A x = b; `a` is symmetric and positive definite, row by row, and its lower half is overwritten by L of A = L L^T.
fn cholesky(a: &mut [f64], mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for i in 0..n {
        let (above, row) = a.split_at_mut(i * n);
        for j in 0..i {
            let other = &above[j * n..][..=j];
            row[j] = (row[j] - dot(&row[..j], &other[..j])) / other[j];
        }
        row[i] = (row[i] - dot(&row[..i], &row[..i])).sqrt();
        b[i] = (b[i] - dot(&row[..i], &b[..i])) / row[i];
    }
    for i in (0..n).rev() {
        let below: f64 = (i + 1..n).map(|j| a[j * n + i] * b[j]).sum();
        b[i] = (b[i] - below) / a[i * n + i];
    }
    b
}

/// The coefficients of psi and phi, times their weights in the velocity.
pub(crate) fn reference(settings: &FitSettings, points: &[Points]) -> [Vec<f64>; 2] {
    let [nx, ny] = settings.grid.nodes();
    let size = 2 * nx * ny;
    let (rows, right) = reference_rows(settings, points);
    let (mut matrix, mut b) = (vec![0.0; size * size], vec![0.0; size]);
    for (row, right) in rows.iter().zip(&right) {
        for &(i, a) in row {
            b[i] += a * right;
            row.iter().for_each(|&(k, c)| matrix[i * size + k] += a * c);
        }
    }
    // A spring at four unknowns holds what the velocity does not depend on: both constants, and two linear functions.
    let count = nx * ny;
    [0, count, count + nx - 1, 2 * count - nx].into_iter().for_each(|i| matrix[i * size + i] += 1.0);
    let x = cholesky(&mut matrix, b);
    let (a, c) = ((1.0 - settings.gamma).sqrt(), settings.gamma.sqrt());
    [(0, a), (nx * ny, c)].map(|(from, weight)| (0..nx * ny).map(|i| weight * x[from + i]).collect())
}

/// a - b without its mean, which moves nothing, in units of 1e-6: single precision then holds it well.
pub(crate) fn apart(a: &[f64], b: &[f64]) -> Vec<f32> {
    let mean = a.iter().zip(b).map(|(a, b)| a - b).sum::<f64>() / a.len() as f64;
    a.iter().zip(b).map(|(a, b)| ((a - b - mean) * 1e6) as f32).collect()
}
