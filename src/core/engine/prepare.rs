//! What every command begins with: the scene read, what the keys show opened, and the plan.

use std::sync::Arc;

use glam::Vec2;

use super::batch::Batch;
use super::plan::{self, Plan};
use super::slots::Slots;
use super::stage::{Same, Stage, Stamp};
use super::supply::{Opened, Supplies};
use super::{acting, grouping};
use crate::flow::{FlowSettings, GridSize};
use crate::photon::Tracer;
use crate::project::{AssetFolder, Project};
use crate::scene::{Geometry, MeshDesc, Scene, SceneDesc};
use crate::{Progress, Result};

/// Opens what a project names, and remembers it.
pub(super) struct Loader {
    assets: AssetFolder,
    geometry: Stage<(Vec<MeshDesc>, Vec<Stamp>), Noted<Geometry>>,
    scene: Stage<(SceneDesc, Same<Geometry>), Noted<Scene>>,
    opened: Opened,
}

/// Something, and what the artist should know of it.
type Noted<T> = (Arc<T>, Arc<Vec<String>>);

/// What every command begins with.
pub(super) struct Prepared {
    pub(super) scene: Option<Arc<Scene>>,
    pub(super) extent: Vec2,
    pub(super) supplies: Supplies,
    pub(super) slots: Slots,
    pub(super) plan: Plan,
    pub(super) notes: Vec<String>,
}

impl Loader {
    /// Has opened nothing yet and finds files through `assets`.
    pub(super) fn new(assets: AssetFolder) -> Self {
        let (geometry, scene) = (Stage::default(), Stage::default());
        Self { assets, geometry, scene, opened: Opened::default() }
    }

    /// Through which files are found.
    pub(super) fn assets(&self) -> &AssetFolder {
        &self.assets
    }

    /// Checks a project and opens every file it names.
    pub(super) fn prepare(&mut self, project: &Project, progress: &Progress) -> Result<Prepared> {
        project.check()?;
        let frames = project.frames()?;
        let mut notes = Vec::new();
        let scene = match &project.scene {
            None => None,
            Some(desc) => Some(self.scene(desc, &mut notes, progress)?),
        };
        let extent = scene.as_ref().map_or_else(|| project.plane.extent(), |s| s.receiver().extent());
        let files = (&self.assets, &mut self.opened);
        let supplies = Supplies::load(project, scene.as_deref(), extent, files, progress)?;
        notes.extend(supplies.notes());
        notes.extend(scene.iter().flat_map(|scene| grouping::notes_on_names(scene)));
        notes.extend(stretch_note(project.flow.grid, extent));
        notes.extend(acting::notes(project, extent));
        notes.extend(swirl_note(&project.flow).filter(|_| project.fits()));
        let slots = Slots::new(&project.keys, &frames);
        let plan = plan::plan(
            project,
            extent,
            frames.len(),
            supplies.given_rows(project.matching)?,
            supplies.is_fixed(project.render.photons as usize),
        );
        Ok(Prepared { scene, extent, supplies, slots, plan, notes })
    }

    /// A scene, whose meshes are read again only if they, or their files, are others than before.
    pub(super) fn scene(
        &mut self,
        desc: &SceneDesc,
        notes: &mut Vec<String>,
        progress: &Progress,
    ) -> Result<Arc<Scene>> {
        desc.check("scene")?;
        let assets = &self.assets;
        // A file that cannot be found has no stamp; reading it tells why.
        let stamp = |mesh: &MeshDesc| Some(Stamp::of(&assets.resolve(&mesh.file, "").ok()?));
        let stamps = desc.meshes.iter().filter_map(stamp).collect();
        let (geometry, of_meshes) = self.geometry.get((desc.meshes.clone(), stamps), |(meshes, _)| {
            let resolve = |path: &str, place: &str| assets.resolve(path, place);
            Geometry::load(meshes, &resolve, progress).map(noted)
        })?;
        let input = (desc.clone(), Same::of(&geometry));
        let (scene, of_scene) = self.scene.get(input, |_| Scene::with(desc, geometry).map(noted))?;
        notes.extend(of_meshes.iter().chain(&*of_scene).cloned());
        Ok(scene)
    }
}

fn noted<T>((thing, notes): (T, Vec<String>)) -> Noted<T> {
    (Arc::new(thing), Arc::new(notes))
}

impl Prepared {
    /// The photons of one pass at the first key.
    pub(super) fn start<'a>(
        &'a self,
        project: &'a Project,
        tracer: Option<&Tracer>,
        pass: u64,
        progress: &Progress,
    ) -> Result<Batch<'a>> {
        let light = self.supplies.light(tracer, pass, self.plan.photons, &progress.inner())?;
        Ok(Batch::start(&self.supplies, light, pass, project, self.extent))
    }
}

/// A grid of long cells smooths more along them than across.
fn stretch_note(grid: GridSize, extent: Vec2) -> Option<String> {
    let [columns, rows] = grid.cells(extent).map(|n| n as f32);
    let [width, height] = [extent.x / columns, extent.y / rows];
    let stretch = width.max(height) / width.min(height);
    (stretch > 2.0).then(|| {
        format!(
            "flow.grid: its cells are stretched {stretch:.0} : 1, so the flow follows less detail that way"
        )
    })
}

/// Steps in which photons cross more than a cell of the noise do not follow its swirls.
fn swirl_note(flow: &FlowSettings) -> Option<String> {
    let turbulence = flow.turbulence.as_ref()?;
    let finest = *turbulence.grids.iter().max()?;
    let needed = (turbulence.speed() * finest as f32).ceil();
    (needed > flow.steps as f32).then(|| {
        format!(
            "flow.turbulence: in one step the photons cross {:.1} cells of the {finest} x {finest} noise; give flow.steps {needed} to follow its swirls",
            needed / flow.steps as f32
        )
    })
}
