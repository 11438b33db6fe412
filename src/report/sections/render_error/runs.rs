//! Series of passes of several sizes, and the error of their light after each pass.

use super::reference::{Display, LightError, PlanePictures, Reference, SHARPEST, light};
use crate::context::Context;
use lightloom_core::constraint::Constraint;
use lightloom_core::engine::{FittedProject, PlaneLight, PlanePasses};
use lightloom_core::export::evenly_chosen;
use lightloom_core::project::Project;
use lightloom_core::render::density::radius_of_pass;
use lightloom_core::render::{Image, ReceiverTexture, RenderSettings, TextureLayout, first_radius};
use lightloom_core::{Error, Progress, Result};

/// Time between two key frames at which the light is measured: early, since a pass goes no further.
const SHARE: f64 = 0.1;
/// Most frames of a timed pass; longer animations are extrapolated.
const TIMED: usize = 100;

/// The amount of work.
struct Budget {
    /// Photons of a pass as shares of the project's own; the last is 1.
    shares: &'static [f64],
    /// Fewest passes of the project's own size: a slope needs some.
    fewest: usize,
    /// Most photons of all passes of one size, without walls and with walls, around which a photon costs more.
    most: [usize; 2],
    /// Photons of the reference over those of the longest run, without walls and with.
    longer: [usize; 2],
    /// Width of a picture in pixels.
    width: usize,
}

const QUICK: Budget =
    Budget { shares: &[0.2, 1.0], fewest: 2, most: [200_000, 100_000], longer: [8, 2], width: 320 };
const FULL: Budget =
    Budget { shares: &[0.1, 0.3, 1.0], fewest: 4, most: [8_000_000, 4_000_000], longer: [3, 2], width: 640 };

/// The measurements of the section.
pub(super) struct Runs {
    pub(super) reference: Reference,
    /// Photons of the reference.
    pub(super) photons: usize,
    /// Photons of one pass and passes, as the project has them.
    pub(super) planned: (usize, usize),
    /// The measured frame.
    pub(super) frame: i32,
    /// Frames of the whole render.
    pub(super) frames: usize,
    /// The smallest passes first.
    pub(super) series: Vec<Series>,
}

/// Passes of one size.
pub(super) struct Series {
    /// Photons of each pass.
    pub(super) photons: usize,
    /// The kernel's radius in the first pass, plane units.
    pub(super) radius: f32,
    pub(super) rows: Vec<PassError>,
    /// The displayed light after the first pass and after the last; one picture where these are the same.
    pub(super) pictures: Vec<Image>,
}

/// The error after some passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PassError {
    pub(super) passes: usize,
    /// Seconds of as many passes through all frames, extrapolated from one.
    pub(super) seconds: f64,
    /// Measured seconds of one or two frames.
    pub(super) measured: f64,
    pub(super) rms: f64,
    pub(super) perceptual: f64,
    pub(super) flicker: Option<f64>,
}

/// The sizes of the runs.
struct Sizes {
    series: Vec<Size>,
    /// Photons of a pass of the reference, and passes of each of its halves.
    reference: (usize, usize),
    /// The kernel's in the last pass of the project's own size.
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
    fn new(fitted: &FittedProject, project: &Project, budget: &Budget) -> Self {
        let (photons, passes) = fitted.planned();
        let walled = usize::from(has_walls(project));
        let (most, longer) = (budget.most[walled], budget.longer[walled]);
        let photons = photons.min(most / budget.fewest).max(1);
        let all = (photons * passes.max(budget.fewest)).min(most);
        let series = |share: &f64| {
            let photons = ((photons as f64 * share).round() as usize).max(1);
            let settings = RenderSettings { photons: photons as u64, ..project.render.clone() };
            Size { photons, passes: all / photons, radius: first_radius(&settings, fitted.extent()) }
        };
        let series: Vec<Size> = budget.shares.iter().map(series).collect();
        let last = |size: &Size| radius_of_pass(size.radius, size.passes - 1);
        let radius = series.last().map_or(0.5, last);
        let finest = series.iter().map(last).fold(SHARPEST * radius, f32::min);
        let widest = series.iter().map(|size| size.radius).fold(0.0, f32::max);
        let frame = fitted.frame_at(SHARE);
        let frames = if frame < fitted.frame_at(1.0) { vec![frame, frame + 1] } else { vec![frame] };
        let reference = (photons, (longer * all).div_ceil(2 * photons));
        Self { series, reference, radius, layout: fitted.layout((widest, finest)), frames }
    }

    /// Photons of all runs.
    fn photons(&self) -> usize {
        let (photons, passes) = self.reference;
        // The pass that is timed counts as one more.
        self.series.iter().map(|size| size.photons * (size.passes + 1)).sum::<usize>() + 2 * photons * passes
    }
}

