//! Drawing from piecewise-constant densities by the inverse of their cumulative distribution.
//!
//! The inverse is monotone, so stratified numbers in give stratified points out (Pharr, Jakob, Humphreys, *Physically
//! Based Rendering*, sec. A.4). Cells of zero weight are never drawn.

use glam::Vec2;

/// A density on [0, 1), constant on each of `n` equal cells.
#[derive(Clone, Debug)]
pub struct Distribution1 {
    /// Share of the weight before each cell; `n + 1` values from 0 to 1.
    cdf: Vec<f64>,
}

/// One value drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample1 {
    /// The cell it fell into.
    pub cell: usize,
    /// Where inside its cell, in [0, 1); uniform when the number that went in was.
    pub within: f32,
    /// The value, in [0, 1).
    pub value: f32,
    /// Density there; its mean over [0, 1) is 1.
    pub pdf: f32,
}

impl Distribution1 {
    /// From the weights of the cells. `None` unless all are finite and not negative, and their sum is positive.
    pub fn new(weights: &[f32]) -> Option<Self> {
        let mut cdf = vec![0.0; weights.len() + 1];
        let sum = accumulate(weights, &mut cdf)?;
        (sum > 0.0).then_some(())?;
        normalise(&mut cdf, sum);
        Some(Self { cdf })
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.cdf.len() - 1
    }

    /// The value below which the share `u` in [0, 1) of the weight lies.
    pub fn sample(&self, u: f64) -> Sample1 {
        let (cell, within) = invert(&self.cdf, u);
        let cells = self.cells();
        Sample1 {
            cell,
            within,
            value: unit((cell as f32 + within) / cells as f32),
            pdf: cell_pdf(&self.cdf, cell),
        }
    }

    /// Density at `value` in [0, 1]; 0 outside.
    pub fn pdf(&self, value: f32) -> f32 {
        cell_of(value, self.cells()).map_or(0.0, |cell| cell_pdf(&self.cdf, cell))
    }
}

/// A density on [0, 1)^2, constant on each of `width` x `height` equal cells.
#[derive(Clone, Debug)]
pub struct Distribution2 {
    width: usize,
    /// Over the rows.
    rows: Distribution1,
    /// `height` rows of `width + 1`: share of the row's weight before each cell.
    columns: Vec<f64>,
}

/// One point drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample2 {
    /// Column and row of the cell it fell into.
    pub cell: [usize; 2],
    /// Where inside its cell, in [0, 1)^2.
    pub within: Vec2,
    /// The point, in [0, 1)^2.
    pub value: Vec2,
    /// Density there; its mean over the unit square is 1.
    pub pdf: f32,
}

impl Distribution2 {
    /// From the weights of the cells, row after row of `width`.
    ///
    /// `None` unless they fill whole rows, all are finite and not negative, and their sum is positive.
    pub fn new(weights: &[f32], width: usize) -> Option<Self> {
        (width > 0 && weights.len().is_multiple_of(width)).then_some(())?;
        let height = weights.len() / width;
        let mut columns = vec![0.0; height * (width + 1)];
        let mut row_sums = vec![0.0; height];
        for ((row, cdf), sum) in
            weights.chunks_exact(width).zip(columns.chunks_exact_mut(width + 1)).zip(&mut row_sums)
        {
            *sum = accumulate(row, cdf)?;
            normalise(cdf, *sum);
        }
        let mut cdf = vec![0.0; height + 1];
        for (row, sum) in row_sums.iter().enumerate() {
            cdf[row + 1] = cdf[row] + sum;
        }
        let sum = cdf[height];
        (sum > 0.0 && sum.is_finite()).then_some(())?;
        normalise(&mut cdf, sum);
        Some(Self { width, rows: Distribution1 { cdf }, columns })
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.rows.cells()]
    }

    /// The point of `u` in [0, 1)^2: its second number chooses the row, its first the column.
    pub fn sample(&self, u: [f64; 2]) -> Sample2 {
        let row = self.rows.sample(u[1]);
        let cdf = self.row(row.cell);
        let (column, within) = invert(cdf, u[0]);
        Sample2 {
            cell: [column, row.cell],
            within: Vec2::new(within, row.within),
            value: Vec2::new(unit((column as f32 + within) / self.width as f32), row.value),
            pdf: row.pdf * cell_pdf(cdf, column),
        }
    }

    /// Density at `value` in [0, 1]^2; 0 outside.
    pub fn pdf(&self, value: Vec2) -> f32 {
        match (cell_of(value.x, self.width), cell_of(value.y, self.rows.cells())) {
            (Some(column), Some(row)) => cell_pdf(&self.rows.cdf, row) * cell_pdf(self.row(row), column),
            _ => 0.0,
        }
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.columns[row * (self.width + 1)..(row + 1) * (self.width + 1)]
    }
}

