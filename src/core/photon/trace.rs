//! Parallel tracing of an exact number of caustic photons.
//!
//! The number of candidates of a pass is fixed beforehand from the landing rate measured in [`Tracer::new`], with a margin,
//! and all are traced, stratified over the cells of the [`EmissionPlan`]; so a photon's flux / candidates is known before
//! any is traced and the estimate is unbiased. Of all that land, as many of equal flux are drawn as were asked for (see
//! [`thinning`](super::thinning)). Candidates are added only beyond five standard deviations; the bias of that is far below
//! the noise of a single photon.

use std::sync::Arc;
use std::time::Instant;

use rayon::prelude::*;

use super::domain::EmissionGuiding;
use super::emission_plan::EmissionPlan;
use super::path::{FluxBalance, LightPart, Unwatched, Watch, follow};
use super::thinning::equal_flux;
use super::window::{Cells, Gate, Lesson, Recorder, Window};
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
/// Least gain for which a window is used, in rays for a photon of equal flux; the look-up costs a few per cent.
const LEAST_GAIN: f64 = 1.1;

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
#[derive(Clone, serde::Deserialize, serde::Serialize)]
pub struct EmissionGuide(Arc<GuidedEmission>);

#[derive(serde::Deserialize, serde::Serialize)]
struct GuidedEmission {
    plan: EmissionPlan,
    part: LightPart,
    seed: u64,
    /// Landing rate: photons per candidate.
    rate: f64,
    /// Ends paths that hardly ever land.
    window: Option<Window>,
}

/// The photons of one batch.
struct Batch<W> {
    photons: Photons,
    /// The cell each photon came from.
    cells: Vec<u32>,
    balance: FluxBalance,
    /// What watched the paths.
    watch: W,
}

