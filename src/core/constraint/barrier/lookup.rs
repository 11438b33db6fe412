//! A uniform grid over the wall edges: visits those near a straight move and skips empty cells.

use glam::{DVec2, Vec2};

use super::edge::Edge;

/// Cells along the longer side of the receiver.
const CELLS: f64 = 128.0;
/// Limit of cells along one side; walls may be drawn far off the receiver.
const MOST: f64 = 1024.0;
/// Margin by which an edge is also sorted into cells beside it, in cells: rounding at a cell's corner misses nothing.
const MARGIN: f64 = 1e-3;
/// Least advance along a move, in cells; well below the margin.
const CREEP: f64 = 1e-5;

/// The edges, sorted into square cells.
#[derive(serde::Deserialize, serde::Serialize)]
pub(super) struct Lookup {
    origin: DVec2,
    /// Cells per plane unit.
    scale: f64,
    size: [usize; 2],
    /// First item of each cell, and the end of the last.
    starts: Vec<u32>,
    items: Vec<u32>,
    /// Rings of empty cells around each cell plus one; 0 where it holds an edge.
    free: Vec<u8>,
    /// Number of edges.
    count: u32,
}

impl Lookup {
    pub(super) fn new(edges: &[Edge], extent: Vec2) -> Self {
        let (mut low, mut high) = (DVec2::ZERO, extent.as_dvec2());
        for point in edges.iter().flat_map(|s| [s.from.as_dvec2(), s.to.as_dvec2()]) {
            (low, high) = (low.min(point), high.max(point));
        }
        let scale = (CELLS / f64::from(extent.max_element())).min((MOST - 2.0) / (high - low).max_element());
        let origin = low - 1.0 / scale;
        let size = ((high - low) * scale).to_array().map(|cells| cells.ceil() as usize + 2);
        let mut lookup = Self {
            origin,
            scale,
            size,
            starts: Vec::new(),
            items: Vec::new(),
            free: Vec::new(),
            count: edges.len() as u32,
        };
        lookup.sort(edges);
        lookup.measure_free();
        lookup
    }

    /// Sorts each edge into the cells that it touches.
    fn sort(&mut self, edges: &[Edge]) {
        let mut pairs: Vec<(u32, u32)> = Vec::new();
        for (i, edge) in edges.iter().enumerate() {
            let [p, q] = [edge.from, edge.to].map(|point| self.cells_from_plane(point));
            let (low, high) = ((p.min(q) - MARGIN).floor(), (p.max(q) + MARGIN).floor());
            let columns = low.x as usize..=(high.x as usize).min(self.size[0] - 1);
            for y in low.y as usize..=(high.y as usize).min(self.size[1] - 1) {
                for x in columns.clone() {
                    if touches(p, q, DVec2::new(x as f64, y as f64)) {
                        pairs.push(((y * self.size[0] + x) as u32, i as u32));
                    }
                }
            }
        }
        pairs.sort_unstable();
        self.starts = vec![0; self.size[0] * self.size[1] + 1];
        for (cell, _) in &pairs {
            self.starts[*cell as usize + 1] += 1;
        }
        for cell in 1..self.starts.len() {
            self.starts[cell] += self.starts[cell - 1];
        }
        self.items = pairs.into_iter().map(|(_, item)| item).collect();
    }

