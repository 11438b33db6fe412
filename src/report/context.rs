//! The project that is measured, and the results that several sections share.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use crate::effort::Effort;
use crate::machine::Machine;
use lightloom_core::engine::{Engine, MovingSegment, Quality, Summary};
use lightloom_core::flow::{Fields, FlowSettings, MotionMethod, Segment, fit_segment};
use lightloom_core::project::Project;
use lightloom_core::{Error, Progress, Result};

/// A project under measurement.
pub(crate) struct Context<'a> {
    pub(crate) engine: &'a Engine,
    /// The project as it is measured: at preview size when quick.
    pub(crate) project: Project,
    pub(crate) effort: Effort,
    /// A folder with room for the frames of a render.
    pub(crate) scratch: &'a Path,
    moving_segment: Option<Arc<MovingSegment>>,
    /// The photons that were asked for last, with their number.
    photons: Option<(usize, Arc<MovingSegment>)>,
    fields: Option<Arc<Fields>>,
    machine: Option<Machine>,
    bare_rays: Option<Option<f64>>,
    /// By stage and size; none where the project does not have the stage.
    samples: HashMap<(&'static str, usize), Option<Sample>>,
}

/// One stage, run at one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    /// Photons, unknowns, texels, passes, walls or threads.
    pub(crate) size: f64,
    /// Wall-clock seconds.
    pub(crate) seconds: f64,
    /// Peak memory in MiB, where it is of interest.
    pub(crate) memory: Option<f64>,
    pub(crate) limit: Option<Limit>,
}

/// The machine's limit for the work of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limit {
    /// Items of work: photons, iterations, texels.
    pub(crate) items: f64,
    /// The least seconds that they take.
    pub(crate) seconds: f64,
    /// The resource that limits them.
    pub(crate) by: &'static str,
}

impl Sample {
    /// A sample without memory and limit.
    pub(crate) fn new(size: usize, seconds: f64) -> Self {
        Self { size: size as f64, seconds, memory: None, limit: None }
    }
}

impl<'a> Context<'a> {
    /// Checks the project and all its files.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; cancelled.
    pub(crate) fn new(
        engine: &'a Engine,
        project: &Project,
        effort: Effort,
        scratch: &'a Path,
        progress: &Progress,
    ) -> Result<Self> {
        progress.check()?;
        engine.check(project)?;
        let project = effort.pick(Quality::Preview, Quality::Final).apply(project);
        Ok(Self {
            engine,
            project,
            effort,
            scratch,
            moving_segment: None,
            photons: None,
            fields: None,
            machine: None,
            bare_rays: None,
            samples: HashMap::new(),
        })
    }

    /// Renders a project into a temporary folder, with an engine that remembers nothing.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; input and output; cancelled.
    pub(crate) fn render(&self, project: &Project, progress: &Progress) -> Result<Summary> {
        let folder =
            tempfile::tempdir_in(self.scratch).map_err(Error::io("make a folder in", self.scratch))?;
        self.engine.afresh().render(project, folder.path(), &progress.inner(), &|_| {})
    }

    /// The photons of the first pass at the first key frames between which they move, matched. Traced and matched once.
    ///
    /// # Errors
    /// Nothing that moves; cancelled.
    pub(crate) fn moving_segment(&mut self, progress: &Progress) -> Result<Arc<MovingSegment>> {
        if self.moving_segment.is_none() {
            self.moving_segment =
                Some(Arc::new(self.engine.moving_segment(&self.project, None, &progress.inner())?));
        }
        self.moving_segment.clone().ok_or(Error::Cancelled)
    }

    /// As [`Self::moving_segment`], with `count` photons in a pass. Traced and matched once for any number of calls in a row
    /// with the same count.
    ///
    /// # Errors
    /// As [`Self::moving_segment`].
    pub(crate) fn photons(&mut self, count: usize, progress: &Progress) -> Result<Arc<MovingSegment>> {
        if count as u64 == self.project.render.photons {
            return self.moving_segment(progress);
        }
        if let Some((_, known)) = self.photons.as_ref().filter(|(known, _)| *known == count) {
            return Ok(known.clone());
        }
        self.photons = None;
        let mut project = self.project.clone();
        project.render.photons = count as u64;
        let made = Arc::new(self.engine.moving_segment(&project, Some(count), &progress.inner())?);
        self.photons = Some((count, made.clone()));
        Ok(made)
    }

    /// As [`Self::photons`], matched for the flow whatever the project's method.
    ///
    /// # Errors
    /// As [`Self::moving_segment`].
    pub(crate) fn flow_photons(&mut self, count: usize, progress: &Progress) -> Result<Arc<MovingSegment>> {
        if self.project.method == MotionMethod::Guided {
            return self.photons(count, progress);
        }
        let mut project = Project { method: MotionMethod::Guided, ..self.project.clone() };
        project.render.photons = count as u64;
        Ok(Arc::new(self.engine.moving_segment(&project, Some(count), &progress.inner())?))
    }

    /// Ten steps of the project's flow without its walls, lines and turbulence. Fitted once.
    ///
    /// # Errors
    /// Nothing that moves; a fit that fails; cancelled.
    pub(crate) fn ten_steps(&mut self, progress: &Progress) -> Result<Arc<Fields>> {
        if let Some(known) = &self.fields {
            return Ok(known.clone());
        }
        let photons = self.moving_segment(progress)?;
        let settings = FlowSettings { steps: 10, turbulence: None, ..self.project.flow.clone() };
        let segment = Segment { lines: &[], walls: &[], ..photons.segment(&settings) };
        let (fields, _) = fit_segment(&segment, &progress.inner())?;
        Ok(self.fields.insert(Arc::new(fields)).clone())
    }

    /// The limits of this machine. Measured once.
    pub(crate) fn machine(&mut self) -> Machine {
        *self.machine.get_or_insert_with(Machine::measure)
    }

    /// Rays per second of the bare triangle hierarchy; none without a scene. Measured once.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; cancelled.
    pub(crate) fn bare_rays_per_second(&mut self, progress: &Progress) -> Result<Option<f64>> {
        if self.bare_rays.is_none() {
            self.bare_rays = Some(self.engine.bare_rays_per_second(&self.project, &progress.inner())?);
        }
        Ok(self.bare_rays.flatten())
    }

    /// The sample of a stage at a size; `run` takes it if it is not known yet.
    ///
    /// # Errors
    /// As `run`.
    pub(crate) fn sample(
        &mut self,
        stage: (&'static str, usize),
        run: impl FnOnce(&mut Self) -> Result<Option<Sample>>,
    ) -> Result<Option<Sample>> {
        if let Some(known) = self.samples.get(&stage) {
            return Ok(*known);
        }
        let sample = run(self)?;
        self.samples.insert(stage, sample);
        Ok(sample)
    }
}
