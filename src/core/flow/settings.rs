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
use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};
use crate::{Error, Result};

/// The flow of the photons from one key frame to the next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS), transform = Describe(Fade::KIND))]
pub struct FlowSettings {
    /// Kind of flow ([`Self::GAMMA`]).
    pub gamma: f32,
    /// Smoothness of the field ([`Self::ALPHA`]).
    pub alpha: f32,
    /// Strength of directed lines ([`Self::BETA`]).
    pub beta: f32,
    /// Fit of the two kinds of flow ([`Self::FIT`]).
    pub fit: FitKind,
    /// Size of the pieces that stay together ([`Self::HOLD`]).
    pub hold: f32,
    /// Most density on the way ([`Self::DENSITY`]).
    pub density: f32,
    /// Cells of the field ([`Self::GRID`]).
    pub grid: GridSize,
    /// Time steps of a segment ([`Self::STEPS`]).
    pub steps: u32,
    /// Transition from the field to the targets.
    pub fade: Fade,
    /// Swirls added to the field.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turbulence: Option<TurbulenceSettings>,
    /// Flux of the target over that of the source ([`Self::RHO`]).
    pub rho: f32,
    /// Photons the field is fitted to ([`Self::GUIDES`]).
    pub guides: u32,
    /// Error of the solver ([`Self::TOLERANCE`]).
    pub tolerance: f32,
}

settings! { FlowSettings {
    /// Kind of flow. At 0 light sets out like a liquid (divergence-free): it swirls, keeps its brightness, and gathers
    /// only on the way; at 1 it spreads and gathers like a gradient (irrotational), without swirls. Beside walls it follows
    /// the plan, whatever gamma is. Adjust it first.
    GAMMA = Setting::real("flow.gamma", [0.0, 1.0], &[0.5]);
    /// Smoothness of the field, over a length of about sqrt(alpha) of the plane's longer side (1e-5: 0.003, 1e-4: 0.01,
    /// 1e-3: 0.03, 1e-2: 0.1). Low values follow the plan, high ones carry all light along in wide folds and tear it.
    ALPHA = Setting::real("flow.alpha", [1e-12, 1e6], &[1e-5]);
    /// Strength of directed lines, relative to all photons together, which pull by 1. Raise it where light ignores
    /// a line.
    BETA = Setting::real("flow.beta", [0.0, 1e6], &[1.0]);
    /// Flux of the target over that of the source. 1 keeps the energy; more brightens the picture on the way, less
    /// dims it.
    RHO = Setting::real("flow.rho", [f32::MIN_POSITIVE as f64, 1000.0], &[1.0]);
    /// How the two kinds of flow are fitted.
    FIT = Setting::choice("flow.fit", &[
        Choice { value: "separate", help: "each alone, then blended: gamma acts evenly over its whole range" },
        Choice { value: "joint", help: "both at once, as in the paper, Eq. (7): gamma acts mostly below 0.2" },
    ]);
    /// Size of the pieces of light that stay together on their way, share of the plane's longer side. Larger pieces tear
    /// less and arrive less evenly.
    HOLD = Setting::real("flow.hold", [0.04, 0.2], &[0.05]);
    /// How dense light may get on its way around walls, over its density at the key frames. Lower spreads it into wider
    /// lanes.
    DENSITY = Setting::real("flow.density", [1.0, 100.0], &[1.1]);
    /// Cells of the field along the plane's longer side; in a file also two numbers, along x and along y. Finer grids
    /// follow finer lines and take longer; the finest is smaller where there are more steps.
    GRID = Setting::whole("flow.grid", [MIN_CELLS as f64, 2041.0], &[128.0]);
    /// Time steps from key frame to key frame; the field is fitted in each. More follow tight bends more closely and
    /// take longer.
    STEPS = Setting::whole("flow.steps", [1.0, 10_000.0], &[40.0]);
    /// Photons the field is fitted to, taken evenly from all. More hold the field steadier where light is thin.
    GUIDES = Setting::whole("flow.guides", [1.0, 5e7], &[100_000.0]);
    /// Error of the photons' velocities at which the fit's solver stops, over their mean. Lower it only if the flow trembles from frame to frame.
    TOLERANCE = Setting::real("flow.tolerance", [1e-12, 0.1], &[1e-4]);
    /// Swirls of random noise added to the field; they fade before the light arrives.
    TURBULENCE = Setting::choice("flow.turbulence", &[
        Choice { value: "", help: "no swirls" },
        Choice { value: "", help: "swirls of the strength below" },
    ]);
} }

/// The fit of psi and phi ([`FlowSettings::FIT`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(transform = Describe(FlowSettings::FIT))]
pub enum FitKind {
    /// Both at once, Eq. (7).
    Joint,
    /// Each alone, then blended by gamma.
    #[default]
    Separate,
}

/// Cells of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum GridSize {
    /// Cells along the longer side; the other side gets square cells.
    Longer(#[schemars(range(min = MIN_CELLS))] u32),
    /// Cells along x and along y.
    Both([u32; 2]),
}

impl Default for FlowSettings {
    fn default() -> Self {
        Self {
            gamma: Self::GAMMA.value(),
            alpha: Self::ALPHA.value(),
            beta: Self::BETA.value(),
            fit: FitKind::default(),
            hold: Self::HOLD.value(),
            density: Self::DENSITY.value(),
            grid: GridSize::Longer(Self::GRID.value()),
            steps: Self::STEPS.value(),
            fade: Fade::default(),
            turbulence: None,
            rho: Self::RHO.value(),
            guides: Self::GUIDES.value(),
            tolerance: Self::TOLERANCE.value(),
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
        Self::GAMMA.check(self.gamma, place)?;
        Self::ALPHA.check(self.alpha, place)?;
        Self::BETA.check(self.beta, place)?;
        Self::RHO.check(self.rho, place)?;
        Self::TOLERANCE.check(self.tolerance, place)?;
        Self::HOLD.check(self.hold, place)?;
        Self::DENSITY.check(self.density, place)?;
        Self::STEPS.check(self.steps, place)?;
        Self::GUIDES.check(self.guides, place)?;
        self.fade.check(&format!("{place}.fade"))?;
        if let Some(turbulence) = &self.turbulence {
            turbulence.check(&format!("{place}.turbulence"))?;
        }
        self.check_grid(&format!("{place}.grid"))
    }

    fn bytes_per_node(&self) -> u64 {
        FIT_BYTES_PER_NODE + FIELD_BYTES_PER_NODE * u64::from(self.steps)
    }

    /// Cells along a side of the largest square grid that these steps leave memory for.
    pub fn finest_grid(&self) -> u32 {
        ((MAX_BYTES / self.bytes_per_node()) as f64).sqrt() as u32 - 3
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
        let per_node = self.bytes_per_node();
        // Two sides of 32 bits and the bytes of a node go beyond 64 bits.
        let needed = (u128::from(x) + 3) * (u128::from(y) + 3) * u128::from(per_node);
        if needed <= u128::from(MAX_BYTES) {
            return Ok(());
        }
        let gib = |bytes: u128| bytes as f64 / (1u64 << 30) as f64;
        let largest = self.finest_grid();
        let what = format!(
            "{x} x {y} cells over {} steps need about {:.1} GiB, the limit is {:.0} GiB; the largest square grid is {largest} x {largest}",
            self.steps,
            gib(needed),
            gib(MAX_BYTES.into())
        );
        Err(Error::Limit { place: place.to_owned(), what })
    }
}
