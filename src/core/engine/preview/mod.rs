//! The live preview: a project's photons at every frame, at once in coarse strokes, then finer.
//!
//! The same stages as a render, cut finer: each remembers its result and is redone only when what it was made from
//! changes. A new gamma fits anew but neither traces nor matches; a new brightness changes flux alone; a key that is
//! moved in time leaves the fields as they are; a light that is moved leaves the meshes as they are.

mod detail;
mod exposure;
mod field;
mod growing;
mod level;
mod outcome;
mod shot;

use std::sync::Arc;

use crate::photon::{Lesson, Tracer};
use crate::engine::grouping::notes_on_dark;
use crate::engine::light::KeyPhotons;
use crate::engine::loader::{Loader, Prepared};
use crate::engine::meter::Meter;
use crate::engine::stage::{Same, Stage};
use crate::engine::summary::{FlowNumbers, note_on_walls};
use crate::engine::supply::Supplies;
use crate::project::{AssetFolder, OutputSettings, Project};
use crate::scene::{Geometry, LightDesc, ReceiverDesc, Scene};
use crate::{Progress, Result};
use growing::Growing;
use level::{Fitted, Job, Level, Walk};
use outcome::{Course, Stop};
use shot::Views;

pub use detail::Detail;
pub use exposure::Exposure;
pub(crate) use exposure::covered;
pub use field::FieldAt;
pub use outcome::Sketch;
pub use shot::{Look, Shot};

/// Sketches a project again and again while it is edited, with what it remembers from edit to edit.
pub struct Sketcher {
    loader: Loader,
    lesson: Stage<LessonInput, Arc<Lesson>>,
    /// By [`Detail`].
    levels: [Level; 3],
    views: Views,
}

/// What must stay for lights to shine to where they did.
#[derive(PartialEq)]
struct LessonInput {
    geometry: Same<Geometry>,
    lights: Vec<LightDesc>,
    receiver: ReceiverDesc,
    seed: u64,
}

impl Sketcher {
    /// Has seen no project yet and finds files through `assets`.
    pub fn new(assets: AssetFolder) -> Self {
        Self {
            loader: Loader::new(assets),
            lesson: Stage::default(),
            levels: Default::default(),
            views: Views::default(),
        }
    }

    /// The photons of all frames. `ready` is shown the sketch as it grows: first the keys, then frame after frame, those
    /// of the segment around the frame `first` before the others. The same project gives the same photons, whatever was
    /// sketched before, for any number of threads.
    ///
    /// # Errors
    /// As a render of the project, with the same words; more frames than one run may have; cancelled.
    pub fn sketch(
        &mut self,
        project: &Project,
        detail: Detail,
        first: i32,
        progress: &Progress,
        ready: &mut dyn FnMut(&Arc<Sketch>),
    ) -> Result<Arc<Sketch>> {
        project.check()?;
        let mut meter = Meter::quick();
        let all_frames = OutputSettings { frames: None, ..project.output.clone() };
        let whole = &Project { output: all_frames, ..project.clone() };
        let prepared = meter.measure("load", || self.loader.prepare(whole, progress))?;
        let source = self.source(whole, &prepared, &mut meter, progress)?;
        match detail {
            Detail::Draft | Detail::Preview => {
                let level = &mut self.levels[detail as usize];
                let run = Run { whole, prepared: &prepared, detail, source, progress };
                run.fitted(level, first, &mut meter, ready)
            }
            Detail::Fine => {
                let [_, preview, fine] = &mut self.levels;
                let run = Run { whole, prepared: &prepared, detail, source, progress };
                run.carried([preview, fine], first, &mut meter, ready)
            }
        }
    }

    /// The scene, and where its lights must shine, where photons must be traced.
    fn source(
        &mut self,
        project: &Project,
        prepared: &Prepared,
        meter: &mut Meter,
        progress: &Progress,
    ) -> Result<Option<(Arc<Scene>, Arc<Lesson>)>> {
        let scene = prepared.scene.clone().filter(|_| prepared.supplies.traces());
        let (Some(scene), Some(desc)) = (scene, &project.scene) else { return Ok(None) };
        let input = LessonInput {
            geometry: Same::of(scene.geometry()),
            lights: desc.lights.clone(),
            receiver: desc.receiver.clone(),
            seed: project.seed,
        };
        let lesson = self.lesson.get(input, |_| {
            let learn = || Tracer::new(&scene, project.seed, progress).map(|tracer| tracer.lesson().clone());
            meter.measure("trace", learn).map(Arc::new)
        })?;
        Ok(Some((scene, lesson)))
    }
}

/// One sketch of a project.
struct Run<'a> {
    whole: &'a Project,
    prepared: &'a Prepared,
    detail: Detail,
    source: Option<(Arc<Scene>, Arc<Lesson>)>,
    progress: &'a Progress,
}

/// A project at one detail.
struct Sized {
    project: Project,
    supplies: Supplies,
    photons: usize,
    note: Option<String>,
}

