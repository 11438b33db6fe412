//! The first step of every command: a project checked, its files opened, its work planned.

use std::path::PathBuf;
use std::sync::Arc;

use glam::Vec2;

use super::bake::Bake;
use super::frame_times::FrameTimes;
use super::key_sources::KeySources;
use super::memo::{Client, Slot};
use super::plan::{self, Plan};
use super::scene_notes::scene_notes;
use super::stages::Stages;
use super::{Quality, active_constraints, grouping};
use crate::export::caustic_layer_names;
use crate::flow::{FlowSettings, GridSize};
use crate::note::About;
use crate::project::{Project, Shows};
use crate::render::density::radius_of_pass;
use crate::render::{PlaneMaterial, TextureLayout, first_radius, layout_for};
use crate::scene::Scene;
use crate::{Note, Progress, Result};

/// A project whose files are open and whose work is planned.
#[derive(Clone)]
pub(super) struct Prepared {
    pub(super) project: Project,
    /// The quality whose limits hold beside the project's own numbers.
    pub(super) quality: Quality,
    pub(super) scene: Option<Arc<Scene>>,
    pub(super) extent: Vec2,
    pub(super) sources: KeySources,
    pub(super) times: FrameTimes,
    pub(super) plan: Plan,
    pub(super) notes: Vec<Note>,
    /// Photons of one pass.
    pub(super) photons: usize,
    /// The files that meshes were read from, in the order of their names.
    pub(super) mesh_files: Arc<[PathBuf]>,
    /// Results of an earlier process, where there may be some.
    pub(super) bake: Option<Arc<Bake>>,
}

impl Stages {
    /// Checks a project and opens every file it names.
    ///
    /// # Errors
    /// The first thing that is wrong with the project or its files; cancelled.
    pub(super) fn prepare(&self, client: Client, project: &Project, progress: &Progress) -> Result<Prepared> {
        project.check()?;
        let frames = project.frames()?;
        let scene = match &project.scene {
            None => None,
            Some(desc) => Some(self.scene(client, desc, progress)?),
        };
        let (noted, mesh_files) = scene.unzip();
        let (scene, of_scene) = noted.unzip();
        let extent = scene.as_ref().map_or_else(|| project.plane.extent(), |s| s.receiver().extent());
        let open = |shows: &Shows, place: &str, index: usize| {
            let slot = Slot { client, quality: Quality::Final, index };
            self.source(slot, (shows, place), extent, progress)
        };
        let mut notes: Vec<Note> = of_scene.iter().flat_map(|notes| &**notes).cloned().collect();
        let sources =
            KeySources::load(project, scene.as_deref(), &open).map_err(|error| error.with_notes(&notes))?;
        notes.extend(sources.notes());
        if project.output.shows_background() {
            let slot = Slot { client, quality: Quality::Final, index: 0 };
            let plate =
                self.plate(slot, &project.render, progress).map_err(|error| error.with_notes(&notes))?;
            let texts = plate.iter().flat_map(|plate| plate.notes.iter().cloned());
            notes.extend(About::Setting("render.plate").notes(texts));
        }
        notes.extend(scene.iter().flat_map(|scene| grouping::notes_on_names(scene)));
        notes.extend(scene.iter().flat_map(|scene| scene_notes(scene, &project.render)));
        notes.extend(stretch_note(project.flow.grid, extent));
        notes.extend(active_constraints::notes(project, extent));
        notes.extend(swirl_note(&project.flow).filter(|_| project.fits()));
        let times = FrameTimes::new(&project.keys, &frames);
        let plan = plan::plan(
            project,
            extent,
            frames.len(),
            sources.given_rows(project.matching)?,
            sources.is_fixed(project.render.photons as usize),
            |passes| layout(project, scene.as_deref(), extent, passes).len(),
        );
        let photons = plan.photons;
        let (project, quality) = (project.clone(), Quality::Final);
        let mesh_files = mesh_files.iter().flat_map(|files| files.iter());
        let mesh_files = mesh_files.map(|file| file.path().to_owned()).collect();
        Ok(Prepared {
            project,
            quality,
            scene,
            extent,
            sources,
            times,
            plan,
            notes,
            photons,
            mesh_files,
            bake: None,
        })
    }
}

