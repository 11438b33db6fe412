//! The kernel of motion around walls: many short steps, none through a wall, and no cell fuller than its cap.

use std::ops::Range;

use glam::Vec2;

use super::cells::Cells;
use super::step_kernel::{Leaving, StepKernel};

/// Densities below this count as none.
const LEAST: f64 = 1e-290;

/// The kernel over all steps with the factors that keep every cell below its cap.
#[derive(Clone)]
pub(super) struct WallKernel {
    /// The kernels, and which of them each step has.
    kernels: Vec<StepKernel>,
    of_step: Vec<usize>,
    /// Most light of each cell.
    cap: Vec<f64>,
    /// The share of light that is let stay beside walls in one step, by kernel and cell.
    soft: Vec<Vec<f64>>,
    /// The densities from both sides at the begin of each step.
    from: [Vec<Vec<f64>>; 2],
    /// Those on their way through a step and the next one.
    leaving: [Leaving; 2],
    /// Whether both sides have spread, so that the light between them is known.
    known: [bool; 2],
    /// The factors of both ends.
    ends: [Vec<f64>; 2],
    /// The steps between the ends.
    range: Range<usize>,
}

impl WallKernel {
    pub(super) fn new(
        (kernels, soft): (Vec<StepKernel>, Vec<Vec<f64>>),
        of_step: Vec<usize>,
        cap: Vec<f64>,
    ) -> Self {
        let (steps, count) = (of_step.len(), cap.len());
        let size = kernels.first().map_or([0; 2], StepKernel::size);
        let columns = || vec![vec![1.0; count]; steps + 1];
        Self {
            kernels,
            of_step,
            cap,
            soft,
            from: [columns(), columns()],
            leaving: [Leaving::none(size), Leaving::none(size)],
            known: [false; 2],
            ends: [vec![0.0; count], vec![0.0; count]],
            range: 0..steps,
        }
    }

    /// Moves both ends by `done` steps towards each other, from where they were at first.
    pub(super) fn narrow(&mut self, done: usize) {
        self.range = done..self.of_step.len() - done;
    }

    /// `out` = the density of `side` (0: from the begin on, 1: from the end back) at the other end.
    pub(super) fn spread(&mut self, side: usize, density: &[f64], out: &mut [f64]) {
        let Range { start, end } = self.range;
        self.known[side] = true;
        self.ends[side].copy_from_slice(density);
        let (first, last) = if side == 0 { (start, end) } else { (end, start) };
        let [now, next] = &mut self.leaving;
        let kernel_from =
            |place: usize| &self.kernels[self.of_step[if side == 0 { place } else { place - 1 }]];
        kernel_from(first).leave(density, now);
        let (a, b) = self.from.split_at_mut(1);
        let (own, other) = if side == 0 { (&mut a[0], &b[0]) } else { (&mut b[0], &a[0]) };
        let cap = (self.known == [true; 2]).then_some(&*self.cap);
        let mut place = first;
        loop {
            let kernel = kernel_from(place);
            place = if side == 0 { place + 1 } else { place - 1 };
            if place == last {
                kernel.arrive(now, out);
                own[last].copy_from_slice(out);
                return;
            }
            let (factors, other) = (Factors { cap, soft: &self.soft[self.of_step[place]] }, &other[place]);
            let kept = |cell: usize, density: f64| density * factors.of(cell, density * other[cell]);
            kernel.arrive_and_leave(now, &mut own[place], (kernel_from(place), kept), next);
            std::mem::swap(now, next);
        }
    }

    /// The factor of the later end that was spread last.
    pub(super) fn later_end(&self) -> &[f64] {
        &self.ends[1]
    }

    /// What has come from the earlier end to the later one.
    pub(super) fn reached_later(&self) -> &[f64] {
        &self.from[0][self.of_step.len()]
    }

    /// The light between the ends at the begin of step `k`, which is not the first: share of the light in each cell.
    pub(super) fn density(&self, k: usize) -> Vec<f64> {
        let [a, b] = &self.from;
        let factors = self.factors(k);
        let light = |(cell, (a, b)): (usize, (&f64, &f64))| a * b * factors.of(cell, a * b);
        a[k].iter().zip(&b[k]).enumerate().map(light).collect()
    }

