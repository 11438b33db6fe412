//! The files around a render: those that are there already, and those that outlive it should it be cut off.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::bake::Bake;
use super::checkpoint::{Checkpoint, bytes_kept, remove_finished};
use super::contact_sheet::{ContactSheet, Thumbnails, thumbnails};
use super::existing::Found;
use super::fingerprint::fingerprint;
use super::fitted_segment::FittedFlow;
use super::frame_times::FrameTimes;
use super::meter::Meter;
use super::output::Output;
use super::output_folder::CONTACT_SHEET;
use super::prepare::Prepared;
use super::summary::{Done, Summary};
use super::{Engine, active_constraints};
use crate::export::OverlayLine;
use crate::note::About;
use crate::render::frames::FrameStore;
use crate::render::{PlaneView, ProgressiveRender, TextureLayout};
use crate::{Note, Result};

/// What a render keeps, and where its unfinished light is.
pub(super) struct RunFiles {
    /// What the frames are made from.
    pub(super) fingerprint: String,
    pub(super) found: Found,
    /// Whether a contact sheet is written.
    pub(super) sheet: bool,
    checkpoint: Option<Checkpoint>,
    /// The folder of a scratch file that goes with the process, where there is no checkpoint.
    scratch: PathBuf,
    notes: Vec<Note>,
}

impl RunFiles {
    /// Those of a render with this fingerprint that replaces whatever is in its folder, and is never taken up.
    pub(super) fn fresh(folder: &Path, fingerprint: String) -> Self {
        Self {
            fingerprint,
            found: Found::default(),
            sheet: true,
            checkpoint: None,
            scratch: folder.to_owned(),
            notes: Vec::new(),
        }
    }

    /// Looks at what is in the folder of `output`, makes sure that there is room, and takes up unfinished light; `prepared` is
    /// then about the frames that are to be rendered.
    ///
    /// # Errors
    /// Frames of other renders that may not be replaced; a bake of another project; too little room on the disk.
    pub(super) fn open(engine: &Engine, prepared: &mut Prepared, output: &Output) -> Result<Self> {
        let print = fingerprint(&prepared.project, &engine.stages.assets, &prepared.mesh_files)?;
        if let Some(folder) = output.bake {
            prepared.bake = Some(Arc::new(Bake::of_folder(folder, &print)?));
        }
        let found = Found::in_folder(&prepared.project, output.folder, &print, output.existing)?;
        found.require(output.existing, "--out")?;
        let mut files =
            Self { sheet: output.bake.is_none() && !output.is_part, ..Self::fresh(output.folder, print) };
        let wanted = if found.wanted.is_empty() && output.film.is_some() {
            prepared.project.frames()?
        } else {
            found.wanted.clone()
        };
        files.found = found;
        prepared.plan_frames(&wanted)?;
        if wanted.is_empty() {
            // A run that was cut off after its last frame left its light.
            remove_finished(output.folder, &files.fingerprint, &prepared.project.frames()?)?;
            return Ok(files);
        }
        let texels = prepared.layout().len();
        let textures = prepared.times.moments.len() * prepared.textures();
        prepared.plan.set_scratch(FrameStore::bytes(texels, textures));
        prepared.plan.require_space(output.folder, bytes_kept(output.folder, &files.fingerprint))?;
        let whose = (&prepared.project, files.fingerprint.as_str());
        files.checkpoint = Checkpoint::open(output.folder, whose, &wanted, &mut files.notes)?;
        if let Some(checkpoint) = &files.checkpoint {
            prepared.times = FrameTimes::new(&prepared.project.keys, checkpoint.frames());
            if prepared.bake.is_none() {
                prepared.bake = Some(Arc::new(Bake::growing(checkpoint.folder(), &files.fingerprint)));
            }
        }
        Ok(files)
    }