/// Running sums of the weights into `cdf`; returns the sum, or `None` when a weight cannot be one.
fn accumulate(weights: &[f32], cdf: &mut [f64]) -> Option<f64> {
    let mut sum = 0.0;
    cdf[0] = 0.0;
    for (weight, cdf) in weights.iter().zip(&mut cdf[1..]) {
        (weight.is_finite() && *weight >= 0.0).then_some(())?;
        sum += f64::from(*weight);
        *cdf = sum;
    }
    Some(sum)
}

/// Scales running sums to end at exactly 1; a row without weight stays 0 and is never drawn.
fn normalise(cdf: &mut [f64], sum: f64) {
    if sum > 0.0 {
        cdf.iter_mut().for_each(|value| *value /= sum);
    }
}

/// The cell with `cdf[cell] <= u < cdf[cell + 1]`, and where in it.
fn invert(cdf: &[f64], u: f64) -> (usize, f32) {
    let u = u.clamp(0.0, 1.0 - f64::EPSILON);
    let cell = cdf.partition_point(|&before| before <= u).clamp(1, cdf.len() - 1) - 1;
    let share = cdf[cell + 1] - cdf[cell];
    (cell, if share > 0.0 { unit(((u - cdf[cell]) / share) as f32) } else { 0.0 })
}

fn cell_pdf(cdf: &[f64], cell: usize) -> f32 {
    ((cdf[cell + 1] - cdf[cell]) * (cdf.len() - 1) as f64) as f32
}

fn cell_of(value: f32, cells: usize) -> Option<usize> {
    (0.0..=1.0).contains(&value).then(|| ((value * cells as f32) as usize).min(cells - 1))
}

/// Rounding to f32 may reach 1, which belongs to the next cell.
fn unit(value: f32) -> f32 {
    value.min(1.0 - f32::EPSILON / 2.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn equal_strata_give_each_cell_its_share() {
        let weights = [0.0, 1.0, 3.0, 0.0, 4.0, 0.0];
        let distribution = Distribution1::new(&weights).unwrap();
        let mut counts = [0; 6];
        for i in 0..800 {
            let sample = distribution.sample((f64::from(i) + 0.5) / 800.0);
            counts[sample.cell] += 1;
            assert_eq!(sample.pdf, distribution.pdf(sample.value));
            assert!((0.0..1.0).contains(&sample.within));
        }
        assert_eq!(counts, [0, 100, 300, 0, 400, 0]);
    }

    #[test]
    fn the_ends_fall_into_cells_with_weight() {
        let distribution = Distribution2::new(&[0.0, 0.0, 0.0, 2.0, 0.0, 0.0], 3).unwrap();
        for u in [0.0, 0.5, 1.0 - 1e-17, 1.0] {
            let sample = distribution.sample([u, u]);
            assert_eq!(sample.cell, [0, 1]);
            assert!((sample.pdf - 6.0).abs() < 1e-6);
            assert_eq!(distribution.pdf(sample.value), sample.pdf);
        }
    }

    #[test]
    fn weights_that_cannot_be_a_density_are_none() {
        for bad in [&[0.0, 0.0][..], &[], &[1.0, f32::NAN], &[1.0, -1.0], &[f32::INFINITY, 1.0]] {
            assert!(Distribution1::new(bad).is_none());
            assert!(Distribution2::new(bad, 1).is_none());
        }
        assert!(Distribution2::new(&[1.0, 1.0, 1.0], 2).is_none());
    }
}
