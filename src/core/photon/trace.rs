//! Traces batches of light paths in parallel until exactly as many photons landed as were asked for.
//!
//! Candidates come in batches of fixed size, each spread evenly (stratified) over all cells of the [`Plan`]. How many batches a pass
//! needs is fixed beforehand from the landing rate seen in [`Tracer::new`], with a margin, and whole batches are traced; so
//! what each photon stands for, flux / candidates, is known before any is traced and the estimate has no bias. Of
//! the few photons too many an even share is left out, at random offset, and the others take over its flux in
//! proportion. Only if luck is worse than five standard deviations are batches added; the bias of that is far below the
//! noise of a single photon.

use std::time::Instant;

use rayon::prelude::*;

use super::aim::{Aim, Plan};
use super::path::{Ledger, follow};
use super::{Photons, why};
use crate::math::rng::{Purpose, Stream};
use crate::scene::Scene;
use crate::{Error, Progress, Result};

/// Candidates per batch: the unit of parallel work.
const BATCH: u64 = 8192;
/// Batches of the pilot run that measures the landing rate.
const PILOT: u64 = 4;
/// Pass number of the pilot run; no render reaches it.
const PILOT_PASS: u64 = u64::MAX - 1;
/// Index of the stream that chooses which photons are left out; no candidate reaches it.
const THINNING: u64 = u64::MAX;

/// What a pass cost and where its light went.
#[derive(Clone, Debug, PartialEq)]
pub struct TraceReport {
    /// Candidates sent.
    pub candidates: u64,
    /// Caustic photons that landed; a few more than were asked for.
    pub landed: u64,
    /// Where the flux went [W]; `emitted` is what was sent towards glass and mirrors.
    pub ledger: Ledger,
    /// Wall time.
    pub seconds: f64,
}

/// Traces the caustic photons of a scene, pass by pass.
pub struct Tracer<'a> {
    scene: &'a Scene,
    plan: Plan,
    seed: u64,
    /// Photons landed per candidate.
    rate: f64,
}

/// What one batch yields.
#[derive(Default)]
struct Batch {
    photons: Photons,
    ledger: Ledger,
}

impl<'a> Tracer<'a> {
    /// Learns where the lights must shine. Fails with the first reason if no caustic falls on the receiver.
    pub fn new(scene: &'a Scene, seed: u64, progress: &Progress) -> Result<Self> {
        Self::aimed(scene, Aim::Learned, seed, progress)
    }

    /// As [`Self::new`], with emission narrowed less: to compare with, at many times the cost.
    pub fn aimed(scene: &'a Scene, aim: Aim, seed: u64, progress: &Progress) -> Result<Self> {
        let plan = Plan::new(scene, aim, seed, progress)?;
        let mut tracer = Self { scene, plan, seed, rate: 0.0 };
        if tracer.plan.cells.is_empty() {
            return Err(why::no_caustic(scene, &tracer.plan.ledgers));
        }
        let pilot = tracer.batches(PILOT_PASS, 0..PILOT, progress)?;
        let landed: usize = pilot.iter().map(|batch| batch.photons.len()).sum();
        if landed == 0 {
            return Err(why::no_caustic(scene, &tracer.plan.ledgers));
        }
        tracer.rate = landed as f64 / (PILOT * BATCH) as f64;
        Ok(tracer)
    }

    /// Photons landed per candidate sent.
    pub fn landing_rate(&self) -> f64 {
        self.rate
    }

