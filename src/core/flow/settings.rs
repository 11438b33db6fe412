//! What an artist decides about the flow: meaning, unit, range, default.
//!
//! # gamma, measured
//!
//! `lightloom report PROJECT` fits a project at gammas from 0 to 1. In the joint fit of the paper psi and phi can each take
//! over what the other leaves, so gamma acts through their smoothness only, and the less alpha, the less of the slider is
//! alive. In the separate blend u = (1-gamma) u_psi + gamma u_phi it scales both. Gamma at which half of the divergence
//! is there, and half of the curl is gone (root mean square where the photons are, over the run, 20 000 photons):
//!
//! | | joint: divergence, curl | separate: divergence, curl |
//! |---|---|---|
//! | letters, alpha 1e-2 | 0.33, 0.39 | 0.45, 0.49 |
//! | letters, alpha 1e-3 | 0.09, 0.17 | 0.38, 0.47 |
//! | letters, alpha 1e-4 | 0.02, 0.03 | 0.36, 0.44 |
//! | letters, alpha 1e-5 | 0.01, 0.01 | 0.39, 0.39 |
//! | glass to flower, alpha 1e-3 | 0.08, 0.15 | 0.38, 0.42 |
//!
//! So the separate blend is the default: every part of the slider does something, at any alpha. At 0 and 1 the two are the
//! same. The price is a field that leaves more undone between them, which shows little: at alpha 1e-3 and gamma 0.5 (letters,
//! glass; joint / separate) fit_residual .29/.41 and .17/.28, wander .10/.13 and .05/.08, peak speed 4.2/4.4 and 4.1/4.3,
//! dispersion .0088/.0073 and .0076/.0079. It needs about three quarters of the time: two small systems of one matrix in
//! place of a coupled one.
//!
//! gamma itself stays at 0.5, half way between liquid and gradient, with as much to feel on either side. The joint fit at
//! 0.5 looks like the separate blend at 0.8.

use glam::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fade::Fade;
use super::turbulence::TurbulenceSettings;
use crate::{Error, Result};

/// How the photons flow from one key frame to the next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FlowSettings {
    /// Kind of flow, 0 to 1: 0 flows like a liquid (divergence-free), 1 like a gradient (irrotational). At 0 light
    /// cannot pile up by the field alone, so the fade does that work. Default 0.5.
    pub gamma: f32,
    /// Smoothness of the field, 1e-12 to 1e6: the field is smooth over about sqrt(alpha) of the longer side of the
    /// receiver (1e-4: 0.01, 1e-3: 0.03, 1e-2: 0.1). Default 1e-3.
    pub alpha: f32,
    /// How strongly directed lines pull, 0 to 1e6, beside all photons together, which pull by 1. Default 1.
    pub beta: f32,
    /// How the two kinds of flow are put together. Default separate.
    pub fit: FitKind,
    /// Cells of the field: one number for the longer side, or two for x and y. At least 8 each. Default 128.
    pub grid: GridSize,
    /// Time steps from one key frame to the next, 1 to 10000; the field is fitted once in each. Default 40.
    pub steps: u32,
    /// How the photons leave the field to arrive at their targets. Default smooth.
    pub fade: Fade,
    /// Swirls added to the field. Default none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turbulence: Option<TurbulenceSettings>,
    /// Brightness of the target, over 0 to 1000: its total flux over that of the source. Default 1, which keeps the
    /// energy.
    pub rho: f32,
    /// Photons the field is fitted to, 1 to 50 million, taken evenly from all. Default 100000.
    pub guides: u32,
    /// Relative residual at which the fit's solver stops, 1e-12 to 0.1. Default 1e-4.
    pub tolerance: f32,
}

/// How psi and phi are fitted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FitKind {
    /// Both at once, as in the paper, Eq. (7). Between 0 and 1 gamma then acts through the smoothness only, most of it
    /// below 0.2.
    Joint,
    /// Each alone, then blended by gamma: the slider acts evenly over its whole travel.
    #[default]
    Separate,
}

/// Cells of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum GridSize {
    /// Cells along the longer side; the other side gets square cells.
    Longer(u32),
    /// Cells along x and along y.
    Both([u32; 2]),
}