/// Runs everything.
///
/// # Errors
/// Anything wrong with the project or its files; no light on the receiver; cancelled.
pub(super) fn run(context: &mut Context, progress: &Progress) -> Result<Runs> {
    let fitted = context.engine.fitted(&context.project, &progress.inner())?;
    let project = &context.project;
    let budget = context.effort.pick(QUICK, FULL);
    let sizes = Sizes::new(&fitted, project, &budget);
    progress.begin("render", sizes.photons() as u64);
    let runner = Runner { fitted: &fitted, project, sizes: &sizes, scratch: context.scratch, progress };
    let halves = [runner.half(1)?, runner.half(2)?];
    let display = Display { view: project.render.view.view(), width: budget.width };
    let Some(reference) = Reference::new([&halves[0], &halves[1]], sizes.radius, &fitted, &display) else {
        return Err(Error::value("keys", "no light falls on the receiver, so there is none to measure"));
    };
    drop(halves);
    let mut series = Vec::new();
    for &size in &sizes.series {
        series.push(runner.series(&reference, size)?);
    }
    let planned = fitted.planned();
    Ok(Runs {
        reference,
        photons: 2 * sizes.reference.0 * sizes.reference.1,
        planned,
        frame: sizes.frames[0],
        frames: fitted.frames().count(),
        series,
    })
}

fn has_walls(project: &Project) -> bool {
    let is_wall = |c: &Constraint| c.is_enabled() && matches!(c, Constraint::Wall(_));
    project.fits() && project.constraints.iter().any(is_wall)
}

/// The input that all runs share.
struct Runner<'a> {
    fitted: &'a FittedProject,
    project: &'a Project,
    sizes: &'a Sizes,
    scratch: &'a std::path::Path,
    progress: &'a Progress,
}

impl Runner<'_> {
    fn take(&self, photons: usize, passes: usize) -> PlanePasses {
        PlanePasses {
            photons,
            passes,
            seed: self.project.seed,
            radius: 0.0,
            shrinks: false,
            layout: self.sizes.layout,
            frames: self.sizes.frames.clone(),
        }
    }

    fn run(&self, take: &PlanePasses, mut passed: impl FnMut(&PlaneLight) -> Result<()>) -> Result<()> {
        self.fitted.run(take, self.scratch, &self.progress.inner(), &mut |reached| {
            self.progress.advance(take.photons as u64);
            passed(reached)
        })
    }

    /// The unfiltered light of one half of the reference, with a seed of its own.
    fn half(&self, number: u64) -> Result<Vec<ReceiverTexture>> {
        let (photons, passes) = self.sizes.reference;
        let seed = self.project.seed.wrapping_add(number);
        let take = PlanePasses { seed, ..self.take(photons, passes) };
        let mut seen = None;
        self.run(&take, |passed| {
            if passed.passes == passes {
                seen = Some(light(passed, take.frames.len())?);
            }
            Ok(())
        })?;
        seen.ok_or(Error::Cancelled)
    }

    /// Seconds of a pass of this size through all frames.
    fn pace(&self, Size { photons, radius, .. }: Size) -> Result<f64> {
        let all: Vec<i32> = self.fitted.frames().collect();
        let frames = evenly_chosen(&all, TIMED);
        let share = frames.len() as f64 / all.len() as f64;
        let mut seconds = 0.0;
        self.run(&PlanePasses { radius, frames, ..self.take(photons, 1) }, |passed| {
            seconds = passed.seconds / share;
            Ok(())
        })?;
        Ok(seconds)
    }

    /// The passes of one size, measured after 1, 2, 4, ... of them and after the last. They end where their kernel gets finer
    /// than that of the reference: a sharper picture would count as an error.
    fn series(&self, reference: &Reference, size: Size) -> Result<Series> {
        let Size { photons, passes, radius } = size;
        // Rounding must not part a kernel from its equal.
        let is_resolved = |passes: &usize| radius_of_pass(radius, passes - 1) > 0.999 * reference.radius;
        let passes = (1..=passes).take_while(is_resolved).last().unwrap_or(1);
        let take = PlanePasses { radius, shrinks: true, ..self.take(photons, passes) };
        let pace = self.pace(size)?;
        let (mut rows, mut pictures) = (Vec::new(), Vec::new());
        self.run(&take, |passed| {
            if !passed.passes.is_power_of_two() && passed.passes < passes {
                return Ok(());
            }
            let LightError { rms, perceptual, flicker, picture } =
                reference.distance(&PlanePictures::of(passed, take.frames.len(), self.fitted)?);
            rows.push(PassError {
                passes: passed.passes,
                seconds: pace * passed.passes as f64,
                measured: passed.seconds,
                rms,
                perceptual,
                flicker,
            });
            pictures.truncate(1);
            pictures.push(picture);
            Ok(())
        })?;
        Ok(Series { photons, radius, rows, pictures })
    }
}
