//! Renders a project's frames, or writes its tracks.

use std::path::Path;

use super::camera::CameraView;
use super::film_writer::FilmWriter;
use super::fitted_project::FittedProject;
use super::frame_writer::{FrameWriter, Thumbnails};
use super::job::Job;
use super::memo::Slot;
use super::meter::Meter;
use super::observer::RenderObserver;
use super::prepare::Prepared;
use super::summary::{Done, Summary};
use super::{Engine, Quality, active_constraints, track_files};
use crate::export::FilmFormat;
use crate::project::Project;
use crate::render::{PlaneView, ProgressiveRender, first_radius};
use crate::{Error, Progress, Result};

/// Where a render goes, and those who are told of it.
pub struct Output<'a> {
    /// The folder of the frames; it must exist.
    pub folder: &'a Path,
    /// The file of a film of all frames, where one is wanted ([`prepare_film`](super::prepare_film)).
    pub film: Option<&'a Path>,
    /// The progress of the work.
    pub progress: &'a Progress,
    /// Called with each finished file.
    pub saved: &'a (dyn Fn(&Path) + Sync),
    /// Sees the frames grow.
    pub observer: &'a dyn RenderObserver,
}

/// A finished render, with what a comparison asks of it.
pub(super) struct Rendered {
    pub(super) summary: Summary,
    pub(super) fitted: FittedProject,
    pub(super) thumbnails: Thumbnails,
    pub(super) plane: PlaneView,
}

impl Engine {
    /// Renders the project's frames into the folder `out`, which must exist. `saved` is told of each file.
    ///
    /// A run that is cancelled after its first pass still writes all frames, at the quality reached.
    ///
    /// # Errors
    /// Anything wrong with the project or its files, before any frame is written; input and output; cancelled before
    /// the first pass was complete.
    pub fn render(
        &self,
        project: &Project,
        out: &Path,
        progress: &Progress,
        saved: &(dyn Fn(&Path) + Sync),
    ) -> Result<Summary> {
        self.render_to(project, &Output { folder: out, film: None, progress, saved, observer: &() })
    }

    /// As [`Engine::render`], with a film, and an observer who sees the frames grow.
    ///
    /// # Errors
    /// As [`Engine::render`]; a film that cannot be written on this machine.
    pub fn render_to(&self, project: &Project, output: &Output) -> Result<Summary> {
        let &Output { film, progress, observer, .. } = output;
        let meter = Meter::default();
        let prepared = self.prepare(project, &meter, progress)?;
        prepared.plan.require_memory()?;
        prepared.plan.require_space(output.folder)?;
        let mut stages = prepared.plan.stages.clone();
        if let Some(film) = film {
            let format = FilmFormat::of(film, "film")?;
            format.require("film")?;
            stages.push(("film", prepared.plan.film_seconds(&prepared.project.render)));
        }
        progress.set_stages(stages);
        observer.planned(&prepared.plan);
        self.render_prepared(prepared, &meter, output).map(|rendered| rendered.summary)
    }

    /// All stages of a render of a prepared project.
    pub(super) fn render_prepared(
        &self,
        prepared: Prepared,
        meter: &Meter,
        output: &Output,
    ) -> Result<Rendered> {
        let &Output { folder, film, progress, saved, observer } = output;
        let view = CameraView::of_render(&prepared);
        let slot = Slot { client: self.client, quality: Quality::Final, index: 0 };
        let camera = self.stages.look(slot, &view, meter, progress)?;
        let fitted = self.fit_prepared(prepared, meter, progress)?;

        let FittedProject { prepared, flow, .. } = &fitted;
        let (project, times) = (&prepared.project, &prepared.times);
        let first = first_radius(&project.render, prepared.extent);
        let textures = prepared.textures();
        let moments = times.moments.len() * textures;
        let render = ProgressiveRender::new(*camera.visible.layout(), first, moments, folder)?;
        let plane = PlaneView::new(prepared.scene.as_deref(), prepared.extent);
        let writer = FrameWriter {
            project,
            render: &render,
            pictures: &camera,
            caustic_names: &prepared.caustic_layer_names(),
            camera: prepared.scene.as_deref().map(|scene| *scene.camera()),
            receiver: prepared.scene.as_deref().map(|scene| scene.receiver()),
            extent: prepared.extent,
            folder,
            drawn: &active_constraints::drawn(project),
            plane: plane.clone(),
            saved,
        };
        let film = film.map(|path| FilmWriter::new(path, folder, project, times)).transpose()?;
        let passed = |passes| observer.passed(passes, &|frame| writer.picture(times, frame));
        let (passes, balance) =
            meter.measure("render", || fitted.render_passes(&render, progress, &passed))?;
        let (bad_values, thumbnails) =
            meter.measure("write", || writer.run(times, film.as_ref(), progress))?;
        if let Some(film) = &film {
            meter.measure("film", || film.write(progress))?;
            saved(film.path());
        }
        let continuity = fitted.measured_unless_stopped(meter, progress)?;
        let clamped = camera.background.clamped;
        let done = Done { command: "render", passes, flow, continuity, balance, bad_values, clamped };
        let summary = Summary::new(prepared, done, meter);
        Ok(Rendered { summary, fitted, thumbnails, plane })
    }

    /// Fits the flow and writes `tracks.npy`, `flux.npy` and `fields.npz` into the folder `out`.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; input and output; cancelled.
    pub fn fit(
        &self,
        project: &Project,
        out: &Path,
        progress: &Progress,
        saved: &(dyn Fn(&Path) + Sync),
    ) -> Result<Summary> {
        let meter = Meter::default();
        let prepared = self.prepare(&track_files::with_guides_alone(project), &meter, progress)?;
        if project.keys.len() < 2 {
            return Err(Error::value(
                "keys",
                "there is one key frame, so there is no flow to fit; add another",
            ));
        }
        let stages = prepared.plan.stages.iter().copied();
        progress.set_stages(
            stages.filter(|(stage, _)| ["trace", "plan", "fit", "match", "write"].contains(stage)).collect(),
        );
        let fitted = self.fit_prepared(prepared, &meter, progress)?;
        let FittedProject { prepared, flow, .. } = &fitted;
        let inner = progress.inner();
        let job = Job { progress: &inner, ..self.job(prepared, &meter, progress)? };
        let balance = meter.measure("write", || track_files::write(&job, flow, out, progress, saved))?;
        let continuity = fitted.measured_unless_stopped(&meter, progress)?;
        let (bad_values, clamped) = Default::default();
        let done = Done { command: "fit", passes: 0, flow, continuity, balance, bad_values, clamped };
        Ok(Summary::new(prepared, done, &meter))
    }
}
