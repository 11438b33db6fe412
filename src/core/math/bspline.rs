//! Uniform cubic B-splines. Basis function `i` of an axis with cells of width h lives on [(i-3)h, (i+1)h], so a
//! point of cell `c` sees the functions c, c+1, c+2, c+3, and `cells` cells carry `cells + 3` functions.

/// Basis functions that reach beyond one per cell: an axis of n cells has n + 3.
pub const EXTRA: usize = 3;

/// Weights by which a function of a grid of doubled cell width is made of functions of the fine grid:
/// coarse I = sum over k of REFINE\[k\] fine (2I - 3 + k), exactly.
pub const REFINE: [f64; 5] = [0.125, 0.5, 0.75, 0.5, 0.125];

/// Places in -1..=1 and weights of Gauss and Legendre's rule with four points, exact to degree 7: products of two cubics
/// have degree 6 at most.
pub(super) const GAUSS: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_9),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_9),
];

/// Values of the four functions at `f` in 0..=1 within the cell.
#[inline(always)]
pub fn values(f: f64) -> [f64; 4] {
    let g = 1.0 - f;
    let f2 = f * f;
    [g * g * g / 6.0, (f2 * (3.0 * f - 6.0) + 4.0) / 6.0, (3.0 * (f + f2 - f2 * f) + 1.0) / 6.0, f2 * f / 6.0]
}

/// First derivatives at `f`, per cell width.
#[inline(always)]
pub fn slopes(f: f64) -> [f64; 4] {
    let g = 1.0 - f;
    [-0.5 * g * g, f * (1.5 * f - 2.0), 0.5 + f * (1.0 - 1.5 * f), 0.5 * f * f]
}

/// Second derivatives at `f`, per cell width squared.
#[inline(always)]
pub fn curvatures(f: f64) -> [f64; 4] {
    [1.0 - f, 3.0 * f - 2.0, 1.0 - 3.0 * f, f]
}

/// A symmetric matrix with three diagonals on either side: entry (i, i + d) is `diagonals[d][i]`.
#[derive(Clone, Debug)]
pub struct Band {
    /// Main diagonal and those above it, each as long as the matrix; zero where there is no column.
    pub diagonals: [Vec<f64>; 4],
}

impl Band {
    /// Exact integrals over `cells` cells of `width` of the products of derivatives of order 0, 1 or 2.
    pub fn gram(cells: usize, width: f64, order: usize) -> Self {
        let derivative = [values, slopes, curvatures][order];
        let scale = width / width.powi(2 * order as i32);
        let mut diagonals = [0; 4].map(|_| vec![0.0; cells + EXTRA]);
        for cell in 0..cells {
            for (x, weight) in GAUSS {
                let basis = derivative(0.5 + 0.5 * x);
                for i in 0..4 {
                    for k in i..4 {
                        diagonals[k - i][cell + i] += 0.5 * weight * scale * basis[i] * basis[k];
                    }
                }
            }
        }
        Self { diagonals }
    }

    /// Entry (i, i + d), for d of either sign.
    pub fn entry(&self, i: usize, d: isize) -> f64 {
        if d >= 0 { self.diagonals[d as usize][i] } else { self.entry(i.wrapping_add_signed(d), -d) }
    }

    /// The same integrals on the grid of doubled cell width, `nodes` of them: R G R^T, exact also where that grid
    /// reaches beyond the end.
    pub fn coarsened(&self, nodes: usize) -> Self {
        let fine = self.diagonals[0].len() as isize;
        let mut diagonals = [0; 4].map(|_| vec![0.0; nodes]);
        for (d, diagonal) in diagonals.iter_mut().enumerate() {
            for (i, value) in diagonal.iter_mut().enumerate() {
                for (a, b) in (0..5).flat_map(|a| (0..5).map(move |b| (a, b))) {
                    let (from, to) = (2 * i as isize - 3 + a, 2 * (i + d) as isize - 3 + b);
                    let near = (from - to).abs() <= 3 && (0..fine).contains(&from) && (0..fine).contains(&to);
                    if near {
                        *value +=
                            REFINE[a as usize] * REFINE[b as usize] * self.entry(from as usize, to - from);
                    }
                }
            }
        }
        Self { diagonals }
    }

    /// All entries times `factor`.
    pub fn scaled(&self, factor: f64) -> Self {
        Self { diagonals: self.diagonals.each_ref().map(|d| d.iter().map(|v| factor * v).collect()) }
    }
}
