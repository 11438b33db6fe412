//! The only place that knows the whole road: Project -> Scene -> photons -> matching -> flow -> passes -> frames.
//!
//! Each stage remembers the input it was made from: a new gamma refits and traces nothing; a new camera renders anew
//! and fits nothing. Preview and final are the same code at two [`Quality`] values; a [`Sketcher`] cuts the same stages
//! finer, for a window in which a project is edited.

mod acting;
mod batch;
mod check;
mod compare;
mod finish;
mod gauge;
mod grouping;
mod light;
mod loader;
mod meter;
mod motion;
mod mover;
mod onlooker;
mod output_folder;
mod passes;
mod plan;
mod quality;
mod rehearsal;
mod ride;
mod seen;
mod sketch;
mod slots;
mod stage;
mod stills;
mod summary;
mod supply;
mod tracks;

use std::path::Path;
use std::sync::Arc;

pub use check::{CastCaustic, CheckReport};
pub use compare::{Compared, Comparison};
pub use gauge::{TraceGauge, Traced};
pub use grouping::CausticLight;
pub use meter::StageCost;
pub use motion::FirstMove;
pub use onlooker::Onlooker;
pub use output_folder::{prepare_folder, write_report};
pub use plan::{LeftOut, Plan};
pub use quality::Quality;
pub(crate) use rehearsal::{Passed, Rehearsal, Take};
pub(crate) use sketch::covered;
pub use sketch::{Detail, Exposure, FieldAt, Look, Shot, Sketch, Sketcher};
pub(crate) use stills::{Still, Stills};
pub use summary::{BadValues, Energy, FlowNumbers, Summary};

use crate::photon::Tracer;
use crate::project::{AssetFolder, Project};
use crate::render::density::radius_of_pass;
use crate::render::{Image, PlaneView, ProgressiveRender, Visible, background, first_radius, layout_for};
use crate::{Error, Progress, Result};
use finish::{Finisher, Thumbnails};
use loader::{Loader, Prepared};
use meter::Meter;
use motion::{Motion, MotionInput};
use passes::{Account, Exposer};
use seen::Seen;
use stage::Stage;
use summary::Done;

/// The stages of one project, with what they remember.
pub struct Pipeline {
    loader: Loader,
    seen: Seen,
    motion: Stage<MotionInput, Arc<Motion>>,
}

/// Where a render goes, and who is told of it.
struct Work<'a> {
    out: &'a Path,
    progress: &'a Progress,
    saved: &'a (dyn Fn(&Path) + Sync),
    onlooker: &'a dyn Onlooker,
}

/// A finished render, with what a comparison asks of it.
struct Rendered {
    summary: Summary,
    motion: Arc<Motion>,
    thumbnails: Thumbnails,
    plane: PlaneView,
}

impl Pipeline {
    /// A pipeline that has done nothing yet and finds files through `assets`.
    pub fn new(assets: AssetFolder) -> Self {
        Self { loader: Loader::new(assets), seen: Seen::default(), motion: Stage::default() }
    }

    /// A pipeline that finds the same files and has done nothing yet.
    pub fn afresh(&self) -> Self {
        Self::new(self.loader.assets().clone())
    }

    /// Renders the project's frames into the folder `out`, which must be there. `saved` is told of each file.
    ///
    /// A run that is cancelled after its first pass still writes all frames, at the quality reached.
    ///
    /// # Errors
    /// Anything wrong with the project or its files, before any frame is written; input and output; cancelled before
    /// the first pass was complete.
    pub fn render(
        &mut self,
        project: &Project,
        out: &Path,
        progress: &Progress,
        saved: &(dyn Fn(&Path) + Sync),
    ) -> Result<Summary> {
        self.render_before(project, out, progress, saved, &())
    }