impl Default for FlowSettings {
    fn default() -> Self {
        Self {
            gamma: 0.5,
            alpha: 1e-3,
            beta: 1.0,
            fit: FitKind::default(),
            grid: GridSize::Longer(128),
            steps: 40,
            fade: Fade::default(),
            turbulence: None,
            rho: 1.0,
            guides: 100_000,
            tolerance: 1e-4,
        }
    }
}

/// Fewest cells along a side: a cubic spline needs room for its boundary.
pub const MIN_CELLS: u32 = 8;
/// Bytes the fit holds per node: half a symmetric stencil of 2 x 2 blocks in f64, again in f32 on all grid levels, moments and
/// vectors of the solver.
const FIT_BYTES_PER_NODE: u64 = 2048;
/// Bytes that one step keeps per node: the two coefficients of its field.
const FIELD_BYTES_PER_NODE: u64 = 8;
/// Most memory that a fit may ask for.
const MAX_BYTES: u64 = 8 << 30;

impl GridSize {
    /// No more than `most` cells along a side.
    pub fn at_most(self, most: u32) -> Self {
        match self {
            Self::Longer(cells) => Self::Longer(cells.min(most)),
            Self::Both(cells) => Self::Both(cells.map(|n| n.min(most))),
        }
    }

    /// Cells along x and y on a receiver of this extent.
    pub fn cells(self, extent: Vec2) -> [u32; 2] {
        match self {
            Self::Both(cells) => cells,
            Self::Longer(n) => {
                let side = |length: f32| ((length * n as f32).round() as u32).max(MIN_CELLS);
                [side(extent.x), side(extent.y)]
            }
        }
    }
}

impl FlowSettings {
    /// Refuses values out of range; `place` is the path of these settings, such as `flow`.
    ///
    /// # Errors
    /// `Value` names the first value that is out of its range, `Limit` a grid that would not fit into memory.
    pub fn check(&self, place: &str) -> Result<()> {
        let real = |name: &str, value: f32, low: f32, high: f32| {
            if (low..=high).contains(&value) {
                return Ok(());
            }
            Err(Error::value(format!("{place}.{name}"), format!("is {value}, must be {low} to {high}")))
        };
        real("gamma", self.gamma, 0.0, 1.0)?;
        real("alpha", self.alpha, 1e-12, 1e6)?;
        real("beta", self.beta, 0.0, 1e6)?;
        real("rho", self.rho, f32::MIN_POSITIVE, 1000.0)?;
        real("tolerance", self.tolerance, 1e-12, 0.1)?;
        let count = |name: &str, value: u32, high: u32| {
            if (1..=high).contains(&value) {
                return Ok(());
            }
            Err(Error::value(format!("{place}.{name}"), format!("is {value}, must be 1 to {high}")))
        };
        count("steps", self.steps, 10_000)?;
        count("guides", self.guides, 50_000_000)?;
        self.fade.check(&format!("{place}.fade"))?;
        if let Some(turbulence) = &self.turbulence {
            turbulence.check(&format!("{place}.turbulence"))?;
        }
        self.check_grid(&format!("{place}.grid"))
    }

    /// A grid neither too coarse for a spline nor too fine for the memory.
    fn check_grid(&self, place: &str) -> Result<()> {
        let [x, y] = match self.grid {
            GridSize::Longer(n) => [n, n],
            GridSize::Both(cells) => cells,
        };
        if x < MIN_CELLS || y < MIN_CELLS {
            let what = format!("is {x} x {y} cells, must be at least {MIN_CELLS} x {MIN_CELLS}");
            return Err(Error::value(place, what));
        }
        let per_node = FIT_BYTES_PER_NODE + FIELD_BYTES_PER_NODE * u64::from(self.steps);
        // Two sides of 32 bits and the bytes of a node go beyond 64 bits.
        let needed = (u128::from(x) + 3) * (u128::from(y) + 3) * u128::from(per_node);
        if needed <= u128::from(MAX_BYTES) {
            return Ok(());
        }
        let gib = |bytes: u128| bytes as f64 / (1u64 << 30) as f64;
        let largest = ((MAX_BYTES / per_node) as f64).sqrt() as u64 - 3;
        let what = format!(
            "{x} x {y} cells over {} steps need about {:.1} GiB, the limit is {:.0} GiB; the largest square grid is {largest} x {largest}",
            self.steps,
            gib(needed),
            gib(MAX_BYTES.into())
        );
        Err(Error::Limit { place: place.to_owned(), what })
    }
}
