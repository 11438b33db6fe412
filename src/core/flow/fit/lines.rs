//! The rows D, d of directed lines at each step, Term (6): their direction at the speed of the photons around them.

use glam::Vec2;
use rayon::prelude::*;

use super::line_mask;
use super::rows::Rows;
use crate::constraint::ActiveLine;
use crate::flow::field::Grid;

/// Cells along the longer side in which the photons' speeds are averaged.
const CELLS: f32 = 64.0;

/// The directed lines of a segment.
pub(crate) struct DirectedLines<'a> {
    lines: &'a [ActiveLine],
    beta: f64,
    /// Number of samples of all lines, P of Term (6).
    samples: usize,
    size: [usize; 2],
    /// The wanted velocities of each line.
    wanted: Vec<Vec<Vec2>>,
    /// The mask of each line, see [`line_mask::mask`].
    masks: Vec<Vec<f64>>,
    /// The largest of the masks that act now.
    mask: Vec<f64>,
}

/// Sum and number of photon speeds.
#[derive(Clone, Copy, Default)]
struct Speeds {
    sum: f32,
    count: f32,
}

impl<'a> DirectedLines<'a> {
    /// Lines of weight `beta` in a fit on `grid`.
    pub(crate) fn new(lines: &'a [ActiveLine], beta: f32, grid: Grid) -> Self {
        let size = (grid.extent * CELLS).ceil().max(Vec2::ONE);
        let lines = if beta > 0.0 { lines } else { &[] };
        Self {
            lines,
            beta: beta.into(),
            samples: lines.iter().map(|line| line.positions.len()).sum(),
            size: [size.x as usize, size.y as usize],
            wanted: Vec::new(),
            masks: lines.par_iter().map(|line| line_mask::mask(line, grid)).collect(),
            mask: Vec::new(),
        }
    }

    /// Whether any line acts at time `t`.
    pub(crate) fn act_at(&self, t: f64) -> bool {
        self.lines.iter().any(|line| line.window.at(t) > 0.0)
    }

    /// The rows of Term (6) at time `t` from the photons' guidance, and their mask.
    pub(crate) fn rows(&mut self, t: f64, positions: &[Vec2], guidance: &[Vec2]) -> (Vec<Rows<'_>>, &[f64]) {
        let (cells, all) = self.speeds(positions, guidance);
        self.wanted = self.lines.iter().map(|line| self.velocities(line, &cells, all)).collect();
        self.mask.clear();
        let strength = |line: &ActiveLine| line.window.at(t);
        for (mask, _) in self.masks.iter().zip(self.lines).filter(|(_, line)| strength(line) > 0.0) {
            if self.mask.is_empty() {
                self.mask.clone_from(mask);
            }
            self.mask.iter_mut().zip(mask).for_each(|(sum, value)| *sum = sum.max(*value));
        }
        let per_sample = self.beta / self.samples as f64;
        let rows = self.lines.iter().zip(&self.wanted).map(|(line, velocities)| Rows {
            positions: &line.positions,
            velocities,
            weight: per_sample * f64::from(line.weight) * strength(line),
        });
        (rows.filter(|rows| rows.weight > 0.0).collect(), &self.mask)
    }

    /// The photons' speeds by cell, and in total.
    fn speeds(&self, positions: &[Vec2], guidance: &[Vec2]) -> (Vec<Speeds>, Speeds) {
        let [width, height] = self.size;
        let mut cells = vec![Speeds::default(); width * height];
        let mut all = Speeds::default();
        for (&p, v) in positions.iter().zip(guidance) {
            let at = (p * CELLS).floor();
            let speed = v.length();
            all.add(speed, 1.0);
            if at.x >= 0.0 && at.y >= 0.0 && at.x < width as f32 && at.y < height as f32 {
                cells[at.y as usize * width + at.x as usize].add(speed, 1.0);
            }
        }
        (cells, all)
    }

    /// The wanted velocities of a line: its directions at the mean speed of the photons within its width, or of all where
    /// there are none.
    fn velocities(&self, line: &ActiveLine, cells: &[Speeds], all: Speeds) -> Vec<Vec2> {
        let [width, height] = self.size;
        let reach = (line.width * CELLS).ceil() as isize;
        let speed = |p: Vec2| {
            let (x, y) = ((p.x * CELLS) as isize, (p.y * CELLS) as isize);
            let mut near = Speeds::default();
            for row in (y - reach).max(0)..=(y + reach).min(height as isize - 1) {
                for column in (x - reach).max(0)..=(x + reach).min(width as isize - 1) {
                    let cell = cells[row as usize * width + column as usize];
                    near.add(cell.sum, cell.count);
                }
            }
            near.mean().or(all.mean()).unwrap_or(0.0)
        };
        let places = line.positions.iter().zip(&line.directions);
        places.map(|(&p, &direction)| direction * (line.speed * speed(p))).collect()
    }
}

impl Speeds {
    fn add(&mut self, sum: f32, count: f32) {
        self.sum += sum;
        self.count += count;
    }

    fn mean(self) -> Option<f32> {
        (self.count > 0.0).then(|| self.sum / self.count)
    }
}
