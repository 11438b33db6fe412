//! Passes of several sizes, and how far their light is from the reference after each.

use super::reference::{Distance, Reference, Seen, Shown};
use crate::pipeline::{Passed, Rehearsal, Take};
use crate::project::Project;
use crate::render::density::radius_of_pass;
use crate::render::{Image, RenderSettings, TextureLayout, first_radius};
use crate::report::workbench::Workbench;
use crate::{Error, Progress, Result};

/// Photons of a pass as shares of the project's own.
const SHARES: [f64; 3] = [0.1, 0.3, 1.0];
/// Fewest passes of the project's own size that are looked at: a slope needs some.
const FEWEST: usize = 4;
/// Photons of all passes of one size at most, quick and full.
const MOST: [usize; 2] = [200_000, 8_000_000];
/// Photons of the reference over those of the longest run.
const LONGER: usize = 4;

/// All that was measured.
pub(super) struct Runs {
    pub(super) reference: Reference,
    /// Photons of the reference.
    pub(super) photons: usize,
    /// Its kernel's radius, plane units.
    pub(super) radius: f32,
    /// Photons of one pass and passes, as the project has them.
    pub(super) planned: (usize, usize),
    /// The frame that was looked at.
    pub(super) frame: i32,
    /// Frames of the whole render.
    pub(super) frames: usize,
    /// The smallest passes first.
    pub(super) splits: Vec<Split>,
}

/// Passes of one size.
pub(super) struct Split {
    /// Photons of each.
    pub(super) photons: usize,
    pub(super) rows: Vec<Reached>,
    /// The light after the first pass and after the last, as it is shown; one picture where these are one.
    pub(super) pictures: Vec<Image>,
}

/// What some passes reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reached {
    pub(super) passes: usize,
    /// Seconds of the passes of a render of all frames, by the pace of these.
    pub(super) seconds: f64,
    /// Seconds measured, of one or two frames.
    pub(super) measured: f64,
    pub(super) rms: f64,
    pub(super) perceptual: f64,
    pub(super) flicker: Option<f64>,
}

/// The sizes of the runs.
struct Sizes {
    splits: Vec<Size>,
    /// Photons of a pass of the reference, and passes of each of its halves.
    reference: (usize, usize),
    /// Last radius of all.
    radius: f32,
    layout: TextureLayout,
    frames: Vec<i32>,
}

/// Passes of one size.
#[derive(Clone, Copy)]
struct Size {
    photons: usize,
    passes: usize,
    /// The kernel's in the first pass, plane units.
    radius: f32,
}

impl Sizes {
    fn new(rehearsal: &Rehearsal, settings: &RenderSettings, most: usize) -> Self {
        let (photons, passes) = rehearsal.planned();
        let photons = photons.min(most / FEWEST).max(1);
        let all = (photons * passes.max(FEWEST)).min(most);
        let split = |share: f64| {
            let photons = ((photons as f64 * share).round() as usize).max(1);
            let settings = RenderSettings { photons: photons as u64, ..settings.clone() };
            Size { photons, passes: all / photons, radius: first_radius(&settings, rehearsal.extent()) }
        };
        let splits: Vec<_> = SHARES.map(split).to_vec();
        let last = splits.iter().map(|size| radius_of_pass(size.radius, size.passes - 1));
        let radius = last.fold(f32::INFINITY, f32::min);
        let widest = splits.iter().map(|size| size.radius).fold(0.0, f32::max);
        let (middle, last) = (rehearsal.middle(), rehearsal.frames().1);
        let frames = if middle < last { vec![middle, middle + 1] } else { vec![middle] };
        let reference = (photons, (LONGER * all).div_ceil(2 * photons));
        Self { splits, reference, radius, layout: rehearsal.layout((widest, radius)), frames }
    }

    /// Photons of all runs.
    fn photons(&self) -> usize {
        let (photons, passes) = self.reference;
        self.splits.iter().map(|size| size.photons * size.passes).sum::<usize>() + 2 * photons * passes
    }
}