    /// The velocity of the planned light in step `k` in each cell, plane units per step: half the mean move of the light that
    /// is there from here on, and half that of the light that is there then until now. Zero where there is none.
    ///
    /// Where walls change after the step, light of the side `alone` must be through by then, which its own moves alone know.
    pub(super) fn velocity(&mut self, k: usize, cells: &Cells, alone: Option<usize>) -> Vec<Vec2> {
        let [onward, back] = [0, 1].map(|side| self.onward(side, k, cells));
        match alone {
            None => onward.iter().zip(&back).map(|(onward, back)| 0.5 * (*onward - *back)).collect(),
            Some(0) => onward,
            Some(_) => back.iter().map(|back| -*back).collect(),
        }
    }

    /// The mean move in step `k` of the light of `side` towards the other end in each cell, plane units.
    pub(super) fn onward(&mut self, side: usize, k: usize, cells: &Cells) -> Vec<Vec2> {
        let light = if side == 0 { self.factored(1, k + 1) } else { self.factored(0, k) };
        self.moves_towards(k, &light, cells)
    }

    /// The density from `side` at the begin of step `k`, times the factor there.
    fn factored(&self, side: usize, k: usize) -> Vec<f64> {
        if k == [self.range.start, self.range.end][side] {
            return self.ends[side].clone();
        }
        let (factors, [own, other]) = (self.factors(k), [side, 1 - side].map(|side| &self.from[side][k]));
        let kept = |(cell, (own, other)): (usize, (&f64, &f64))| own * factors.of(cell, own * other);
        own.iter().zip(other).enumerate().map(kept).collect()
    }

    /// The factors at the begin of step `k`.
    fn factors(&self, k: usize) -> Factors<'_> {
        let cap = (self.known == [true; 2]).then_some(&*self.cap);
        Factors { cap, soft: &self.soft[self.of_step[k.min(self.of_step.len() - 1)]] }
    }

    /// The mean move from each cell to where `light` is, as far as step `k` reaches.
    pub(super) fn moves_towards(&mut self, k: usize, light: &[f64], cells: &Cells) -> Vec<Vec2> {
        let kernel = &self.kernels[self.of_step[k]];
        let [leaving, _] = &mut self.leaving;
        let mut spread = |values: &[f64]| {
            let mut out = vec![0.0; values.len()];
            kernel.leave(values, leaving);
            kernel.arrive(leaving, &mut out);
            out
        };
        let weighted = |axis: usize| -> Vec<f64> {
            light.iter().enumerate().map(|(i, value)| value * f64::from(cells.centre(i)[axis])).collect()
        };
        let (all, x, y) = (spread(light), spread(&weighted(0)), spread(&weighted(1)));
        let mean = |i: usize| {
            if all[i] <= LEAST {
                return Vec2::ZERO;
            }
            Vec2::new((x[i] / all[i]) as f32, (y[i] / all[i]) as f32) - cells.centre(i)
        };
        (0..all.len()).map(mean).collect()
    }

    /// `out` = `density` after `times` steps with the walls of step `k`.
    pub(super) fn blur(&mut self, k: usize, times: usize, density: &[f64], out: &mut [f64]) {
        if times == 0 {
            out.copy_from_slice(density);
            return;
        }
        let kernel = &self.kernels[self.of_step[k]];
        let [now, next] = &mut self.leaving;
        kernel.leave(density, now);
        for _ in 1..times {
            kernel.arrive_and_leave(now, out, (kernel, |_, density| density), next);
            std::mem::swap(now, next);
        }
        kernel.arrive(now, out);
    }
}

/// The factors of the light at one time, at most 1: what the cap and the softness of walls let stay.
#[derive(Clone, Copy)]
struct Factors<'a> {
    /// The cap, once the light is known.
    cap: Option<&'a [f64]>,
    soft: &'a [f64],
}

impl Factors<'_> {
    /// That of a cell in which the densities from both sides have this product.
    fn of(self, cell: usize, product: f64) -> f64 {
        let soft = self.soft[cell];
        self.cap.map_or(soft, |cap| (cap[cell] / product.max(LEAST)).min(soft))
    }
}
