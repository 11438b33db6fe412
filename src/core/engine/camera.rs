//! The camera's stages: the visible points of the receiver, the picture without caustics, and the light that does not flow.

use std::sync::Arc;
use std::time::Duration;

use glam::Vec2;

use super::bake::{Bake, baked};
use super::grouping::Grouping;
use super::memo::{Same, Slot};
use super::memo_keys::{StillInput, ViewInput};
use super::meter::Meter;
use super::prepare::Prepared;
use super::stages::Stages;
use super::still_light::{StillLight, shares};
use crate::project::{Project, SegmentTime};
use crate::render::{
    Background, BackgroundSamples, FirstHits, GatherMatrix, Image, ReceiverTexture, RenderSettings,
    TextureLayout, background, background_from, rough_background,
};
use crate::scene::Scene;
use crate::{Error, Progress, Result};

/// How often the samples of a background are kept.
const KEPT_EVERY: Duration = Duration::from_secs(2);
/// Name of the samples of an unfinished background among baked results.
const SAMPLES: &str = "background-samples";

/// A project's camera, receiver and the texture that lies on it.
pub(super) struct CameraView<'a> {
    pub(super) project: &'a Project,
    pub(super) scene: Option<&'a Arc<Scene>>,
    /// Size of the plane; its longer side is 1.
    pub(super) extent: Vec2,
    pub(super) layout: TextureLayout,
    /// How the picture without caustics is made.
    pub(super) background: BackgroundQuality,
    /// Whether coverage and depth of the surfaces are wanted.
    pub(super) surfaces: bool,
    /// Results of an earlier process, where there may be some.
    pub(super) bake: Option<&'a Bake>,
}

/// How the picture without caustics is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BackgroundQuality {
    /// Not at all: it is black, and nothing is traced.
    None,
    /// Noisy, for a live preview.
    Rough,
    /// Sampled until its noise is low.
    Final,
}

impl<'a> CameraView<'a> {
    /// The view of a render of a prepared project.
    pub(super) fn of_render(prepared: &'a Prepared) -> Self {
        let Prepared { project, extent, .. } = prepared;
        let layout = prepared.layout();
        let shown = project.output.shows_background();
        let background = if shown { BackgroundQuality::Final } else { BackgroundQuality::None };
        let surfaces = project.output.shows_surfaces();
        let bake = prepared.bake.as_deref();
        Self { project, scene: prepared.scene.as_ref(), extent: *extent, layout, background, surfaces, bake }
    }
}

/// What the camera sees apart from the light that flows.
#[derive(Clone)]
pub(super) struct CameraPictures {
    /// The texels that each pixel sees.
    pub(super) visible: Arc<GatherMatrix>,
    /// The picture without caustics.
    pub(super) background: Arc<Background>,
    /// Coverage and depth, where they are wanted and there is a scene.
    pub(super) first_hits: Option<Arc<FirstHits>>,
    /// Absent without a scene.
    pub(super) still: Option<Arc<StillLight>>,
}

impl CameraPictures {
    /// The caustics at a moment, from the texture of all light that flows.
    pub(super) fn caustic(&self, light: &ReceiverTexture, moment: SegmentTime) -> Image {
        let mut caustic = self.visible.gather(light);
        self.add_still(&mut caustic, None, moment);
        caustic
    }

    /// Adds the light that does not flow to a picture of caustics: that of one group of photons, which must be apart, or of all.
    pub(super) fn add_still(&self, caustic: &mut Image, group: Option<usize>, moment: SegmentTime) {
        self.still.iter().for_each(|still| still.add_to(caustic, group, moment));
    }
}

