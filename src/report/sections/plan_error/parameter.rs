//! The parameters of a plan.

use crate::effort::Effort;

/// One of the parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Parameter {
    Cells,
    Steps,
    Sweeps,
}

/// The values of all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Setting {
    /// Cells along the longer side.
    pub(super) cells: usize,
    /// Steps of the segment: the plan is renewed in each, and a field fitted.
    pub(super) steps: u32,
    /// Sweeps of the scaling over their usual number.
    pub(super) sweeps: f32,
}

const CELLS: [usize; 5] = [48, 64, 96, 128, 192];
const STEPS: [u32; 4] = [10, 20, 40, 80];
const SWEEPS: [f32; 5] = [0.125, 0.25, 0.5, 1.0, 2.0];

impl Parameter {
    pub(super) const ALL: [Self; 3] = [Self::Cells, Self::Steps, Self::Sweeps];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Cells => "cells",
            Self::Steps => "steps",
            Self::Sweeps => "sweeps",
        }
    }

    /// `own` with this parameter from coarse to fine.
    pub(super) fn varied(self, own: Setting, effort: Effort) -> Vec<Setting> {
        match self {
            Self::Cells => CELLS[..effort.pick(4, 5)].iter().map(|&cells| Setting { cells, ..own }).collect(),
            Self::Steps => STEPS[..effort.pick(3, 4)].iter().map(|&steps| Setting { steps, ..own }).collect(),
            Self::Sweeps => SWEEPS.into_iter().map(|sweeps| Setting { sweeps, ..own }).collect(),
        }
    }
}