    /// Traces exactly `count` caustic photons of a pass. Equal for equal (seed, pass, count), on any number of threads.
    pub fn trace(&self, pass: u64, count: usize, progress: &Progress) -> Result<(Photons, TraceReport)> {
        let start = Instant::now();
        progress.begin("trace", count as u64);
        if count == 0 {
            return Err(Error::value("photons", "is 0: at least one photon is needed"));
        }
        let mut batches: Vec<Batch> = Vec::new();
        let mut landed = 0;
        let mut wanted = self.batches_for(count as f64);
        while landed < count as u64 {
            let done = batches.len() as u64;
            if done > 100 * self.batches_for(count as f64) {
                let what =
                    format!("only {landed} of {count} photons landed, far fewer than the pilot run promised");
                return Err(Error::Numeric { stage: "trace", what });
            }
            batches.extend(self.batches(pass, done..done + wanted, progress)?);
            landed = batches.iter().map(|batch| batch.photons.len() as u64).sum();
            wanted = self.batches_for(count.saturating_sub(landed as usize) as f64);
        }
        let candidates = batches.len() as u64 * BATCH;
        let mut ledger = Ledger::default();
        batches.iter().for_each(|batch| ledger.add(batch.ledger));
        let offset = (Stream::new(self.seed, Purpose::Trace, pass, THINNING).f64() * landed as f64) as u64;
        let photons = thin(&batches, count as u64, landed, offset, candidates);
        let report = TraceReport {
            candidates,
            landed,
            ledger: ledger.scaled(1.0 / candidates as f64),
            seconds: start.elapsed().as_secs_f64(),
        };
        Ok((photons, report))
    }

    /// Batches that yield `count` photons unless luck is worse than five standard deviations.
    fn batches_for(&self, count: f64) -> u64 {
        let photons = count + 5.0 * (count * (1.0 - self.rate)).max(1.0).sqrt();
        // The pilot's own uncertainty: one part in the root of what it landed.
        let pilot = (self.rate * (PILOT * BATCH) as f64).sqrt();
        let rate = self.rate * (1.0 - 3.0 / pilot).max(0.25);
        ((photons / rate / BATCH as f64).ceil() as u64).max(1)
    }

    fn batches(&self, pass: u64, range: std::ops::Range<u64>, progress: &Progress) -> Result<Vec<Batch>> {
        range
            .into_par_iter()
            .map(|batch| {
                progress.check()?;
                let batch = self.batch(pass, batch);
                progress.advance(batch.photons.len() as u64);
                Ok(batch)
            })
            .collect()
    }

    /// Candidate i of the batch takes the i-th of `BATCH` equal shares of the cells.
    fn batch(&self, pass: u64, batch: u64) -> Batch {
        let mut result = Batch::default();
        let mut at = 0;
        for candidate in 0..BATCH {
            let mut rng = Stream::new(self.seed, Purpose::Trace, pass, batch * BATCH + candidate);
            let share = (candidate as f64 + rng.f64()) / BATCH as f64;
            while self.plan.cumulative[at] <= share && at + 1 < self.plan.cells.len() {
                at += 1;
            }
            let cell = &self.plan.cells[at];
            let domain = &self.plan.domains[cell.domain as usize];
            let u = cell.corner.map(|corner| corner + rng.f32() * cell.size);
            let Some((ray, media)) = domain.sample(self.scene, u, &mut rng) else { continue };
            let landing = follow(self.scene, ray, cell.flux, media, &mut rng, &mut result.ledger);
            if let Some(landing) = landing {
                result.photons.push(landing.position, landing.flux, domain.light, landing.mesh);
            }
        }
        result
    }
}

/// Keeps `count` of all `landed` photons at even distances from `offset` on, in order, and gives each its flux.
fn thin(batches: &[Batch], count: u64, landed: u64, offset: u64, candidates: u64) -> Photons {
    let factor = (landed as f64 / count as f64 / candidates as f64) as f32;
    let mut photons = Photons::with_capacity(count as usize);
    let mut kept = offset;
    for batch in batches.iter().map(|batch| &batch.photons) {
        for i in 0..batch.len() {
            kept += count;
            if kept >= landed {
                kept -= landed;
                photons.push(batch.positions[i], batch.flux[i] * factor, batch.light[i], batch.mesh[i]);
            }
        }
    }
    photons
}
