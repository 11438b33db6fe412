//! The stages of the engine, with what they remember.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec2;

use super::Quality;
use super::fitted_segment::{FittedSegment, FlowInput};
use super::key_sources::{self, KeySource, SourceInput};
use super::memo::{Client, FileStamp, Memo, Same, Slot};
use super::memo_keys::{GuideInput, PositionsInput, StillInput, ViewInput};
use super::segment_figures::Figures;
use super::segment_photons::{MatchInput, Matched};
use super::still_light::StillLight;
use crate::photon::{EmissionGuide, Photons};
use crate::project::{AssetFolder, Shows};
use crate::render::{Background, FirstHits, GatherMatrix, Plate, PlateSettings, RenderSettings};
use crate::scene::{Geometry, MeshDesc, Scene, SceneDesc};
use crate::{Note, Progress, Result};

/// All stages up to the positions of photons and the picture without caustics. Each remembers its results.
pub(super) struct Stages {
    pub(super) assets: AssetFolder,
    geometry: Memo<Vec<MeshDesc>, WithFiles<Noted<Geometry>>>,
    scenes: Memo<(SceneDesc, Same<Geometry>), Noted<Scene>>,
    sources: Memo<SourceInput, Arc<KeySource>>,
    plates: Memo<PlateInput, Arc<Plate>>,
    pub(super) guides: Memo<GuideInput, Arc<EmissionGuide>>,
    pub(super) photons: Memo<(Same<EmissionGuide>, usize), Arc<Photons>>,
    pub(super) matchings: Memo<MatchInput, Arc<Matched>>,
    pub(super) flows: Memo<FlowInput, Arc<FittedSegment>>,
    pub(super) continuity: Memo<Same<FittedSegment>, Arc<Figures>>,
    pub(super) positions: Memo<PositionsInput, Arc<Vec<Arc<[Vec2]>>>>,
    pub(super) visible: Memo<ViewInput, Arc<GatherMatrix>>,
    pub(super) first_hits: Memo<ViewInput, Arc<FirstHits>>,
    pub(super) backgrounds: Memo<ViewInput, Arc<Background>>,
    pub(super) still: Memo<StillInput, Arc<StillLight>>,
}

/// A plate, the size of the frame, and the state of the plate's file.
type PlateInput = (PlateSettings, [usize; 2], FileStamp);

/// A result, and the files that meshes were read from, in the order of their names: their own, and those that these name.
type WithFiles<T> = (T, Arc<Vec<FileStamp>>);

/// A result, and notes for the artist.
pub(super) type Noted<T> = (Arc<T>, Arc<Vec<Note>>);

impl Stages {
    /// Stages that remember nothing and find files through `assets`.
    pub(super) fn new(assets: AssetFolder) -> Self {
        Self {
            assets,
            geometry: Memo::default(),
            scenes: Memo::default(),
            sources: Memo::default(),
            plates: Memo::default(),
            guides: Memo::default(),
            photons: Memo::default(),
            matchings: Memo::default(),
            flows: Memo::default(),
            continuity: Memo::default(),
            positions: Memo::default(),
            visible: Memo::default(),
            first_hits: Memo::default(),
            backgrounds: Memo::default(),
            still: Memo::default(),
        }
    }

    /// A scene with its notes, and the files that its meshes were read from. Meshes are read again only if they, or their files, changed.
    ///
    /// # Errors
    /// The first value of the scene that cannot be used; a mesh that cannot be read; cancelled.
    pub(super) fn scene(
        &self,
        client: Client,
        desc: &SceneDesc,
        progress: &Progress,
    ) -> Result<WithFiles<Noted<Scene>>> {
        desc.check("scene")?;
        // A scene without meshes is the bare plane of a project that has no scene; it takes no slot from the others.
        let slot = Slot { client, quality: Quality::Final, index: usize::from(desc.meshes.is_empty()) };
        let are_current = |(_, files): &WithFiles<_>| files.iter().all(FileStamp::is_current);
        let load = |meshes: &Vec<MeshDesc>| {
            let files = Mutex::new(BTreeMap::new());
            let resolve = |path: &str, place: &str| {
                let file = self.assets.resolve(path, place)?;
                let mut files = files.lock().unwrap_or_else(PoisonError::into_inner);
                files.entry(file.clone()).or_insert_with(|| FileStamp::of(&file));
                Ok(file)
            };
            let geometry = Geometry::load(meshes, &resolve, progress).map(noted)?;
            let files = files.into_inner().unwrap_or_else(PoisonError::into_inner);
            Ok((geometry, Arc::new(files.into_values().collect())))
        };
        let ((geometry, of_meshes), files) =
            self.geometry.get_if(are_current, slot, desc.meshes.clone(), progress, load)?;
        let input = (desc.clone(), Same::of(&geometry));
        let (scene, of_scene) =
            self.scenes.get(slot, input, progress, |_| Scene::with_geometry(desc, geometry).map(noted))?;
        Ok(((scene, Arc::new(of_meshes.iter().chain(&*of_scene).cloned().collect())), files))
    }

    /// The source of light that `shows` asks for at `place` of the project, read again only if its file changed.
    ///
    /// # Errors
    /// A file that cannot be read; cancelled.
    pub(super) fn source(
        &self,
        slot: Slot,
        (shows, place): (&Shows, &str),
        extent: Vec2,
        progress: &Progress,
    ) -> Result<Arc<KeySource>> {
        progress.check()?;
        let (input, file): (_, Option<PathBuf>) = SourceInput::new(shows, place, extent, &self.assets)?;
        let open = |_: &SourceInput| {
            key_sources::open(shows, file.as_deref(), (place, extent), progress).map(Arc::new)
        };
        self.sources.get(slot, input, progress, open)
    }

    /// The plate of a picture, where it has one, read again only if its file changed.
    ///
    /// # Errors
    /// A file that cannot be read; cancelled.
    pub(super) fn plate(
        &self,
        slot: Slot,
        render: &RenderSettings,
        progress: &Progress,
    ) -> Result<Option<Arc<Plate>>> {
        let Some(settings) = &render.plate else { return Ok(None) };
        let file = self.assets.resolve(&settings.file, PlateSettings::FILE.place)?;
        let size = [render.width as usize, render.height as usize];
        let input = (settings.clone(), size, FileStamp::of(&file));
        let read =
            |(settings, size, _): &PlateInput| Plate::load(&file, settings, *size, progress).map(Arc::new);
        self.plates.get(slot, input, progress, read).map(Some)
    }
}

fn noted<T>((result, notes): (T, Vec<Note>)) -> Noted<T> {
    (Arc::new(result), Arc::new(notes))
}
