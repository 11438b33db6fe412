//! The live preview: a project's photons at every frame, coarse at once, then finer.

mod continuity;
mod field;
mod frames;
mod growing;
mod lamp;
mod light;
mod orbit;
mod positions;
mod shot;

use std::sync::Arc;

use glam::Vec2;

use super::Engine;
use super::fitted_segment::FittedSegment;
use super::flow_numbers::{FlowNumbers, note_on_walls};
use super::grouping::CausticFlux;
use super::grouping::notes_on_dark;
use super::job::Job;
use super::key_photons::KeyPhotons;
use super::meter::Meter;
use super::prepare::Prepared;
use super::quality::Quality;
use super::segment_photons::SegmentPhotons;
use super::walk::{MapsFrom, Walk};
use crate::note::About;
use crate::project::{OutputSettings, Project};
use crate::render::RenderSettings;
use crate::{Note, Progress, Result};
use frames::{KeyLight, Keys};
use growing::Growing;

pub use field::FieldAt;
pub use frames::Preview;
pub use light::{PreviewExposure, covered_area};
pub use orbit::OrbitView;
pub use shot::Shot;

impl Engine {
    /// The photons at all frames of a project, at one of [`Quality::LIVE`]. `ready` gets the preview as it grows: first the
    /// key frames, then the frame `first`, the others of its segment, and then those of the others. The same
    /// project gives the same photons, whatever was previewed before, for any number of threads.
    ///
    /// # Errors
    /// As a render of the project, with the same words; more frames than one run may have; cancelled.
    pub fn preview(
        &self,
        project: &Project,
        quality: Quality,
        first: i32,
        progress: &Progress,
        ready: &mut dyn FnMut(&Arc<Preview>),
    ) -> Result<Arc<Preview>> {
        project.check()?;
        let meter = Meter::quick();
        let output = OutputSettings { frames: None, ..project.output.clone() };
        let all_frames = Project { output, ..project.clone() };
        let whole = self.prepare(&all_frames, &meter, progress)?;
        let (sized, note) = self.at_quality(&whole, quality)?;
        let job = self.job(&sized, &meter, progress)?;
        let idle = job.tracer().map_or(Vec::new(), |tracer| tracer.idle_lights());
        let idle = idle.into_iter().map(|(light, text)| About::Light(light).note(text));
        let notes = whole.notes.iter().cloned().chain(note).chain(idle).collect();
        let run = Run { whole: &whole, job: &job, notes };
        let at_quality = |quality| self.at_quality(&whole, quality);
        let preview = match quality.fitted_at() {
            fitted_at if fitted_at == quality => run.fitted(first, ready)?,
            fitted_at => {
                let (guides, _) = at_quality(fitted_at)?;
                run.carried(&self.job(&guides, &meter, progress)?, first, ready)?
            }
        };
        Ok(Arc::new(preview.concluded(&meter)))
    }

    /// A prepared project limited to a quality, and a note where memory allows fewer photons.
    fn at_quality(&self, whole: &Prepared, quality: Quality) -> Result<(Prepared, Option<Note>)> {
        let project = quality.apply(&whole.project);
        let wanted = quality.photons_of(&project);
        let frames = whole.plan.frames.max(1);
        let kept = (self.preview_bytes / size_of::<Vec2>() / frames).clamp(1, wanted);
        let note = (kept < wanted).then(|| {
            About::Setting(RenderSettings::PHOTONS.place).note(format!(
                "preview: {kept} photons in place of {wanted}, so that {frames} frames fit into {} MB; what is rendered keeps its photons",
                self.preview_bytes / 1_000_000
            ))
        });
        let limited = whole.limited(quality, kept)?;
        Ok((Prepared { project, ..limited }, note))
    }
}

/// One preview of a project.
struct Run<'a> {
    whole: &'a Prepared,
    job: &'a Job<'a>,
    /// What is known before anything flows.
    notes: Vec<Note>,
}