/// Runs everything.
///
/// # Errors
/// Anything wrong with the project or its files; no light on the receiver; cancelled.
pub(super) fn run(bench: &mut Workbench, progress: &Progress) -> Result<Runs> {
    let rehearsal = bench.pipeline.rehearse(&bench.project, &progress.inner())?;
    let project = &bench.project;
    let most = bench.pick(MOST[0], MOST[1]);
    let sizes = Sizes::new(&rehearsal, &project.render, most);
    progress.begin("render", sizes.photons() as u64);
    let desk = Desk { rehearsal: &rehearsal, project, sizes: &sizes, scratch: bench.scratch, progress };
    let halves = [desk.half(1)?, desk.half(2)?];
    let shown = Shown { view: project.render.view.view(), width: bench.pick(320, 640) };
    let Some(reference) = Reference::new([&halves[0], &halves[1]], shown) else {
        return Err(Error::value("keys", "no light falls on the receiver, so there is none to measure"));
    };
    drop(halves);
    let mut splits = Vec::new();
    let way = desk.way()?;
    for &size in &sizes.splits {
        splits.push(desk.split(&reference, size, way)?);
    }
    let planned = rehearsal.planned();
    Ok(Runs {
        reference,
        photons: 2 * sizes.reference.0 * sizes.reference.1,
        radius: sizes.radius,
        planned,
        frame: sizes.frames[0],
        frames: rehearsal.frames().0,
        splits,
    })
}

/// What the runs have in common.
struct Desk<'a> {
    rehearsal: &'a Rehearsal,
    project: &'a Project,
    sizes: &'a Sizes,
    scratch: &'a std::path::Path,
    progress: &'a Progress,
}

impl Desk<'_> {
    fn take(&self, photons: usize, passes: usize) -> Take {
        Take {
            photons,
            passes,
            seed: self.project.seed,
            radius: self.sizes.radius,
            shrinks: false,
            layout: self.sizes.layout,
            frames: self.sizes.frames.clone(),
        }
    }

    fn run(&self, take: &Take, mut passed: impl FnMut(&Passed) -> Result<()>) -> Result<()> {
        self.rehearsal.run(take, self.scratch, &self.progress.inner(), &mut |reached| {
            self.progress.advance(take.photons as u64);
            passed(reached)
        })
    }

    /// One half of the reference, by a seed of its own.
    fn half(&self, number: u64) -> Result<Seen> {
        let (photons, passes) = self.sizes.reference;
        let seed = self.project.seed.wrapping_add(number);
        let take = Take { seed, ..self.take(photons, passes) };
        let mut seen = None;
        self.run(&take, |passed| {
            if passed.passes == passes {
                seen = Some(Seen::of(passed, take.frames.len(), self.rehearsal)?);
            }
            Ok(())
        })?;
        seen.ok_or(Error::Cancelled)
    }

    /// How many times longer the photons of a pass take to the last frame than to the one that is looked at.
    fn way(&self) -> Result<f64> {
        let photons = self.sizes.splits[SHARES.len() / 2].photons;
        let carrying = |frame: i32| {
            let take = Take { frames: vec![frame], ..self.take(photons, 1) };
            let mut seconds = 0.0;
            self.rehearsal.run(&take, self.scratch, &self.progress.inner(), &mut |passed| {
                seconds = passed.carrying;
                Ok(())
            })?;
            Ok::<f64, Error>(seconds)
        };
        let [here, last] = [carrying(self.sizes.frames[0])?, carrying(self.rehearsal.frames().1)?];
        Ok((last / here.max(1e-9)).max(1.0))
    }

    /// Passes of one size, looked at after 1, 2, 4, ... of them and after the last.
    fn split(&self, reference: &Reference, size: Size, way: f64) -> Result<Split> {
        let Size { photons, passes, radius } = size;
        let take = Take { radius, shrinks: true, ..self.take(photons, passes) };
        let (seen, all) = (take.frames.len() as f64, self.rehearsal.frames().0 as f64);
        let (mut rows, mut pictures) = (Vec::new(), Vec::new());
        self.run(&take, |passed| {
            if !passed.passes.is_power_of_two() && passed.passes < passes {
                return Ok(());
            }
            let Distance { rms, perceptual, flicker, picture } =
                reference.distance(&Seen::of(passed, take.frames.len(), self.rehearsal)?);
            rows.push(Reached {
                passes: passed.passes,
                seconds: passed.carrying * way + passed.exposing / seen * all,
                measured: passed.carrying + passed.exposing,
                rms,
                perceptual,
                flicker,
            });
            pictures.truncate(1);
            pictures.push(picture);
            Ok(())
        })?;
        Ok(Split { photons, rows, pictures })
    }
}