/// The photons of a batch, and where all its light went.
type Landed = (Photons, FluxBalance);

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
        let triangles = scene.meshes().iter().map(|mesh| mesh.triangles).sum();
        let mut lesson = Lesson::new(Cells::new(triangles));
        let plan = EmissionPlan::new((scene, part), guiding, seed, &mut lesson, progress)?;
        let mut emission = GuidedEmission { plan, part, seed, rate: 0.0, window: None };
        if emission.plan.cells.is_empty() {
            return Err(diagnosis::no_caustic(scene, &emission.plan.balances));
        }
        let measured = emission.pilot(scene, &mut lesson, progress)?;
        if emission.rate == 0.0 {
            return Err(diagnosis::no_caustic(scene, &emission.plan.balances));
        }
        if guiding == EmissionGuiding::Learned {
            let window = lesson.window([measured.rate as f32, measured.rays as f32]);
            emission.try_window(scene, window, measured, progress)?;
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
        let (mut landings, mut balance) = (Vec::new(), FluxBalance::default());
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
            for (photons, of_batch) in
                emission.trace_part(self.scene, (pass, candidates, wanted), progress)?
            {
                landed += photons.len() as u64;
                balance.add(of_batch);
                landings.push(photons);
            }
            candidates += wanted;
        }
        let offset = Stream::new(emission.seed, Purpose::Trace, pass, THINNING).f64();
        let photons = equal_flux(&landings, count, offset, 1.0 / candidates as f64);
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
    /// Measures the landing rate and learns the fate of the paths; cells that were missed become active.
    fn pilot(&mut self, scene: &Scene, lesson: &mut Lesson, progress: &Progress) -> Result<Measured> {
        let mut measured = Measured::default();
        for pilot in 0..PILOTS {
            let run = (PILOT_PASS, pilot * PILOT, PILOT);
            let recorder = || Recorder::new(lesson.cells);
            let batches = self.trace_candidates(scene, run, recorder, progress)?;
            batches.iter().for_each(|batch| lesson.add(&batch.watch.trails));
            measured = Measured::of(&batches);
            self.rate = measured.rate;
            let cells: Vec<u32> = batches.into_iter().flat_map(|batch| batch.cells).collect();
            if !self.plan.activate(&cells) {
                break;
            }
        }
        Ok(measured)
    }

    /// Uses a window if it pays, against the cost `without`.
    fn try_window(
        &mut self,
        scene: &Scene,
        window: Window,
        without: Measured,
        progress: &Progress,
    ) -> Result<()> {
        let run = (PILOT_PASS, PILOTS * PILOT, PILOT);
        let with = Measured::of(&self.trace_candidates(scene, run, || Gate::new(&window), progress)?);
        if with.rate > 0.0 && without.cost > LEAST_GAIN * with.cost {
            (self.rate, self.window) = (with.rate, Some(window));
        }
        Ok(())
    }

    /// The candidates, in whole batches, that yield `count` photons within five standard deviations.
    fn candidates_for(&self, count: u64) -> u64 {
        let count = count as f64;
        let photons = count + 5.0 * (count * (1.0 - self.rate)).max(1.0).sqrt();
        // The relative uncertainty of the pilot is one over the root of its photons.
        let pilot = (self.rate * PILOT as f64).sqrt();
        let rate = self.rate * (1.0 - 3.0 / pilot).max(0.25);
        ((photons / rate / BATCH as f64).ceil() as u64).max(1) * BATCH
    }

    /// Traces candidates of a pass as every pass does: within the window, if there is one.
    fn trace_part(&self, scene: &Scene, part: (u64, u64, u64), progress: &Progress) -> Result<Vec<Landed>> {
        fn landed<W>(batches: Vec<Batch<W>>) -> Vec<Landed> {
            batches.into_iter().map(|batch| (batch.photons, batch.balance)).collect()
        }
        match &self.window {
            Some(window) => self.trace_candidates(scene, part, || Gate::new(window), progress).map(landed),
            None => self.trace_candidates(scene, part, || Unwatched, progress).map(landed),
        }
    }

    /// Traces `count` candidates of a pass, a multiple of `BATCH`, spread over all cells; `first` is the index of the
    /// first in its pass. Each batch is watched by a `watch` of its own.
    fn trace_candidates<W: Watch + Send>(
        &self,
        scene: &Scene,
        (pass, first, count): (u64, u64, u64),
        watch: impl Fn() -> W + Sync,
        progress: &Progress,
    ) -> Result<Vec<Batch<W>>> {
        (0..count / BATCH)
            .into_par_iter()
            .map(|batch| {
                progress.check()?;
                let batch = self.trace_batch(scene, (pass, first, count), batch * BATCH, watch());
                progress.advance(batch.photons.len() as u64);
                Ok(batch)
            })
            .collect()
    }

    /// Candidate i takes the i-th of `count` strata of the cells: neighbours in a batch meet the same triangles, which are
    /// then in the cache.
    fn trace_batch<W: Watch>(
        &self,
        scene: &Scene,
        (pass, first, count): (u64, u64, u64),
        start: u64,
        mut watch: W,
    ) -> Batch<W> {
        let (mut photons, mut cells) = (Photons::default(), Vec::new());
        let mut balance = FluxBalance::default();
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
            watch.starts(cell.factor);
            let light = (cell.flux, media);
            let landing = follow((scene, self.part), ray, light, &mut watch, &mut rng, &mut balance);
            watch.ends(landing.is_some());
            if let Some(landing) = landing {
                photons.push(landing.position, landing.flux, domain.light, landing.mesh);
                cells.push(at as u32);
            }
        }
        Batch { photons, cells, balance, watch }
    }
}

/// What a pilot run measures.
#[derive(Clone, Copy, Default)]
struct Measured {
    /// Photons per candidate.
    rate: f64,
    /// Rays per candidate.
    rays: f64,
    /// Rays for a photon of equal flux: unequal ones count by (sum w)^2 / sum w^2.
    cost: f64,
}

impl Measured {
    fn of<W>(batches: &[Batch<W>]) -> Self {
        let flux =
            || batches.iter().flat_map(|batch| &batch.photons.flux).map(|f| f64::from(f.element_sum()));
        let rays = batches.iter().map(|batch| batch.balance.rays).sum::<u64>() as f64;
        let (sum, squares) = flux().fold((0.0, 0.0), |(sum, squares), f| (sum + f, squares + f * f));
        let candidates = PILOT as f64;
        let rate = flux().count() as f64 / candidates;
        Self { rate, rays: rays / candidates, cost: rays * squares / (sum * sum) }
    }
}
