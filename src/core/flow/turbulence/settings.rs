//! What an artist decides about turbulence.

use glam::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::setting::schema::Describe;
use crate::setting::{Choice, Setting, settings};
use crate::{Error, Result};

/// Swirls of random noise, added to the field. They are divergence-free, and fade before the photons arrive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct TurbulenceSettings {
    /// Root mean square speed of the swirls ([`Self::STRENGTH`]).
    pub strength: f32,
    /// Cells of each noise grid along the longer side ([`Self::GRIDS`]).
    pub grids: Vec<u32>,
    /// Exponent of the energy spectrum ([`Self::SLOPE`]).
    pub slope: f32,
    /// Share of each grid in the speed ([`Self::WEIGHTS`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<f32>>,
    /// New swirls per segment ([`Self::RATE`]).
    pub rate: f32,
    /// Seed of the noise ([`Self::SEED`]).
    pub seed: u64,
}

settings! { TurbulenceSettings {
    /// Speed of the swirls: their root mean square, in per cent of the plane's longer side from key frame to key frame.
    /// 0 is none.
    STRENGTH = Setting::real("flow.turbulence.strength", [0.0, 1000.0], &[20.0]).unit("%");
    /// Noise grids, 1 to 8 different ones: each adds swirls of its own size, about two cells wide.
    GRIDS = Setting::part("flow.turbulence.grids");
    /// Cells of a noise grid along the plane's longer side: the more, the finer the swirls.
    CELLS = Setting::whole("flow.turbulence.grids[]", [4.0, 512.0], &[30.0]).unit("cells");
    /// How the speed is shared among the grids.
    WEIGHTS = Setting::choice("flow.turbulence.weights", &[
        Choice { value: "", help: "by the slope of the energy spectrum" },
        Choice { value: "", help: "a weight for each grid, in place of the slope" },
    ]);
    /// Share of a grid in the speed; only the ratios count.
    WEIGHT = Setting::real("flow.turbulence.weights[]", [0.0, 1000.0], &[1.0]);
    /// Exponent of the energy spectrum over the grids, E(k) ~ k^slope. -5/3 is Kolmogorov's law; higher values give
    /// fine swirls more.
    SLOPE = Setting::real("flow.turbulence.slope", [-10.0, 10.0], &[-5.0 / 3.0]);
    /// How often the swirls are replaced by others from key frame to key frame; 0 keeps the same ones. Low rates wind
    /// light up like ink in water, high ones scatter it.
    RATE = Setting::real("flow.turbulence.rate", [0.0, 100.0], &[1.0]);
    /// Seed of the swirls, independent of the project's: another number gives other swirls of the same kind.
    SEED = Setting::whole("flow.turbulence.seed", [0.0, 9_007_199_254_740_991.0], &[1.0]);
} }

impl Default for TurbulenceSettings {
    fn default() -> Self {
        Self {
            strength: Self::STRENGTH.value(),
            grids: vec![Self::CELLS.value()],
            slope: Self::SLOPE.value(),
            weights: None,
            rate: Self::RATE.value(),
            seed: Self::SEED.value(),
        }
    }
}

/// Most memory that the noises of one segment may take.
const MAX_BYTES: u64 = 1 << 30;

impl TurbulenceSettings {
    /// Most noise grids: from 4 to 512 cells there are 8 octaves.
    pub const MOST_GRIDS: usize = 8;

    /// Whether there is anything to add.
    pub fn is_on(&self) -> bool {
        self.strength > 0.0
    }

    /// Refuses values out of range; `place` is the path of these settings, such as `flow.turbulence`.
    ///
    /// # Errors
    /// `Value` names the first value that is out of its range, `Limit` noises that would take too much memory.
    pub fn check(&self, place: &str) -> Result<()> {
        Self::STRENGTH.check(self.strength, place)?;
        Self::SLOPE.check(self.slope, place)?;
        Self::RATE.check(self.rate, place)?;
        self.check_grids(&format!("{place}.grids"))?;
        if let Some(weights) = &self.weights {
            for (i, &weight) in weights.iter().enumerate() {
                Self::WEIGHT.check_at(weight, || format!("{place}.weights[{i}]"))?;
            }
            let place = format!("{place}.weights");
            if weights.len() != self.grids.len() {
                let what =
                    format!("has {} values for {} grids; give one for each", weights.len(), self.grids.len());
                return Err(Error::value(place, what));
            }
            if weights.iter().all(|weight| *weight == 0.0) {
                return Err(Error::value(place, "are all 0; give strength 0 for no turbulence"));
            }
        }
        Self::SEED.check(self.seed, place)?;
        self.check_memory(place)
    }

    fn check_grids(&self, place: &str) -> Result<()> {
        if !(1..=Self::MOST_GRIDS).contains(&self.grids.len()) {
            let what = format!("has {} grids, must be 1 to {}", self.grids.len(), Self::MOST_GRIDS);
            return Err(Error::value(place, what));
        }
        for (i, cells) in self.grids.iter().enumerate() {
            let place = format!("{place}[{i}]");
            Self::CELLS.check_at(*cells, || place.clone())?;
            if self.grids[..i].contains(cells) {
                let what =
                    format!("is {cells} cells once more, which gives the same swirls; name each grid once");
                return Err(Error::value(place, what));
            }
        }
        Ok(())
    }

    fn check_memory(&self, place: &str) -> Result<()> {
        let needed = self.bytes(Vec2::ONE);
        if needed <= MAX_BYTES {
            return Ok(());
        }
        let gib = |bytes: u64| bytes as f64 / (1u64 << 30) as f64;
        let what = format!(
            "its noises take {:.1} GiB from one key frame to the next, the limit is {:.0} GiB; take a lower rate or coarser grids",
            gib(needed),
            gib(MAX_BYTES)
        );
        Err(Error::Limit { place: place.to_owned(), what })
    }

    /// Memory of the noises of one segment on a plane of this extent, at most.
    pub fn bytes(&self, extent: Vec2) -> u64 {
        let nodes = |cells: u32| {
            let side = |length: f32| u64::from((length * cells as f32).ceil() as u32 + 3);
            side(extent.x) * side(extent.y)
        };
        let keys = self.rate.ceil() as u64 + 2;
        // psi and phi of each node in f32.
        keys * 8 * self.grids.iter().map(|&cells| nodes(cells)).sum::<u64>()
    }

    /// Root mean square speed of all grids together, in plane units per unit of t.
    pub fn speed(&self) -> f32 {
        self.strength / 100.0
    }

    /// Share of each grid in the speed, with squares that sum to 1.
    ///
    /// The noise of a grid of n cells lies in the octave around k ~ n, whose energy is the integral of E(k) ~ k^slope over an
    /// octave: n^(slope + 1). So its speed goes as n^((slope + 1)/2).
    pub(super) fn shares(&self) -> Vec<f64> {
        let shares: Vec<f64> = match &self.weights {
            Some(weights) => weights.iter().map(|&weight| weight.into()).collect(),
            None => {
                let power = (f64::from(self.slope) + 1.0) / 2.0;
                self.grids.iter().map(|&cells| f64::from(cells).powf(power)).collect()
            }
        };
        let length = shares.iter().map(|share| share * share).sum::<f64>().sqrt();
        shares.iter().map(|share| share / length).collect()
    }
}
