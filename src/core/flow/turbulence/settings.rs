//! What an artist decides about turbulence.

use glam::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// Swirls of random noise, added to the field. They are divergence-free, and fade before the photons arrive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TurbulenceSettings {
    /// Speed of the swirls, 0 to 1000: their root mean square, in per cent of the longer side of the receiver from one
    /// key frame to the next. 0 is none. Default 20.
    pub strength: f32,
    /// Noise grids, 1 to 8 different ones: cells along the longer side of the receiver, 4 to 512. A swirl is about two cells
    /// wide. Default \[30\].
    pub grids: Vec<u32>,
    /// Slope of the energy spectrum over the grids, E(k) ~ k^slope, -10 to 10. Default -5/3, Kolmogorov's law.
    pub slope: f32,
    /// Share of each grid in the speed, 0 to 1000, one for each; in place of those that follow from the slope. Only their
    /// ratios count.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<f32>>,
    /// How often the swirls are replaced by others from one key frame to the next, 0 to 100; 0 keeps the same ones for ever.
    /// Low rates wind the light up like ink in water, high ones scatter it. Default 1.
    pub rate: f32,
    /// Seed of the noise, 0 to 9007199254740991, default 1. It is its own: another seed of the project leaves the swirls
    /// where they are.
    pub seed: u64,
}

impl Default for TurbulenceSettings {
    fn default() -> Self {
        Self { strength: 20.0, grids: vec![30], slope: -5.0 / 3.0, weights: None, rate: 1.0, seed: 1 }
    }
}

/// Fewest and most cells of a noise grid along the longer side.
const CELLS: std::ops::RangeInclusive<u32> = 4..=512;
/// Most noise grids: from 4 to 512 cells there are 8 octaves.
const MOST_GRIDS: usize = 8;
/// Largest seed: whole numbers in JSON are exact up to here.
const MOST_SEED: u64 = (1 << 53) - 1;
/// Most memory that the noises of one segment may take.
const MAX_BYTES: u64 = 1 << 30;

impl TurbulenceSettings {
    /// Whether there is anything to add.
    pub fn is_on(&self) -> bool {
        self.strength > 0.0
    }

    /// Refuses values out of range; `place` is the path of these settings, such as `flow.turbulence`.
    ///
    /// # Errors
    /// `Value` names the first value that is out of its range, `Limit` noises that would take too much memory.
    pub fn check(&self, place: &str) -> Result<()> {
        let real = |name: &str, value: f32, low: f32, high: f32| {
            if (low..=high).contains(&value) {
                return Ok(());
            }
            Err(Error::value(format!("{place}.{name}"), format!("is {value}, must be {low} to {high}")))
        };
        real("strength", self.strength, 0.0, 1000.0)?;
        real("slope", self.slope, -10.0, 10.0)?;
        real("rate", self.rate, 0.0, 100.0)?;
        self.check_grids(&format!("{place}.grids"))?;
        if let Some(weights) = &self.weights {
            for (i, &weight) in weights.iter().enumerate() {
                real(&format!("weights[{i}]"), weight, 0.0, 1000.0)?;
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
        if self.seed > MOST_SEED {
            return Err(Error::value(
                format!("{place}.seed"),
                format!("is {}, must be 0 to {MOST_SEED}", self.seed),
            ));
        }
        self.check_memory(place)
    }

    fn check_grids(&self, place: &str) -> Result<()> {
        if !(1..=MOST_GRIDS).contains(&self.grids.len()) {
            let what = format!("has {} grids, must be 1 to {MOST_GRIDS}", self.grids.len());
            return Err(Error::value(place, what));
        }
        for (i, cells) in self.grids.iter().enumerate() {
            let place = format!("{place}[{i}]");
            if !CELLS.contains(cells) {
                let what = format!("is {cells} cells, must be {} to {}", CELLS.start(), CELLS.end());
                return Err(Error::value(place, what));
            }
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