impl Run<'_> {
    fn sized(&self, detail: Detail) -> Result<Sized> {
        let Self { whole, prepared, .. } = self;
        let (most, note) = detail.photons_for(whole, prepared.plan.frames);
        let (supplies, photons) = prepared.supplies.thinned(whole.matching, most)?;
        Ok(Sized { project: detail.apply(whole, photons), supplies, photons, note })
    }

    fn job<'a>(&'a self, sized: &'a Sized) -> Job<'a> {
        Job {
            project: &sized.project,
            extent: self.prepared.extent,
            supplies: &sized.supplies,
            source: self.source.clone(),
            count: sized.photons,
            anchors: self.detail.anchors(),
            progress: self.progress,
        }
    }

    /// Matches and fits; the frames fall out of the fits.
    fn fitted(
        &self,
        level: &mut Level,
        first: i32,
        meter: &mut Meter,
        ready: &mut dyn FnMut(&Arc<Sketch>),
    ) -> Result<Arc<Sketch>> {
        let sized = self.sized(self.detail)?;
        let job = self.job(&sized);
        let walk = level.walk(&job, None, meter)?;
        let mut growing = Growing::new(self.course(&sized, &walk), first, ready);
        let mut fitted = Vec::new();
        for number in outward(growing.first_segment(), self.whole.keys.len() - 1) {
            fitted.push(level.fit(&job, &walk, number, Some(&mut growing), meter)?);
        }
        Ok(self.finish(growing, &fitted, &sized, meter))
    }

    /// Pairs photons of its own as those of `guide` are, and carries them along the fields of those.
    fn carried(
        &self,
        [guide, level]: [&mut Level; 2],
        first: i32,
        meter: &mut Meter,
        ready: &mut dyn FnMut(&Arc<Sketch>),
    ) -> Result<Arc<Sketch>> {
        let (before, sized) = (self.sized(Detail::Preview)?, self.sized(self.detail)?);
        let (guides, job) = (self.job(&before), self.job(&sized));
        let led = guide.walk(&guides, None, meter)?;
        let walk = level.walk(&job, Some(&led), meter)?;
        let mut growing = Growing::new(self.course(&sized, &walk), first, ready);
        let mut fitted = Vec::new();
        for number in outward(growing.first_segment(), self.whole.keys.len() - 1) {
            let fit = guide.fit(&guides, &led, number, None, meter)?;
            level.carry(&job, &walk, number, (&fit, None), &mut growing, meter)?;
            fitted.push(fit);
        }
        Ok(self.finish(growing, &fitted, &sized, meter))
    }

    fn course(&self, sized: &Sized, walk: &Walk) -> Course {
        let Prepared { extent, slots, plan, .. } = self.prepared;
        let grouping = sized.supplies.grouping();
        let mut end = 0;
        let group = |(group, at): (usize, &KeyPhotons)| {
            let start = end;
            end += at.positions.len();
            (grouping.name(group).map(str::to_owned), start..end)
        };
        let stops: Vec<Stop> =
            walk.stops.iter().zip(&walk.asked).map(|(at, asked)| Stop::new(at, *asked)).collect();
        let covered = stops.iter().map(|stop| covered(&stop.positions, *extent)).sum::<f32>();
        Course {
            covered: covered / stops.len() as f32,
            detail: self.detail,
            extent: *extent,
            first: self.whole.keys[0].frame,
            moments: slots.frames.iter().map(|&(_, slot)| slots.moments[slot]).collect(),
            stops,
            groups: walk.stops[0].iter().enumerate().map(group).collect(),
            caustics: walk.caustics.clone(),
            left_out: plan.left_out.clone(),
            rho: self.whole.flow.rho.into(),
        }
    }

    fn finish(&self, growing: Growing, fitted: &[Arc<Fitted>], sized: &Sized, meter: &Meter) -> Arc<Sketch> {
        let mut sketch = growing.finish();
        let numbers = fitted.iter().flat_map(|f| FlowNumbers::of_segment(f.reports.clone(), &f.segment.cost));
        sketch.numbers = numbers.reduce(FlowNumbers::worst);
        let flux_ratio = sketch.flux_ratio();
        sketch.numbers.iter_mut().for_each(|numbers| numbers.flux_ratio = flux_ratio);
        sketch.stages = meter.costs().to_vec();
        sketch.notes = self.prepared.notes.clone();
        sketch.notes.extend(sized.note.clone());
        sketch.notes.extend(notes_on_dark(sketch.caustics()));
        sketch.notes.extend(sketch.numbers.iter().filter_map(|numbers| note_on_walls(&numbers.flow)));
        Arc::new(sketch)
    }
}

/// The numbers 0..count, those near `first` before the others.
fn outward(first: usize, count: usize) -> Vec<usize> {
    let mut numbers: Vec<usize> = (0..count).collect();
    numbers.sort_by_key(|number| number.abs_diff(first));
    numbers
}