    /// As [`Pipeline::render`], before an onlooker who sees the frames grow.
    ///
    /// # Errors
    /// As [`Pipeline::render`].
    pub fn render_before(
        &mut self,
        project: &Project,
        out: &Path,
        progress: &Progress,
        saved: &(dyn Fn(&Path) + Sync),
        onlooker: &dyn Onlooker,
    ) -> Result<Summary> {
        let mut meter = Meter::default();
        let prepared = self.prepare(project, &mut meter, progress)?;
        prepared.plan.require_memory()?;
        progress.set_road(prepared.plan.stages.clone());
        onlooker.planned(&prepared.plan);
        let work = Work { out, progress, saved, onlooker };
        self.frames(project, prepared, meter, &work).map(|rendered| rendered.summary)
    }

    /// All stages of a render after the first look at the project.
    fn frames(
        &mut self,
        project: &Project,
        prepared: Prepared,
        mut meter: Meter,
        work: &Work,
    ) -> Result<Rendered> {
        let &Work { out, progress, saved, onlooker } = work;
        let (visible, background) = self.look(project, &prepared, &mut meter, progress)?;
        let tracer = learn(&prepared, project, &mut meter, progress)?;
        let motion = self.move_photons(project, &prepared, tracer.as_ref(), &mut meter, progress)?;

        let first = first_radius(&project.render, prepared.extent);
        let render = ProgressiveRender::new(*visible.layout(), first, prepared.slots.moments.len(), out)?;
        let plane = PlaneView::new(prepared.scene.as_deref(), prepared.extent);
        let (visible, background) = (&*visible, &*background);
        let drawn = &acting::shown(project);
        let finisher = Finisher {
            project,
            render: &render,
            visible,
            background,
            out,
            drawn,
            plane: plane.clone(),
            saved,
        };
        let passed = |passes| onlooker.passed(passes, &|frame| finisher.picture(&prepared.slots, frame));
        let (passes, account) = meter.measure("render", || {
            render_passes(project, &prepared, tracer.as_ref(), &motion, &render, progress, &passed)
        })?;
        let (bad_values, thumbnails) = meter.measure("write", || finisher.run(&prepared.slots, progress))?;
        let done = Done { command: "render", passes, motion: &motion, account, bad_values };
        let summary = Summary::new(project, prepared, done, &meter);
        Ok(Rendered { summary, motion, thumbnails, plane })
    }

    /// Fits the flow and writes `tracks.npy`, `flux.npy` and `fields.npz` into the folder `out`.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; input and output; cancelled.
    pub fn fit(
        &mut self,
        project: &Project,
        out: &Path,
        progress: &Progress,
        saved: &(dyn Fn(&Path) + Sync),
    ) -> Result<Summary> {
        let mut meter = Meter::default();
        let project = &tracks::with_guides_alone(project);
        let prepared = self.prepare(project, &mut meter, progress)?;
        if project.keys.len() < 2 {
            return Err(Error::value(
                "keys",
                "there is one key frame, so there is no flow to fit; add another",
            ));
        }
        let road = prepared.plan.stages.iter().copied();
        progress
            .set_road(road.filter(|(stage, _)| ["trace", "match", "fit", "write"].contains(stage)).collect());
        let tracer = learn(&prepared, project, &mut meter, progress)?;
        let motion = self.move_photons(project, &prepared, tracer.as_ref(), &mut meter, progress)?;
        let batch = prepared.start(project, tracer.as_ref(), 0, progress)?;
        let account =
            meter.measure("write", || tracks::write(batch, &motion, project, out, progress, saved))?;
        let done =
            Done { command: "fit", passes: 0, motion: &motion, account, bad_values: BadValues::default() };
        Ok(Summary::new(project, prepared, done, &meter))
    }

