//! Parallel tracing of an exact number of caustic photons.
//!
//! The number of candidates of a pass is fixed beforehand from the landing rate measured in [`Tracer::new`], with a margin,
//! and all are traced, stratified over the cells of the [`EmissionPlan`]; so a photon's flux / candidates is known before
//! any is traced and the estimate is unbiased. The few surplus photons are thinned out evenly, at random offset, and the
//! others take over their flux in proportion. Candidates are added only beyond five standard deviations; the bias of
//! that is far below the noise of a single photon.

use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;

use super::domain::EmissionGuiding;
use super::emission_plan::EmissionPlan;
use super::path::{FluxBalance, LightPart, follow};
use super::{Photons, diagnosis};
use crate::math::rng::{Purpose, Stream};
use crate::scene::Scene;
use crate::{Error, Progress, Result};

/// Candidates per batch: the unit of parallel work.
const BATCH: u64 = 8192;
/// Candidates of a pilot run, the measurement of the landing rate.
const PILOT: u64 = 4 * BATCH;
/// Most pilot runs; each activates cells that were missed.
const PILOTS: u64 = 4;
/// Random-stream pass number of the pilot runs; no render reaches it.
const PILOT_PASS: u64 = u64::MAX - 1;
/// Random-stream index of the thinning offset; no candidate reaches it.
const THINNING: u64 = u64::MAX;
/// Strided rounds of the output order, a power of 2.
const ROUNDS: u64 = 256;

/// The cost and flux balance of one pass.
#[derive(Clone, Debug, PartialEq)]
pub struct TraceReport {
    /// Number of candidates.
    pub candidates: u64,
    /// Caustic photons that landed; a few more than requested.
    pub landed: u64,
    /// The balance of the flux (W) sent towards glass and mirrors.
    pub balance: FluxBalance,
    /// Wall time.
    pub seconds: f64,
}

/// The photon tracer of a scene: its caustic photons, pass by pass.
pub struct Tracer<'a> {
    scene: &'a Scene,
    guide: EmissionGuide,
}

/// The learned emission of a scene's lights: importance sampling towards the part of the light that is traced. Valid while
/// meshes, lights, receiver and seed stay the same. Cheap to clone.
#[derive(Clone)]
pub struct EmissionGuide(Arc<GuidedEmission>);

struct GuidedEmission {
    plan: EmissionPlan,
    part: LightPart,
    seed: u64,
    /// Landing rate: photons per candidate.
    rate: f64,
}

/// The photons of one batch.
#[derive(Default)]
struct Batch {
    photons: Photons,
    /// The cell each photon came from.
    cells: Vec<u32>,
    balance: FluxBalance,
}

impl<'a> Tracer<'a> {
    /// A tracer of the light that flows, with a newly learned emission guide. Fails with a diagnosis if no caustic falls on
    /// the receiver.
    pub fn new(scene: &'a Scene, seed: u64, progress: &Progress) -> Result<Self> {
        Self::of_part((scene, LightPart::Flowing), EmissionGuiding::Learned, seed, progress)
    }

    /// As [`Self::new`] with any guiding, to compare with at many times the cost.
    pub fn with_guiding(
        scene: &'a Scene,
        guiding: EmissionGuiding,
        seed: u64,
        progress: &Progress,
    ) -> Result<Self> {
        Self::of_part((scene, LightPart::Flowing), guiding, seed, progress)
    }

