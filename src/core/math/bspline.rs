//! Uniform cubic B-splines. Basis function `i` of an axis with cells of width h lives on [(i-3)h, (i+1)h], so a
//! point of cell `c` sees the functions c, c+1, c+2, c+3, and `cells` cells carry `cells + 3` functions.

/// Basis functions that reach beyond one per cell: an axis of n cells has n + 3.
pub const EXTRA: usize = 3;

/// Weights by which a function of a grid of doubled cell width is made of functions of the fine grid:
/// coarse I = sum over k of REFINE\[k\] fine (2I - 3 + k), exactly.
pub const REFINE: [f64; 5] = [0.125, 0.5, 0.75, 0.5, 0.125];

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
