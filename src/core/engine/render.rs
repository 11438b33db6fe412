//! Renders a project's frames, or writes its tracks.

use std::path::Path;
use std::sync::Arc;

use super::bake::Bake;
use super::camera::CameraView;
use super::contact_sheet::Thumbnails;
use super::film_writer::FilmWriter;
use super::fingerprint::fingerprint;
use super::fitted_project::FittedProject;
use super::frame_light::FrameLights;
use super::frame_writer::{FrameWriter, Written};
use super::job::Job;
use super::memo::Slot;
use super::meter::Meter;
use super::output::Output;
use super::prepare::Prepared;
use super::run_files::RunFiles;
use super::summary::{Done, Summary};
use super::{Engine, Quality, active_constraints, track_files};
use crate::export::FilmFormat;
use crate::project::Project;
use crate::render::{PlaneView, first_radius};
use crate::{Error, Progress, Result};

/// A finished render, with what a comparison asks of it.
pub(super) struct Rendered {
    pub(super) summary: Summary,
    pub(super) fitted: FittedProject,
    pub(super) thumbnails: Thumbnails,
    pub(super) plane: PlaneView,
}

impl Engine {
    /// Renders the project's frames into the folder `out`, which must exist; those that are there and made from the same are
    /// kept, others replaced. `saved` is told of each file.
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
        self.render_to(project, &Output::new(out, progress, saved))
    }

    /// As [`Engine::render`], with a film, and an observer who sees the frames grow.
    ///
    /// # Errors
    /// As [`Engine::render`]; frames of other renders that may not be replaced; a bake of another project; a film that cannot
    /// be written on this machine.
    pub fn render_to(&self, project: &Project, output: &Output) -> Result<Summary> {
        let &Output { film, progress, observer, .. } = output;
        let meter = Meter::default();
        let mut prepared = self.prepare(project, &meter, progress)?;
        prepared.plan.require_memory()?;
        let files = RunFiles::open(self, &mut prepared, output)?;
        let mut stages = prepared.plan.stages.clone();
        if let Some(film) = film {
            let format = FilmFormat::of(film, "film")?;
            format.require("film")?;
            stages.push(("film", prepared.plan.film_seconds(&prepared.project.render)));
        }
        progress.set_stages(stages);
        observer.planned(&prepared.plan);
        if files.is_done() && film.is_none() {
            files.write_sheet_of_kept(&prepared, output)?;
            return Ok(files.summary_of_kept(&prepared, &meter));
        }
        let unfinished = files.unfinished();
        let rendered = self.render_prepared(prepared, &meter, output, files);
        let abandoned = matches!(rendered, Err(Error::Cancelled)) && progress.is_abandoned();
        if let Some(folder) = unfinished.filter(|_| abandoned && !observer.keeps_unfinished()) {
            std::fs::remove_dir_all(&folder).map_err(Error::io("remove", &folder))?;
        }
        rendered.map(|rendered| rendered.summary)
    }

    /// All stages of a render of a prepared project.
    pub(super) fn render_prepared(
        &self,
        prepared: Prepared,
        meter: &Meter,
        output: &Output,
        files: RunFiles,
    ) -> Result<Rendered> {
        let &Output { folder, film, progress, saved, observer, .. } = output;
        let view = CameraView::of_render(&prepared);
        let slot = Slot { client: self.client, quality: Quality::Final, index: 0 };
        let camera = self.stages.look(slot, &view, meter, progress)?;
        let fitted = self.fit_prepared(prepared, meter, progress)?;

        let FittedProject { prepared, flow, .. } = &fitted;
        let (project, times) = (&prepared.project, &prepared.times);
        let first = first_radius(&project.render, prepared.extent);
        let textures = prepared.textures();
        let moments = times.moments.len() * textures;
        let render = files.store(*camera.visible.layout(), first, moments)?;
        let before = render.least_passes();
        let plane = PlaneView::new(prepared.scene.as_deref(), prepared.extent);
        let writer = FrameWriter {
            lights: FrameLights {
                project,
                render: &render,
                pictures: &camera,
                caustic_names: &prepared.caustic_layer_names(),
                receiver: prepared.scene.as_deref().map(|scene| scene.receiver()),
                extent: prepared.extent,
            },
            camera: prepared.scene.as_deref().map(|scene| *scene.camera()),
            folder,
            drawn: &active_constraints::drawn(project),
            plane: plane.clone(),
            files: &files,
            planned: prepared.plan.passes,
            saved,
        };
        let requested = project.frames()?;
        let film = film.map(|path| FilmWriter::new(path, folder, project, &requested)).transpose()?;
        let passed = |passes| observer.passed(passes, &|frame| writer.picture(times, frame));
        let (passes, balance) =
            meter.measure("render", || fitted.render_passes(&render, progress, &passed))?;
        let Written { bad_values, thumbnails, left } =
            meter.measure("write", || writer.run(times, &requested, film.as_ref(), progress))?;
        if let Some(film) = film.as_ref().filter(|_| !progress.ends_soon()) {
            meter.measure("film", || film.write(progress))?;
            saved(film.path());
        }
        let continuity = fitted.measured_unless_stopped(meter, progress)?;
        let clamped = camera.background.clamped;
        let done = Done { command: "render", passes, flow, continuity, balance, bad_values, clamped };
        let mut summary = Summary::new(prepared, done, meter);
        (summary.frames, summary.frames_left) = (summary.frames.saturating_sub(left), left);
        files.tell(&mut summary, before);
        drop(render);
        if summary.passes >= summary.passes_planned && left == 0 {
            files.finish(folder, &requested)?;
        }
        Ok(Rendered { summary, fitted, thumbnails, plane })
    }

    /// Bakes everything into `folder`, which must exist, that a render needs before its first pass: what the camera sees
    /// without the light that flows, the aim of the photons, the maps and the fields. Renders of parts of the frames then
    /// start from there, wherever they run, with the same bytes as one render of all ([`Output::bake`]).
    ///
    /// # Errors
    /// Anything wrong with the project or its files; input and output; cancelled.
    pub fn bake(
        &self,
        project: &Project,
        folder: &Path,
        progress: &Progress,
        saved: &(dyn Fn(&Path) + Sync),
    ) -> Result<Summary> {
        let meter = Meter::default();
        let mut prepared = self.prepare(project, &meter, progress)?;
        prepared.plan.require_memory()?;
        let stages = prepared.plan.stages.iter().copied();
        progress.set_stages(stages.filter(|(stage, _)| !["render", "write"].contains(stage)).collect());
        let print = fingerprint(project, &self.stages.assets, &prepared.mesh_files)?;
        let bake = Arc::new(Bake::growing(folder, &print));
        prepared.bake = Some(bake.clone());
        let view = CameraView::of_render(&prepared);
        let slot = Slot { client: self.client, quality: Quality::Final, index: 0 };
        let camera = self.stages.look(slot, &view, &meter, progress)?;
        let fitted = self.fit_prepared(prepared, &meter, progress)?;
        saved(&bake.complete(&project.name)?);
        let FittedProject { prepared, flow, .. } = &fitted;
        let continuity = fitted.measured_unless_stopped(&meter, progress)?;
        let (balance, bad_values, clamped) =
            (Default::default(), Default::default(), camera.background.clamped);
        let done = Done { command: "fit", passes: 0, flow, continuity, balance, bad_values, clamped };
        Ok(Summary { fingerprint: print, ..Summary::new(prepared, done, &meter) })
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
