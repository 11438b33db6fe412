//! Grey closing with a disc: dark parts narrower than the disc take the brightness around them.

use super::picture::Picture;

/// Radius of the disc, cells.
const RADIUS: usize = 6;

impl Picture {
    /// The picture closed with a disc: dilated, then eroded. Nothing counts as outside.
    pub(super) fn closed(&self) -> Self {
        let negated = |picture: Self| Self { cells: picture.cells.iter().map(|n| -n).collect(), ..picture };
        negated(negated(self.dilated()).dilated())
    }

    /// The largest cell within the disc around each.
    fn dilated(&self) -> Self {
        let (columns, rows) = (self.columns, self.rows);
        let mut cells = vec![f32::NEG_INFINITY; self.cells.len()];
        let mut padded = vec![f32::NEG_INFINITY; columns + 2 * RADIUS];
        let mut widened = vec![vec![0.0; columns]; RADIUS + 1];
        for (y, row) in self.cells.chunks_exact(columns).enumerate() {
            padded[RADIUS..RADIUS + columns].copy_from_slice(row);
            widen(&padded, &mut widened);
            for to in y.saturating_sub(RADIUS)..=(y + RADIUS).min(rows - 1) {
                let chord = &widened[half_chord(to.abs_diff(y))];
                let out = &mut cells[to * columns..(to + 1) * columns];
                out.iter_mut().zip(chord).for_each(|(out, &n)| *out = out.max(n));
            }
        }
        Self { columns, rows, cells }
    }
}

/// The largest cell of a row within each distance of each.
fn widen(padded: &[f32], widened: &mut [Vec<f32>]) {
    let columns = widened[0].len();
    widened[0].copy_from_slice(&padded[RADIUS..RADIUS + columns]);
    for distance in 1..=RADIUS {
        let (narrower, wider) = widened.split_at_mut(distance);
        let left = &padded[RADIUS - distance..RADIUS - distance + columns];
        let right = &padded[RADIUS + distance..RADIUS + distance + columns];
        let narrower = narrower[distance - 1].iter().zip(left).zip(right);
        wider[0].iter_mut().zip(narrower).for_each(|(out, ((&a, &b), &c))| *out = a.max(b).max(c));
    }
}

/// Half the length of the row of the disc at this distance from its middle.
fn half_chord(distance: usize) -> usize {
    (RADIUS * RADIUS - distance * distance).isqrt()
}