impl Prepared {
    /// Textures of each frame: one for each group of photons where the light of caustics is written apart, else 1.
    pub(super) fn textures(&self) -> usize {
        if self.project.output.separates_caustics() { self.sources.grouping().count() } else { 1 }
    }

    /// The texture on the receiver.
    pub(super) fn layout(&self) -> TextureLayout {
        layout(&self.project, self.scene.as_deref(), self.extent, self.plan.passes)
    }

    /// The names of the layers of single caustics, one for each texture of a frame; none where their light is one.
    pub(super) fn caustic_layer_names(&self) -> Vec<String> {
        if !self.project.output.separates_caustics() {
            return Vec::new();
        }
        caustic_layer_names(self.project.caustics.iter().map(|caustic| caustic.name.as_str()))
    }

    /// The look of light on the plane.
    pub(super) fn plane_material(&self) -> PlaneMaterial {
        self.scene.as_ref().map_or(PlaneMaterial::WHITE, |scene| PlaneMaterial::of(scene.receiver()))
    }

    /// Plans some of the frames in place of all.
    ///
    /// # Errors
    /// Point files of different lengths whose rows are paired as given.
    pub(super) fn plan_frames(&mut self, frames: &[i32]) -> Result<()> {
        let rows = self.sources.given_rows(self.project.matching)?;
        let fixed = self.sources.is_fixed(self.project.render.photons as usize);
        let texels = |passes| layout(&self.project, self.scene.as_deref(), self.extent, passes).len();
        self.plan = plan::plan(&self.project, self.extent, frames.len(), rows, fixed, texels);
        self.times = FrameTimes::new(&self.project.keys, frames);
        Ok(())
    }

    /// The same with at most `photons` photons in a pass, at a lower quality.
    ///
    /// # Errors
    /// Point files of different lengths whose rows are paired as given.
    pub(super) fn limited(&self, quality: Quality, photons: usize) -> Result<Self> {
        let (sources, photons) = self.sources.thinned(self.project.matching, photons)?;
        Ok(Self { quality, sources, photons, ..self.clone() })
    }

    /// The same with other random numbers and another number of photons in a pass; what was fitted stays.
    pub(super) fn reseeded(&self, seed: u64, photons: usize) -> Self {
        let project = Project { seed, ..self.project.clone() };
        Self { project, sources: self.sources.with_seed(seed), photons, ..self.clone() }
    }
}

/// The texture on the receiver for so many passes.
fn layout(project: &Project, scene: Option<&Scene>, extent: Vec2, passes: usize) -> TextureLayout {
    let first = first_radius(&project.render, extent);
    layout_for(scene, extent, &project.render, (first, radius_of_pass(first, passes.max(1) - 1)))
}

/// A grid of long cells smooths more along them than across.
fn stretch_note(grid: GridSize, extent: Vec2) -> Option<Note> {
    let [columns, rows] = grid.cells(extent).map(|n| n as f32);
    let [width, height] = [extent.x / columns, extent.y / rows];
    let stretch = width.max(height) / width.min(height);
    (stretch > 2.0).then(|| {
        About::Setting(FlowSettings::GRID.place).note(format!(
            "flow.grid: its cells are stretched {stretch:.0} : 1, so the flow follows less detail that way"
        ))
    })
}

/// Steps in which photons cross more than a cell of the noise do not follow its swirls.
fn swirl_note(flow: &FlowSettings) -> Option<Note> {
    let turbulence = flow.turbulence.as_ref()?;
    let finest = *turbulence.grids.iter().max()?;
    let needed = (turbulence.speed() * finest as f32).ceil();
    (needed > flow.steps as f32).then(|| {
        About::Setting(FlowSettings::STEPS.place).note(format!(
            "flow.turbulence: in one step the photons cross {:.1} cells of the {finest} x {finest} noise; give flow.steps {needed} to follow its swirls",
            needed / flow.steps as f32
        ))
    })
}