impl Run<'_> {
    /// Matches and fits; the frames fall out of the fits.
    fn fitted(&self, first: i32, ready: &mut dyn FnMut(&Arc<Preview>)) -> Result<Preview> {
        let (keys, segments) = self.walk(|_| MapsFrom::Own { bounded: false })?;
        let mut growing = Growing::new(self.notes(&keys), keys, first, ready);
        let mut all = Vec::new();
        for number in outward(growing.first_segment(), segments.len()) {
            let (fitted, frames) = growing.fit(self.job, &segments[number])?;
            growing.carry(self.job, &segments[number], &fitted, frames)?;
            all.push(fitted);
        }
        Ok(finished(growing, &all))
    }

    /// Pairs photons as those of `guides` are, and carries them along the fields of those.
    fn carried(&self, guides: &Job, first: i32, ready: &mut dyn FnMut(&Arc<Preview>)) -> Result<Preview> {
        let guides = Run { whole: self.whole, job: guides, notes: Vec::new() };
        let (_, led) = guides.walk(|_| MapsFrom::Own { bounded: false })?;
        let (keys, segments) = self.walk(|number| MapsFrom::Others(&led[number].matched.maps))?;
        let mut growing = Growing::new(self.notes(&keys), keys, first, ready);
        let mut all = Vec::new();
        for number in outward(growing.first_segment(), segments.len()) {
            let fitted = super::flow::fit_segment(guides.job, &led[number], None)?;
            growing.carry(self.job, &segments[number], &fitted, None)?;
            all.push(fitted);
        }
        Ok(finished(growing, &all))
    }

    /// The photons at all key frames and in all segments, matched by the maps that `maps` gives for each.
    fn walk<'m>(&self, maps: impl Fn(usize) -> MapsFrom<'m>) -> Result<(Keys, Vec<SegmentPhotons>)> {
        let mut walk = Walk::start(self.job, 0)?;
        let caustics = self.job.sources.caustics(walk.light());
        let groups = walk.at().clone();
        let mut lights = vec![KeyLight::new(walk.at(), walk.requested())];
        let mut segments: Vec<SegmentPhotons> = Vec::new();
        for number in 0..self.whole.project.keys.len() - 1 {
            let Some(photons) = walk.next(maps(number))? else { break };
            lights.push(KeyLight::new(walk.at(), walk.requested()));
            segments.push(photons);
        }
        Ok((self.keys(lights, &groups, caustics), segments))
    }

    /// The notes on what is to flow.
    fn notes(&self, keys: &Keys) -> Vec<Note> {
        self.notes.iter().cloned().chain(notes_on_dark(&keys.caustics)).collect()
    }

    fn keys(&self, lights: Vec<KeyLight>, groups: &[KeyPhotons], caustics: Vec<CausticFlux>) -> Keys {
        let Prepared { project, extent, times, plan, mesh_files, .. } = self.whole;
        let grouping = self.job.sources.grouping();
        let mut end = 0;
        let group = |(group, at): (usize, &KeyPhotons)| {
            let start = end;
            end += at.positions.len();
            (grouping.name(group).map(str::to_owned), start..end)
        };
        let covered = lights.iter().map(|light| covered_area(&light.positions, *extent)).sum::<f32>();
        Keys {
            covered: covered / lights.len() as f32,
            quality: self.job.quality,
            extent: *extent,
            first: project.keys[0].frame,
            frames: project.keys.iter().map(|key| key.frame).collect(),
            moments: times.frames.iter().map(|&(_, slot)| times.moments[slot]).collect(),
            lights,
            groups: groups.iter().enumerate().map(group).collect(),
            caustics,
            left_out: plan.left_out.clone(),
            mesh_files: mesh_files.clone(),
            rho: project.flow.rho.into(),
        }
    }
}

/// The preview with the numbers of its flow, the worst over all segments.
fn finished(growing: Growing, fitted: &[Arc<FittedSegment>]) -> Preview {
    let mut preview = growing.finish();
    let numbers = fitted.iter().flat_map(|f| FlowNumbers::of_segment(f.reports.clone(), &f.cost));
    preview.numbers = numbers.reduce(FlowNumbers::worst);
    let flux_ratio = preview.flux_ratio();
    preview.numbers.iter_mut().for_each(|numbers| numbers.flux_ratio = flux_ratio);
    preview
}

impl Preview {
    /// The preview with its stages, and the notes on what has flowed.
    fn concluded(mut self, meter: &Meter) -> Self {
        self.stages = meter.costs();
        self.notes.extend(self.numbers.iter().filter_map(|numbers| note_on_walls(&numbers.flow)));
        self
    }
}

/// The numbers 0..count, those near `first` before the others.
fn outward(first: usize, count: usize) -> Vec<usize> {
    let mut numbers: Vec<usize> = (0..count).collect();
    numbers.sort_by_key(|number| number.abs_diff(first));
    numbers
}