    /// The photons of pass 0 at the first two key frames between which they move, matched.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; nothing that moves; cancelled.
    pub fn first_move(&mut self, project: &Project, progress: &Progress) -> Result<FirstMove> {
        let mut meter = Meter::default();
        let prepared = self.prepare(project, &mut meter, progress)?;
        let tracer = learn(&prepared, project, &mut meter, progress)?;
        // Only these two are told of; learning where to aim is done once, whatever the number of photons.
        let mut meter = Meter::quick();
        let batch = meter.measure("trace", || prepared.start(project, tracer.as_ref(), 0, progress))?;
        motion::first_move(batch, project, prepared.extent, meter, progress)
    }

    /// What would be done and what it would cost. Opens every file the project names, and traces a few photons to see which
    /// caustics there are.
    ///
    /// # Errors
    /// The first thing that is wrong.
    pub fn check(&mut self, project: &Project) -> Result<CheckReport> {
        let mut meter = Meter::default();
        let prepared = self.prepare(project, &mut meter, &Progress::new())?;
        let progress = Progress::new();
        let tracer = learn(&prepared, project, &mut meter, &progress)?;
        CheckReport::new(project, &prepared, tracer.as_ref(), &progress)
    }

    fn prepare(&mut self, project: &Project, meter: &mut Meter, progress: &Progress) -> Result<Prepared> {
        meter.measure("load", || self.loader.prepare(project, progress))
    }

    /// What the camera sees: the receiver through every pixel, and the picture without caustics.
    fn look(
        &mut self,
        project: &Project,
        prepared: &Prepared,
        meter: &mut Meter,
        progress: &Progress,
    ) -> Result<(Arc<Visible>, Arc<Image>)> {
        let (extent, passes) = (prepared.extent, prepared.plan.passes);
        let first = first_radius(&project.render, extent);
        let radii = (first, radius_of_pass(first, passes - 1));
        let layout = layout_for(prepared.scene.as_deref(), extent, &project.render, radii);
        let scene = prepared.scene.as_ref();
        self.seen.look(project, scene, (extent, layout), background, meter, progress)
    }

    /// Matches and fits all segments.
    fn move_photons(
        &mut self,
        project: &Project,
        prepared: &Prepared,
        tracer: Option<&Tracer>,
        meter: &mut Meter,
        progress: &Progress,
    ) -> Result<Arc<Motion>> {
        let input = MotionInput::new(project, prepared.extent, prepared.plan.photons);
        self.motion.get(input, |_| {
            let batch = prepared.start(project, tracer, 0, progress)?;
            motion::fit(batch, project, prepared.extent, meter, progress).map(Arc::new)
        })
    }
}

/// Learns where the lights must aim, where photons must be traced.
fn learn<'a>(
    prepared: &'a Prepared,
    project: &Project,
    meter: &mut Meter,
    progress: &Progress,
) -> Result<Option<Tracer<'a>>> {
    let Some(scene) = prepared.scene.as_deref().filter(|_| prepared.supplies.traces()) else {
        return Ok(None);
    };
    meter.measure("trace", || Tracer::new(scene, project.seed, progress).map(Some))
}

/// Runs the passes and tells `passed` how many are complete. Returns their number and how well they kept the light.
fn render_passes(
    project: &Project,
    prepared: &Prepared,
    tracer: Option<&Tracer>,
    motion: &Motion,
    render: &ProgressiveRender,
    progress: &Progress,
    passed: &dyn Fn(usize),
) -> Result<(usize, Account)> {
    let plan = &prepared.plan;
    progress.begin("render", (plan.passes * prepared.slots.moments.len()) as u64);
    let mut exposer = Exposer::new(render);
    for pass in 0..plan.passes {
        let done = prepared
            .start(project, tracer, pass as u64, progress)
            .and_then(|batch| exposer.run(batch, &motion.segments, &prepared.slots, pass, progress));
        match done {
            Err(Error::Cancelled) if pass > 0 && !progress.is_abandoned() => {
                return Ok((pass, exposer.account));
            }
            other => other?,
        }
        passed(pass + 1);
    }
    Ok((plan.passes, exposer.account))
}
