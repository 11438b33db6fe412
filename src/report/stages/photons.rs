//! Stages whose size is a number of photons, texels or passes, and the least work of each.

use glam::Vec3;

use crate::clock::fastest;
use crate::context::{Context, Limit, Sample};
use lightloom_core::flow::FieldTrajectories;
use lightloom_core::render::splat::Splatter;
use lightloom_core::render::{ProgressiveRender, ReceiverTexture, TextureLayout, Workspace};
use lightloom_core::{Progress, Result};

/// Seconds after which no further run begins.
const ENOUGH: f64 = 1.0;
/// Bytes of a photon's position and flux, and of a texel.
const PHOTON: f64 = 20.0;
const TEXEL: f64 = 16.0;
/// Texels along the longer side of the texture into which photons are splatted.
const TEXELS: usize = 1024;

/// The sample of work that moves so many bytes and does so many operations at least.
fn bounded(
    context: &mut Context,
    (size, seconds): (usize, f64),
    items: f64,
    (bytes, operations): (f64, f64),
) -> Option<Sample> {
    let (least, by) = context.machine().seconds(bytes, operations);
    let limit = Some(Limit { items, seconds: least, by });
    Some(Sample { limit, ..Sample::new(size, seconds) })
}

/// The rays followed, at the rate of rays through the bare hierarchy.
pub(super) fn tracing(context: &mut Context, count: usize, progress: &Progress) -> Result<Option<Sample>> {
    let Some(traced) = context.photons(count, progress)?.traced else { return Ok(None) };
    let limit = context.bare_rays_per_second(progress)?.map(|bare| Limit {
        items: traced.photons as f64,
        seconds: traced.rays as f64 / bare,
        by: "bare rays",
    });
    Ok(Some(Sample { limit, ..Sample::new(traced.photons, traced.seconds) }))
}

/// Both sets cut in half down to single points: a read and a write of both columns at each level.
pub(super) fn matching(context: &mut Context, count: usize, progress: &Progress) -> Result<Option<Sample>> {
    let photons = context.photons(count, progress)?;
    let count = photons.source.len();
    let items = count as f64;
    Ok(bounded(context, (count, photons.match_seconds), items, (items * items.log2() * 2.0 * 2.0 * 8.0, 0.0)))
}

/// Four velocities of 16 splines of two potentials each, and the photon's state, in each step.
pub(super) fn advection(context: &mut Context, count: usize, progress: &Progress) -> Result<Option<Sample>> {
    const OPERATIONS: f64 = 4.0 * (16.0 * 2.0 * 2.0 * 2.0 + 40.0);
    const BYTES: f64 = 2.0 * 36.0;
    let (fields, photons) = (context.ten_steps(progress)?, context.photons(count, progress)?);
    let carry = || {
        let mut carrier = FieldTrajectories::new(&fields, &photons.source, &photons.target);
        carrier.advance_to(fields.steps() - 1, progress)
    };
    let (_, seconds) = fastest(3, ENOUGH, carry)?;
    let count = photons.source.len();
    let steps = (fields.steps() * count) as f64;
    Ok(bounded(context, (count, seconds), steps, (steps * BYTES, steps * OPERATIONS)))
}

/// Photons read once, the texture written once.
pub(super) fn splatting(context: &mut Context, count: usize, progress: &Progress) -> Result<Option<Sample>> {
    let photons = context.photons(count, progress)?;
    let layout = TextureLayout::new(photons.extent, TEXELS, 0.0);
    let flux = vec![Vec3::ONE; photons.source.len()];
    let (mut texture, mut splatter) = (ReceiverTexture::new(layout), Splatter::default());
    let (_, seconds) = fastest(5, ENOUGH, || {
        progress.check()?;
        Ok(splatter.splat(&photons.source, &flux, &mut texture))
    })?;
    let (count, items) = (photons.source.len(), photons.source.len() as f64);
    let bytes = items * PHOTON + layout.len() as f64 * TEXEL;
    Ok(bounded(context, (count, seconds), items, (bytes, items * 4.0 * 3.0 * 2.0)))
}

/// One frame of one pass after the first: splatted, filtered, and added to the scratch file.
pub(super) fn frame_and_pass(
    context: &mut Context,
    side: usize,
    progress: &Progress,
) -> Result<Option<Sample>> {
    let photons = context.moving_segment(progress)?;
    let layout = TextureLayout::new(photons.extent, side, 0.0);
    let flux = vec![Vec3::ONE; photons.source.len()];
    let render = ProgressiveRender::new(layout, 0.006, 1, context.scratch)?;
    let mut work = Workspace::new(layout);
    let mut pass = 0;
    let (_, seconds) = fastest(6, ENOUGH, || {
        progress.check()?;
        pass += 1;
        render.add(0, pass, &photons.source, &flux, &mut work)
    })?;
    let texels = layout.len() as f64;
    let bytes = photons.source.len() as f64 * PHOTON + texels * (TEXEL + 2.0 * 32.0 + 16.0 + 24.0);
    Ok(bounded(context, (layout.len(), seconds), texels, (bytes, texels * 2.0 * 3.0 * 4.0 * 5.0)))
}

/// The passes of a render of three frames; their memory must not grow.
pub(super) fn passes(context: &mut Context, passes: usize, progress: &Progress) -> Result<Option<Sample>> {
    let mut project = context.project.clone();
    let (first, last) = (project.keys[0].frame, project.keys[project.keys.len() - 1].frame);
    project.output.frames = Some(format!("{first},{},{last}", first.midpoint(last)));
    project.render.passes = passes as u32;
    project.render.background_samples = 1;
    let summary = context.render(&project, progress)?;
    let render = summary.stages.iter().find(|stage| stage.stage == "render");
    Ok(render.map(|stage| Sample { memory: stage.peak_memory_mib, ..Sample::new(passes, stage.seconds) }))
}