    /// A tracer of any part of the light.
    pub fn of_part(
        (scene, part): (&'a Scene, LightPart),
        guiding: EmissionGuiding,
        seed: u64,
        progress: &Progress,
    ) -> Result<Self> {
        let plan = EmissionPlan::new((scene, part), guiding, seed, progress)?;
        let mut emission = GuidedEmission { plan, part, seed, rate: 0.0 };
        if emission.plan.cells.is_empty() {
            return Err(diagnosis::no_caustic(scene, &emission.plan.balances));
        }
        for pilot in 0..PILOTS {
            let batches = emission.trace_candidates(scene, (PILOT_PASS, pilot * PILOT, PILOT), progress)?;
            let cells: Vec<u32> = batches.into_iter().flat_map(|batch| batch.cells).collect();
            emission.rate = cells.len() as f64 / PILOT as f64;
            if !emission.plan.activate(&cells) {
                break;
            }
        }
        if emission.rate == 0.0 {
            return Err(diagnosis::no_caustic(scene, &emission.plan.balances));
        }
        Ok(Self { scene, guide: EmissionGuide(Arc::new(emission)) })
    }

    /// A tracer with the guide of another one; the scene must have the same meshes, lights and receiver.
    pub fn with_guide(scene: &'a Scene, guide: EmissionGuide) -> Self {
        Self { scene, guide }
    }

    /// The emission guide, for [`Self::with_guide`].
    pub fn guide(&self) -> &EmissionGuide {
        &self.guide
    }

    /// The lights, by index, of which no trial path reached the receiver, each with a note on the reason.
    pub fn idle_lights(&self) -> Vec<(usize, String)> {
        diagnosis::idle_lights(self.scene, &self.guide.0.plan.balances)
    }

    /// Landing rate: photons per candidate.
    pub fn landing_rate(&self) -> f64 {
        self.guide.0.rate
    }

    /// Traces exactly `count` caustic photons of a pass. Equal for equal (seed, pass, count), on any number of threads.
    pub fn trace(&self, pass: u64, count: usize, progress: &Progress) -> Result<(Photons, TraceReport)> {
        let start = Instant::now();
        progress.begin("trace", count as u64);
        if count == 0 {
            return Err(Error::value("photons", "is 0: at least one photon is needed"));
        }
        let mut batches: Vec<Batch> = Vec::new();
        let (mut landed, mut candidates) = (0, 0);
        let emission = &*self.guide.0;
        let expected = emission.candidates_for(count as u64);
        while landed < count as u64 {
            if candidates > 100 * expected {
                let what =
                    format!("only {landed} of {count} photons landed, far fewer than the pilot run promised");
                return Err(Error::Numeric { stage: "trace", what });
            }
            let wanted = emission.candidates_for(count as u64 - landed);
            batches.extend(emission.trace_candidates(self.scene, (pass, candidates, wanted), progress)?);
            candidates += wanted;
            landed = batches.iter().map(|batch| batch.photons.len() as u64).sum();
        }
        let mut balance = FluxBalance::default();
        batches.iter().for_each(|batch| balance.add(batch.balance));
        let offset =
            (Stream::new(emission.seed, Purpose::Trace, pass, THINNING).f64() * landed as f64) as u64;
        let factor = landed as f64 / count as f64 / candidates as f64;
        let photons = thin(batches, count as u64, landed, offset, factor as f32);
        let report = TraceReport {
            candidates,
            landed,
            balance: balance.scaled(1.0 / candidates as f64),
            seconds: start.elapsed().as_secs_f64(),
        };
        Ok((photons, report))
    }
}

impl GuidedEmission {
    /// The candidates, in whole batches, that yield `count` photons within five standard deviations.
    fn candidates_for(&self, count: u64) -> u64 {
        let count = count as f64;
        let photons = count + 5.0 * (count * (1.0 - self.rate)).max(1.0).sqrt();
        // The relative uncertainty of the pilot is one over the root of its photons.
        let pilot = (self.rate * PILOT as f64).sqrt();
        let rate = self.rate * (1.0 - 3.0 / pilot).max(0.25);
        ((photons / rate / BATCH as f64).ceil() as u64).max(1) * BATCH
    }

    /// Traces `count` candidates of a pass, a multiple of `BATCH`, spread over all cells; `first` is the index of the
    /// first in its pass.
    fn trace_candidates(
        &self,
        scene: &Scene,
        (pass, first, count): (u64, u64, u64),
        progress: &Progress,
    ) -> Result<Vec<Batch>> {
        (0..count / BATCH)
            .into_par_iter()
            .map(|batch| {
                progress.check()?;
                let batch = self.trace_batch(scene, (pass, first, count), batch * BATCH);
                progress.advance(batch.photons.len() as u64);
                Ok(batch)
            })
            .collect()
    }

    /// Candidate i takes the i-th of `count` strata of the cells: neighbours in a batch meet the same triangles, which are
    /// then in the cache.
    fn trace_batch(&self, scene: &Scene, (pass, first, count): (u64, u64, u64), start: u64) -> Batch {
        let mut result = Batch::default();
        let share = |candidate: u64, within: f64| (candidate as f64 + within) / count as f64;
        let last = self.plan.cells.len() - 1;
        let mut at = self.plan.cumulative.partition_point(|below| *below <= share(start, 0.0)).min(last);
        for candidate in start..start + BATCH {
            let mut rng = Stream::new(self.seed, Purpose::Trace, pass, first + candidate);
            let share = share(candidate, rng.f64());
            while self.plan.cumulative[at] <= share && at < last {
                at += 1;
            }
            let cell = &self.plan.cells[at];
            let domain = &self.plan.domains[cell.domain as usize];
            let u = cell.corner.map(|corner| corner + rng.f32() * cell.size);
            let Some((ray, media)) = domain.sample(scene, u, &mut rng) else { continue };
            let landing = follow((scene, self.part), ray, cell.flux, media, &mut rng, &mut result.balance);
            if let Some(landing) = landing {
                result.photons.push(landing.position, landing.flux, domain.light, landing.mesh);
                result.cells.push(at as u32);
            }
        }
        result
    }
}

/// Keeps `count` of all `landed` photons, evenly spaced from `offset` on, with their flux times `factor`. Their order is by
/// strided rounds, so that the first n are an even sample too.
fn thin(batches: Vec<Batch>, count: u64, landed: u64, offset: u64, factor: f32) -> Photons {
    let mut kept = Photons::with_capacity(count as usize);
    let mut sum = offset;
    for Batch { photons, .. } in batches {
        for i in 0..photons.len() {
            sum += count;
            if sum >= landed {
                sum -= landed;
                kept.push(photons.positions[i], photons.flux[i] * factor, photons.light[i], photons.mesh[i]);
            }
        }
    }
    let order = || {
        let rounds = (0..ROUNDS).map(|round| round.reverse_bits() >> (u64::BITS - ROUNDS.trailing_zeros()));
        rounds.flat_map(|start| (start as usize..kept.len()).step_by(ROUNDS as usize))
    };
    Photons {
        positions: order().map(|i| kept.positions[i]).collect(),
        flux: order().map(|i| kept.flux[i]).collect(),
        light: order().map(|i| kept.light[i]).collect(),
        mesh: order().map(|i| kept.mesh[i]).collect(),
    }
}
