//! Passes without camera and files: the light of a few frames on the plane, pass by pass, for those who measure it.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use glam::Vec2;

use super::batch::Batch;
use super::loader::Prepared;
use super::meter::Meter;
use super::motion::{Motion, Segment};
use super::passes::Exposer;
use super::slots::Slots;
use super::{Pipeline, learn};
use crate::project::Project;
use crate::render::{Paper, ProgressiveRender, ReceiverTexture, TextureLayout, layout_for};
use crate::{Progress, Result};

/// A project whose flow is fitted, ready for passes of any size.
pub(crate) struct Rehearsal {
    project: Project,
    prepared: Prepared,
    motion: Arc<Motion>,
}

/// Some passes, and what they show.
pub(crate) struct Take {
    /// Photons of each pass.
    pub(crate) photons: usize,
    /// How many passes.
    pub(crate) passes: usize,
    /// Of the random numbers; the flow stays as it was fitted.
    pub(crate) seed: u64,
    /// The kernel's radius in the first pass, plane units.
    pub(crate) radius: f32,
    /// Whether the kernel shrinks from pass to pass, as in a render.
    pub(crate) shrinks: bool,
    /// The texture that gathers the light.
    pub(crate) layout: TextureLayout,
    /// Which frames; the photons go no further than to the last of them.
    pub(crate) frames: Vec<i32>,
}

/// A take after some of its passes.
pub(crate) struct Passed<'a> {
    /// How many.
    pub(crate) passes: usize,
    /// Seconds of all passes so far.
    pub(crate) seconds: f64,
    render: &'a ProgressiveRender,
    slots: &'a Slots,
}

impl Passed<'_> {
    /// The light of frame number `index` of the take, the mean of the passes so far, watts per texel.
    pub(crate) fn light(&self, index: usize) -> Result<ReceiverTexture> {
        let (_, slot) = self.slots.frames[index];
        self.render.mean(slot).map(|(texture, _)| texture)
    }
}

impl Pipeline {
    /// Traces, matches and fits as a render does, and looks through no camera.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; cancelled.
    pub(crate) fn rehearse(&mut self, project: &Project, progress: &Progress) -> Result<Rehearsal> {
        let mut meter = Meter::quick();
        let prepared = self.prepare(project, &mut meter, progress)?;
        prepared.plan.require_memory()?;
        let tracer = learn(&prepared, project, &mut meter, progress)?;
        let motion = self.move_photons(project, &prepared, tracer.as_ref(), &mut meter, progress)?;
        drop(tracer);
        Ok(Rehearsal { project: project.clone(), prepared, motion })
    }
}

impl Rehearsal {
    /// Size of the plane; its longer side is 1.
    pub(crate) fn extent(&self) -> Vec2 {
        self.prepared.extent
    }

    /// Photons of one pass and passes, as the project has them.
    pub(crate) fn planned(&self) -> (usize, usize) {
        (self.prepared.plan.photons, self.prepared.plan.passes)
    }

    /// The frames of a render of the project.
    pub(crate) fn frames(&self) -> impl Iterator<Item = i32> {
        self.prepared.slots.frames.iter().map(|(frame, _)| *frame)
    }

    /// The frame at this share of the way between the first two keys between which light moves; the only one where none
    /// does.
    pub(crate) fn frame_at(&self, share: f64) -> i32 {
        let moves = |segment: &Segment| !segment.layers.is_empty();
        let first = self.motion.segments.iter().position(moves).unwrap_or(0);
        let keys = &self.project.keys;
        let [from, to] = [first, first + 1].map(|key| keys[key.min(keys.len() - 1)].frame);
        from + (share * f64::from(to - from)).round() as i32
    }

    /// What light on the plane looks like.
    pub(crate) fn paper(&self) -> Paper {
        self.prepared.scene.as_ref().map_or(Paper::WHITE, |scene| Paper::of(scene.receiver()))
    }

    /// The texture of a render whose kernel has the first of these radii at first and the second in the end, plane units.
    pub(crate) fn layout(&self, radii: (f32, f32)) -> TextureLayout {
        layout_for(self.prepared.scene.as_deref(), self.extent(), &self.project.render, radii)
    }

    /// Runs the passes of a take; `passed` is shown the light after each. The scratch file of the light lies in `scratch`.
    ///
    /// # Errors
    /// Photons that are not finite; input and output; cancelled.
    pub(crate) fn run(
        &self,
        take: &Take,
        scratch: &Path,
        progress: &Progress,
        passed: &mut dyn FnMut(&Passed) -> Result<()>,
    ) -> Result<()> {
        let Self { project, prepared, motion } = self;
        let project = &Project { seed: take.seed, ..project.clone() };
        let (extent, supplies) = (prepared.extent, prepared.supplies.with_seed(take.seed));
        let slots = Slots::new(&project.keys, &take.frames);
        let render = ProgressiveRender::new(take.layout, take.radius, slots.moments.len(), scratch)?;
        let tracer = learn(prepared, project, &mut Meter::quick(), progress)?;
        // Beyond the last frame asked for nothing is seen.
        let needed = slots.moments.last().map_or(0, |moment| moment.segment + 1);
        let segments = &motion.segments[..needed.min(motion.segments.len())];
        let mut exposer = Exposer::new(&render);
        let mut seconds = 0.0;
        for pass in 0..take.passes {
            let start = Instant::now();
            let light = supplies.light(tracer.as_ref(), pass as u64, take.photons, &progress.inner())?;
            let batch = Batch::start(&supplies, light, pass as u64, project, extent);
            exposer.run(batch, segments, &slots, if take.shrinks { pass } else { 0 }, &progress.inner())?;
            seconds += start.elapsed().as_secs_f64();
            passed(&Passed { passes: pass + 1, seconds, render: &render, slots: &slots })?;
            progress.advance(1);
            progress.check()?;
        }
        Ok(())
    }
}