impl Stages {
    /// The camera's pictures.
    ///
    /// # Errors
    /// `Cancelled`.
    pub(super) fn look(
        &self,
        slot: Slot,
        view: &CameraView,
        meter: &Meter,
        progress: &Progress,
    ) -> Result<CameraPictures> {
        let CameraView { project, scene, extent, layout, background, surfaces, bake } = *view;
        let (render, seed) = (&project.render, project.seed);
        // Photons change nothing here but the layout, and the view transform and the plate change nothing at all.
        let seen =
            RenderSettings { passes: 1, photons: 1, view: Default::default(), plate: None, ..render.clone() };
        let rough = background == BackgroundQuality::Rough;
        let input = ViewInput { scene: scene.map(Same::of), render: seen, extent, seed, layout: None, rough };
        let exact = ViewInput { rough: false, ..input.clone() };
        let visible = ViewInput { layout: Some(layout), ..exact.clone() };
        let visible = self.visible.get(slot, visible, progress, |_| {
            let make = || match scene {
                Some(scene) => GatherMatrix::through_camera(scene, &layout, render, seed, progress),
                None => GatherMatrix::flat(extent, &layout, render, progress),
            };
            meter.measure("visible", || baked(bake, "visible", make)).map(Arc::new)
        })?;
        let first_hits = scene.filter(|_| surfaces).map(|scene| {
            let size = [render.width as usize, render.height as usize];
            let make = || FirstHits::new(scene, size, seed, progress);
            let make = || baked(bake, "surfaces", make).map(Arc::new);
            self.first_hits.get(slot, exact, progress, |_| meter.measure("visible", make))
        });
        // A plate covers the whole frame.
        let covered = render.plate.is_some() && background != BackgroundQuality::None;
        let first_hits =
            first_hits.transpose()?.map(|hits| if covered { Arc::new(hits.all_covered()) } else { hits });
        let background = self.without_caustics(slot, view, input.clone(), meter, progress)?;
        let still = match scene {
            Some(scene) if project.traces() => {
                match self.still_light((slot, bake), (scene, project), input, meter, progress) {
                    Ok(still) => Some(still),
                    // A scene that casts no caustic can be looked at while it is built.
                    Err(error) if !rough || matches!(error, Error::Cancelled) => return Err(error),
                    Err(_) => None,
                }
            }
            _ => None,
        };
        Ok(CameraPictures { visible, background, first_hits, still })
    }

    /// The picture without caustics.
    fn without_caustics(
        &self,
        slot: Slot,
        &CameraView { project, scene, background: quality, bake, .. }: &CameraView,
        input: ViewInput,
        meter: &Meter,
        progress: &Progress,
    ) -> Result<Arc<Background>> {
        let Project { render, seed, .. } = project;
        let plate = match quality {
            BackgroundQuality::None => None,
            BackgroundQuality::Rough | BackgroundQuality::Final => self.plate(slot, render, progress)?,
        };
        if let Some(plate) = plate {
            let image = plate.image.clone();
            return Ok(Arc::new(Background { image, clamped: Default::default() }));
        }
        match scene.filter(|_| quality != BackgroundQuality::None) {
            None => {
                let image = Image::new(render.width as usize, render.height as usize);
                Ok(Arc::new(Background { image, clamped: Default::default() }))
            }
            Some(scene) => self.backgrounds.get(slot, input, progress, |_| {
                let make = || match (quality, bake) {
                    (BackgroundQuality::Rough, _) => rough_background(scene, render, *seed, progress),
                    (_, None) => background(scene, render, *seed, progress),
                    (_, Some(bake)) => {
                        // Damaged samples are traced anew.
                        let kept = bake.read(SAMPLES).unwrap_or_default();
                        let keep = |samples: &BackgroundSamples| bake.replace(SAMPLES, samples);
                        background_from(kept, scene, render, *seed, (&keep, KEPT_EVERY), progress)
                    }
                };
                let background = meter.measure("background", || baked(bake, "background", make))?;
                bake.map_or(Ok(()), |bake| bake.remove(SAMPLES))?;
                Ok(Arc::new(background))
            }),
        }
    }

    /// The light that does not flow.
    fn still_light(
        &self,
        (slot, bake): (Slot, Option<&Bake>),
        (scene, project): (&Arc<Scene>, &Project),
        view: ViewInput,
        meter: &Meter,
        progress: &Progress,
    ) -> Result<Arc<StillLight>> {
        let grouping = Grouping::resolve(project, Some(scene))?;
        let shares = shares(project, &grouping);
        let photons = (project.render.photons, project.render.passes);
        let apart = project.output.separates_caustics();
        let (caustics, on_plane) = (project.caustics.clone(), project.output.shows_plane());
        let input = StillInput { view, photons, caustics, shares, apart, on_plane };
        self.still.get(slot, input, progress, |StillInput { shares, .. }| {
            let make = || StillLight::new(scene, project, (&grouping, shares), progress);
            meter.measure("still", || baked(bake, "still", make)).map(Arc::new)
        })
    }
}
