//! A project whose flow is fitted: passes of any size can be run with it.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use glam::Vec2;

use super::Engine;
use super::energy_balance::EnergyBalance;
use super::fitted_segment::{FittedFlow, FittedSegment};
use super::flow;
use super::flow_bake::BakedFlow;
use super::frame_times::FrameTimes;
use super::job::Job;
use super::meter::Meter;
use super::passes::Exposures;
use super::prepare::Prepared;
use crate::project::Project;
use crate::render::{PlaneMaterial, ProgressiveRender, ReceiverTexture, TextureLayout, layout_for};
use crate::{Error, Progress, Result};

/// A project whose flow is fitted.
pub struct FittedProject {
    pub(super) engine: Engine,
    pub(super) prepared: Prepared,
    pub(super) flow: FittedFlow,
}

/// Passes over some frames, without a camera.
pub struct PlanePasses {
    /// Photons of each pass.
    pub photons: usize,
    /// Number of passes.
    pub passes: usize,
    /// Seed of the random numbers; the flow stays as it was fitted.
    pub seed: u64,
    /// Radius of the kernel in the first pass, plane units.
    pub radius: f32,
    /// Whether the kernel shrinks from pass to pass, as in a render.
    pub shrinks: bool,
    /// Layout of the texture that gathers the light.
    pub layout: TextureLayout,
    /// Frames; the photons go no further than to the last of them.
    pub frames: Vec<i32>,
}

/// The light on the plane after some passes.
pub struct PlaneLight<'a> {
    /// Number of passes so far.
    pub passes: usize,
    /// Seconds of all passes so far.
    pub seconds: f64,
    render: &'a ProgressiveRender,
    times: &'a FrameTimes,
}

impl PlaneLight<'_> {
    /// The light of frame number `index` of the passes, their mean so far, watts per texel.
    ///
    /// # Errors
    /// The scratch file cannot be read.
    pub fn texture(&self, index: usize) -> Result<ReceiverTexture> {
        let (_, slot) = self.times.frames[index];
        self.render.mean(slot).map(|(texture, _)| texture)
    }
}

impl Engine {
    /// Traces, matches and fits as a render does.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; cancelled.
    pub fn fitted(&self, project: &Project, progress: &Progress) -> Result<FittedProject> {
        let meter = Meter::quick();
        let prepared = self.prepare(project, &meter, progress)?;
        prepared.plan.require_memory()?;
        self.fit_prepared(prepared, &meter, progress)
    }

    /// Fits the flow of a prepared project.
    pub(super) fn fit_prepared(
        &self,
        prepared: Prepared,
        meter: &Meter,
        progress: &Progress,
    ) -> Result<FittedProject> {
        let job = self.job(&prepared, meter, progress)?;
        let bake = prepared.bake.as_deref();
        let flow = match bake.map_or(Ok(None), |bake| bake.read::<BakedFlow>("flow"))? {
            Some(baked) => baked.into(),
            None => {
                let flow = flow::fit(&job)?;
                bake.map_or(Ok(()), |bake| bake.keep("flow", &BakedFlow::from(&flow)))?;
                flow
            }
        };
        Ok(FittedProject { engine: self.clone(), prepared, flow })
    }
}

impl FittedProject {
    /// Size of the plane; its longer side is 1.
    pub fn extent(&self) -> Vec2 {
        self.prepared.extent
    }

    /// Photons of one pass and number of passes, as the project has them.
    pub fn planned(&self) -> (usize, usize) {
        (self.prepared.plan.photons, self.prepared.plan.passes)
    }

    /// The frames of a render of the project.
    pub fn frames(&self) -> impl Iterator<Item = i32> {
        self.prepared.times.frames.iter().map(|(frame, _)| *frame)
    }

    /// The frame at this share of the first segment in which light moves; the only one where none does.
    pub fn frame_at(&self, share: f64) -> i32 {
        let moves = |segment: &Arc<FittedSegment>| !segment.layers.is_empty();
        let first = self.flow.segments.iter().position(moves).unwrap_or(0);
        let keys = &self.prepared.project.keys;
        let [from, to] = [first, first + 1].map(|key| keys[key.min(keys.len() - 1)].frame);
        from + (share * f64::from(to - from)).round() as i32
    }

    /// The look of light on the plane.
    pub fn plane_material(&self) -> PlaneMaterial {
        self.prepared.plane_material()
    }

    /// The texture of a render whose kernel has the first of these radii at first and the second in the end, plane units.
    pub fn layout(&self, radii: (f32, f32)) -> TextureLayout {
        layout_for(self.prepared.scene.as_deref(), self.extent(), &self.prepared.project.render, radii)
    }

    /// Runs passes over some frames; `passed` gets the light after each. The scratch file of the light lies in `scratch`.
    ///
    /// # Errors
    /// Photons that are not finite; input and output; cancelled.
    pub fn run(
        &self,
        plane: &PlanePasses,
        scratch: &Path,
        progress: &Progress,
        passed: &mut dyn FnMut(&PlaneLight) -> Result<()>,
    ) -> Result<()> {
        let prepared = self.prepared.reseeded(plane.seed, plane.photons);
        let (meter, inner) = (Meter::quick(), progress.inner());
        let job = Job { remembers: false, ..self.engine.job(&prepared, &meter, &inner)? };
        let times = FrameTimes::new(&prepared.project.keys, &plane.frames);
        let render = ProgressiveRender::new(plane.layout, plane.radius, times.moments.len(), scratch)?;
        // Beyond the last frame nothing is seen.
        let needed = times.moments.last().map_or(0, |moment| moment.segment + 1);
        let segments = &self.flow.segments[..needed.min(self.flow.segments.len())];
        let mut exposures = Exposures::new(&render, 1);
        let mut seconds = 0.0;
        for pass in 0..plane.passes {
            let start = Instant::now();
            let kernel = if plane.shrinks { pass } else { 0 };
            exposures.run(&job, segments, &times, (pass, kernel), &inner)?;
            seconds += start.elapsed().as_secs_f64();
            passed(&PlaneLight { passes: pass + 1, seconds, render: &render, times: &times })?;
            progress.advance(1);
            progress.check()?;
        }
        Ok(())
    }

    /// Runs the passes of a render that are not yet in all its frames, and tells `passed` how many are complete. Returns their
    /// number, and how well they kept the light. Once the first is complete, a cancelled run keeps what is there.
    pub(super) fn render_passes(
        &self,
        render: &ProgressiveRender,
        progress: &Progress,
        passed: &dyn Fn(usize),
    ) -> Result<(usize, EnergyBalance)> {
        let Self { engine, prepared, flow } = self;
        let (plan, times) = (&prepared.plan, &prepared.times);
        progress.begin("render", (plan.passes * times.moments.len()) as u64);
        let (meter, inner) = (Meter::quick(), progress.inner());
        let job = engine.job(prepared, &meter, &inner)?;
        let mut exposures = Exposures::new(render, prepared.textures());
        let before = render.least_passes().min(plan.passes);
        progress.advance((before * times.moments.len()) as u64);
        for pass in before..plan.passes {
            match exposures.run(&job, &flow.segments, times, (pass, pass), progress) {
                Err(Error::Cancelled) if render.least_passes() > 0 && !progress.is_abandoned() => break,
                other => other?,
            }
            passed(pass + 1);
        }
        Ok((render.least_passes(), exposures.balance))
    }
}
