//! The measured stages: how each is run at a size, and what bounds it.
//!
//! Every section that tells how fast a stage is reads the samples of this list, each taken once at a size.

mod fits;
mod photons;

use crate::context::{Context, Sample};
use crate::effort::Effort;
use lightloom_core::{Progress, Result};

pub(crate) use fits::flow_seconds;

/// One measured stage.
pub(crate) struct Stage {
    pub(crate) name: &'static str,
    /// The unit of its size.
    pub(crate) unit: &'static str,
    /// Largest exponent of a power law of its seconds over its size; none where they follow no law or none is asked for.
    pub(crate) exponent: Option<f64>,
    /// Whether its size grows by factors, and its seconds are expected to follow a power law.
    pub(crate) is_power_law: bool,
    /// The sizes at which it is run. The size of a sample is in the stage's unit, such as the unknowns of a grid.
    pub(crate) sizes: fn(Effort) -> Vec<usize>,
    /// Runs it; none where the project does not have the stage.
    run: Run,
    /// The limit of the machine, where one is counted.
    pub(crate) bounded: Option<Bounded>,
}

/// How a stage is compared with the machine.
pub(crate) struct Bounded {
    /// An item of its work.
    pub(crate) item: &'static str,
    /// The work that is counted.
    pub(crate) counted: &'static str,
    /// Size of the comparison, quick and full; one of [`Stage::sizes`].
    pub(crate) size: [usize; 2],
}

/// The numbers of photons, quick; all when full.
const PHOTONS: [usize; 7] = [10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000, 10_000_000];
const COMPARED: [usize; 2] = [300_000, 1_000_000];

fn photon_counts(effort: Effort) -> Vec<usize> {
    PHOTONS[..effort.pick(4, 7)].to_vec()
}

/// Cells along both sides.
fn grids(effort: Effort) -> Vec<usize> {
    [32, 64, 128, 256, 512][..effort.pick(3, 5)].to_vec()
}

/// Powers of two, and all threads.
fn thread_counts(_: Effort) -> Vec<usize> {
    let all = rayon::current_num_threads();
    (0..10).map(|power| 1 << power).take_while(|count| *count < all).chain([all]).collect()
}

/// All stages, in the order of the tables.
pub(crate) const STAGES: [Stage; 10] = [
    Stage::law("tracing", "photons", Some(1.05), photon_counts, photons::tracing).bounded(
        "photons landed",
        "all rays followed, at the rate of random rays through the bare hierarchy",
        COMPARED,
    ),
    Stage::law("matching", "photons", Some(1.15), photon_counts, photons::matching).bounded(
        "photons",
        "both columns of points read and written once per halving; not the map between the densities",
        COMPARED,
    ),
    Stage::law("fit, one warm step", "unknowns", Some(1.1), grids, fits::warm_step),
    Stage::law("fit, solver (few photons)", "unknowns", None, grids, fits::solver).bounded(
        "iterations",
        "entries of the matrix in seven products on grids that add up to 4/3; setting it up is not in it",
        [64, 256],
    ),
    Stage::law("advection, ten steps", "photons", Some(1.05), photon_counts, photons::advection).bounded(
        "photon-steps",
        "RK4: four sums over 4 x 4 splines of psi and phi, and the photon read and written",
        COMPARED,
    ),
    Stage::law("splatting", "photons", Some(1.05), photon_counts, photons::splatting).bounded(
        "photons",
        "position and flux read once, the texture written once",
        COMPARED,
    ),
    Stage::law("frame and pass", "texels", None, |_| vec![256, 512, 1024], photons::frame_and_pass).bounded(
        "texels",
        "splatting; rows and columns filtered, each read and written once; the sum read and written",
        [512, 1024],
    ),
    Stage::law("render", "passes", Some(1.05), |_| vec![1, 2, 4, 8], photons::passes),
    Stage::linear("fit of 20 steps", "walls", |_| vec![0, 1, 2, 5, 10, 20], fits::with_walls),
    Stage::linear("fit of 10 steps", "threads", thread_counts, fits::on_threads),
];

type Run = fn(&mut Context, usize, &Progress) -> Result<Option<Sample>>;

impl Stage {
    /// A stage whose seconds follow a power law of its size, with the largest exponent that it may have.
    const fn law(
        name: &'static str,
        unit: &'static str,
        exponent: Option<f64>,
        sizes: fn(Effort) -> Vec<usize>,
        run: Run,
    ) -> Self {
        Self { name, unit, exponent, is_power_law: true, sizes, run, bounded: None }
    }

    /// A stage whose seconds follow no power law.
    const fn linear(
        name: &'static str,
        unit: &'static str,
        sizes: fn(Effort) -> Vec<usize>,
        run: Run,
    ) -> Self {
        Self { name, unit, exponent: None, is_power_law: false, sizes, run, bounded: None }
    }

    /// The stage with a limit of the machine.
    const fn bounded(self, item: &'static str, counted: &'static str, size: [usize; 2]) -> Self {
        Self { bounded: Some(Bounded { item, counted, size }), ..self }
    }

    /// The stage at a size; run once.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; nothing that moves; cancelled.
    pub(crate) fn sample(
        &self,
        context: &mut Context,
        size: usize,
        progress: &Progress,
    ) -> Result<Option<Sample>> {
        context.sample((self.name, size), |context| (self.run)(context, size, progress))
    }
}