    /// Chebyshev distance of each cell to the nearest one with an edge, in two sweeps.
    fn measure_free(&mut self) {
        let [width, height] = self.size;
        let mut free: Vec<u8> = self.starts.windows(2).map(|w| if w[1] > w[0] { 0 } else { 255 }).collect();
        let mut relax = |x: usize, y: usize, neighbours: [(isize, isize); 4]| {
            for (dx, dy) in neighbours {
                let (nx, ny) = (x.wrapping_add_signed(dx), y.wrapping_add_signed(dy));
                if nx < width && ny < height {
                    free[y * width + x] = free[y * width + x].min(free[ny * width + nx].saturating_add(1));
                }
            }
        };
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            relax(x, y, [(-1, 0), (-1, -1), (0, -1), (1, -1)]);
        }
        for (y, x) in (0..height).rev().flat_map(|y| (0..width).rev().map(move |x| (y, x))) {
            relax(x, y, [(1, 0), (1, 1), (0, 1), (-1, 1)]);
        }
        self.free = free;
    }

    /// Whether `test` holds for an edge in one of the cells from `a` to `b`; an edge may be tested several times. False
    /// where a point is not finite.
    ///
    /// Each round advances, or is the last: where a move is so long that a cell is lost in rounding, all edges are tested.
    #[inline]
    pub(super) fn any(&self, a: Vec2, b: Vec2, mut test: impl FnMut(u32) -> bool) -> bool {
        let (p, q) = (self.cells_from_plane(a), self.cells_from_plane(b));
        let step = q - p;
        if !step.is_finite() {
            return false;
        }
        if self.is_free(p, step.abs().max_element()) {
            return false;
        }
        let Some((mut t, end)) = self.clip(p, step) else { return false };
        let per_cell = 1.0 / step.abs().max_element().max(f64::MIN_POSITIVE);
        loop {
            let at = p + step * t;
            let x = (at.x.max(0.0) as usize).min(self.size[0] - 1);
            let y = (at.y.max(0.0) as usize).min(self.size[1] - 1);
            let cell = y * self.size[0] + x;
            let free = self.free[cell];
            if free == 0 {
                let items = self.starts[cell] as usize..self.starts[cell + 1] as usize;
                if self.items[items].iter().any(|&item| test(item)) {
                    return true;
                }
            }
            let leave_x = leave(p.x, step.x, x as f64);
            let leave_y = leave(p.y, step.y, y as f64);
            let leap = t + f64::from(free.saturating_sub(1)) * per_cell;
            // Where rounding says that the cell was left already, the move advances by the least step.
            let next = leave_x.min(leave_y).max(leap).max(t) + CREEP * per_cell;
            if next <= t {
                return (0..self.count).any(test);
            }
            if next > end {
                // The end may lie in a neighbour that is entered within the last least step.
                if t >= end {
                    return false;
                }
                t = end;
                continue;
            }
            t = next;
        }
    }

    /// Whether an edge may lie within `reach` of `p`.
    pub(super) fn nearby(&self, p: Vec2, reach: f32) -> bool {
        !self.is_free(self.cells_from_plane(p), f64::from(reach) * self.scale)
    }

    /// Whether no edge is within `reach` of `p` along either axis, in cells; false where that is not known.
    #[inline]
    fn is_free(&self, p: DVec2, reach: f64) -> bool {
        let (x, y) = (p.x as usize, p.y as usize);
        p.cmpge(DVec2::ZERO).all()
            && x < self.size[0]
            && y < self.size[1]
            && f64::from(self.free[y * self.size[0] + x]) - 1.0 > reach
    }

    fn cells_from_plane(&self, p: Vec2) -> DVec2 {
        (p.as_dvec2() - self.origin) * self.scale
    }

    /// The part of a move that lies within the grid, as fractions of it.
    fn clip(&self, p: DVec2, step: DVec2) -> Option<(f64, f64)> {
        let (mut begin, mut end) = (0.0f64, 1.0f64);
        for axis in 0..2 {
            let size = self.size[axis] as f64;
            if step[axis] == 0.0 {
                if !(0.0..=size).contains(&p[axis]) {
                    return None;
                }
                continue;
            }
            let (t0, t1) = (-p[axis] / step[axis], (size - p[axis]) / step[axis]);
            (begin, end) = (begin.max(t0.min(t1)), end.min(t0.max(t1)));
        }
        (begin <= end).then_some((begin, end))
    }
}

/// Fraction of a move at which it leaves the cell that begins at `cell`, along one axis.
#[inline]
fn leave(p: f64, step: f64, cell: f64) -> f64 {
    if step > 0.0 {
        (cell + 1.0 - p) / step
    } else if step < 0.0 {
        (cell - p) / step
    } else {
        f64::INFINITY
    }
}

/// Whether the edge from `p` to `q` touches the cell at `low`, widened by the margin: separating axes.
fn touches(p: DVec2, q: DVec2, low: DVec2) -> bool {
    let half = 0.5 + MARGIN;
    let (p, q) = (p - low - 0.5, q - low - 0.5);
    let step = q - p;
    let middle = (p + q) * 0.5;
    let reach = step.abs() * 0.5 + half;
    middle.abs().cmple(reach).all() && step.perp_dot(p).abs() <= half * (step.x.abs() + step.y.abs())
}