    /// The folder of the unfinished light, where it is kept.
    pub(super) fn unfinished(&self) -> Option<PathBuf> {
        self.checkpoint.as_ref().map(|checkpoint| checkpoint.folder().to_owned())
    }

    /// Writes the contact sheet of these pictures, unless another is kept. `drawn` are the constraints, on their plane.
    ///
    /// # Errors
    /// The system refuses.
    pub(super) fn write_sheet(
        &self,
        thumbnails: &Thumbnails,
        (drawn, plane): (&[OverlayLine], &PlaneView),
        (folder, saved): (&Path, &(dyn Fn(&Path) + Sync)),
    ) -> Result<()> {
        if !self.found.kept.contains(&folder.join(CONTACT_SHEET)) {
            let fingerprint = &self.fingerprint;
            saved(&ContactSheet { folder, fingerprint, drawn, plane: Some(plane) }.write(thumbnails)?);
        }
        Ok(())
    }

    /// Writes the contact sheet of frames that are all there already: the run that wrote the last of them may have been cut off
    /// before it.
    ///
    /// # Errors
    /// A frame that cannot be read; the system refuses.
    pub(super) fn write_sheet_of_kept(&self, prepared: &Prepared, output: &Output) -> Result<()> {
        let (project, folder) = (&prepared.project, output.folder);
        if !self.sheet {
            return Ok(());
        }
        let thumbnails = thumbnails(project, folder, &project.frames()?)?;
        if thumbnails.is_empty() {
            return Ok(());
        }
        let plane = PlaneView::new(prepared.scene.as_deref(), prepared.extent);
        let drawn = active_constraints::drawn(project);
        self.write_sheet(&thumbnails, (&drawn, &plane), (folder, output.saved))
    }

    /// Whether all frames are there.
    pub(super) fn is_done(&self) -> bool {
        self.found.wanted.is_empty()
    }

    /// The summary of a run whose frames are all there already.
    pub(super) fn summary_of_kept(&self, prepared: &Prepared, meter: &Meter) -> Summary {
        let (segments, caustics, idle_lights) = Default::default();
        let flow = &FittedFlow { segments, numbers: None, caustics, idle_lights };
        let (continuity, balance, bad_values, clamped) = Default::default();
        let passes = prepared.plan.passes;
        let done = Done { command: "render", passes, flow, continuity, balance, bad_values, clamped };
        let mut summary = Summary::new(prepared, done, meter);
        self.tell(&mut summary, 0);
        summary
    }

    /// The light of `frames` textures, with what was kept of it.
    ///
    /// # Errors
    /// The system refuses.
    pub(super) fn store(
        &self,
        layout: TextureLayout,
        first_radius: f32,
        frames: usize,
    ) -> Result<ProgressiveRender> {
        match &self.checkpoint {
            Some(kept) => ProgressiveRender::kept(layout, first_radius, frames, kept.folder(), kept.checked),
            None => ProgressiveRender::new(layout, first_radius, frames, &self.scratch),
        }
    }

    /// Tells in a summary what was kept; `before` are the passes that were there at the begin.
    pub(super) fn tell(&self, summary: &mut Summary, before: usize) {
        summary.fingerprint.clone_from(&self.fingerprint);
        summary.partial = !self.sheet || self.is_done();
        summary.kept = self.found.kept.len();
        summary.notes.extend(self.notes.iter().cloned());
        if before > 0 {
            summary.notes.push(About::Project.note(format!(
                "taken up after {before} passes of an earlier run; the figures of the energy are those of the passes since"
            )));
        }
    }

    /// Removes what was kept for a run that takes this one up: all frames are finished.
    ///
    /// # Errors
    /// The system refuses.
    pub(super) fn finish(self, out: &Path, frames: &[i32]) -> Result<()> {
        let Self { checkpoint, fingerprint, .. } = self;
        checkpoint.map_or(Ok(()), |checkpoint| checkpoint.finish(out, &fingerprint, frames))
    }
}
