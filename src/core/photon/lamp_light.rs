//! Where the light of one lamp goes, by a few plain paths: what the editor tells of a selected lamp.

use glam::DVec3;
use rayon::prelude::*;

use super::domain::{Domain, EmissionGuiding, domains};
use super::path::{FluxBalance, LightPart, Unwatched, follow};
use crate::math::rng::{Purpose, Stream};
use crate::scene::{LightDesc, Scene};
use crate::{Progress, Result};

/// Paths for each caster, stratified in `SIDE` columns and rows.
const SIDE: u64 = 96;
/// Random-stream pass number of these paths; no render reaches it.
const PASS: u64 = u64::MAX - 2;

/// Where the light of one lamp goes, watts: means of the channels, as a lamp's power is that of each channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LampLight {
    /// Its power; none for a directional light.
    pub power: Option<f64>,
    /// What meets glass or mirrors.
    pub met: f64,
    /// What falls on the receiver by way of them.
    pub landed: f64,
}

impl LampLight {
    /// The light of the lamp of index `light`, to about one per cent. Deterministic in the seed. None of a light that the scene
    /// does not have.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn trace(scene: &Scene, light: usize, seed: u64, progress: &Progress) -> Result<Option<Self>> {
        let Some(desc) = scene.lights().get(light) else { return Ok(None) };
        let all = domains(scene, EmissionGuiding::Bounds);
        let mut balance = FluxBalance::default();
        let own = all.iter().enumerate().filter(|(_, domain)| usize::from(domain.light) == light);
        for (index, domain) in own.filter(|(_, domain)| domain.power() > 0.0) {
            let rows = (0..SIDE).into_par_iter().map(|row| {
                progress.check()?;
                Ok(traced((scene, domain), (index as u64, row), seed))
            });
            let rows: Vec<FluxBalance> = rows.collect::<Result<_>>()?;
            rows.into_iter().for_each(|row| balance.add(row.scaled(1.0 / (SIDE * SIDE) as f64)));
        }
        let watts = |flux: DVec3| flux.element_sum() / 3.0;
        let power = power(desc).map(|power| if desc.is_enabled() { power } else { 0.0 });
        Ok(Some(Self { power, met: watts(balance.emitted - balance.direct), landed: watts(balance.landed) }))
    }
}

/// The balance of one row of paths, each with the flux of the whole domain.
fn traced((scene, domain): (&Scene, &Domain), (index, row): (u64, u64), seed: u64) -> FluxBalance {
    let mut balance = FluxBalance::default();
    let mut rng = Stream::new(seed, Purpose::Trace, PASS, index << 32 | row);
    for column in 0..SIDE {
        let u = [column, row].map(|index| (index as f32 + rng.f32()) / SIDE as f32);
        if let Some((ray, media)) = domain.sample(scene, u, &mut rng) {
            let light = (domain.emission.flux, media);
            follow((scene, LightPart::Flowing), ray, light, &mut Unwatched, &mut rng, &mut balance);
        }
    }
    balance
}

/// Its power by the project, watts.
pub(super) fn power(light: &LightDesc) -> Option<f64> {
    let (watts, colour) = match light {
        LightDesc::Point(light) => (light.watts, light.colour),
        LightDesc::Spot(light) => (light.watts, light.colour),
        LightDesc::Directional(_) => return None,
        LightDesc::Rectangle(light) => (light.watts, light.colour),
        LightDesc::Sphere(light) => (light.watts, light.colour),
    };
    Some(f64::from(watts) * colour.map(f64::from).iter().sum::<f64>() / 3.0)
}
