//! The camera's stages: the visible points of the receiver, and the picture without caustics. Photons change neither.

use std::sync::Arc;

use glam::Vec2;

use super::memo::{Same, Slot};
use super::memo_keys::ViewInput;
use super::meter::Meter;
use super::prepare::Prepared;
use super::stages::Stages;
use crate::project::Project;
use crate::render::density::radius_of_pass;
use crate::render::{
    FirstHits, GatherMatrix, Image, RenderSettings, TextureLayout, background, first_radius, layout_for,
    rough_background,
};
use crate::scene::Scene;
use crate::{Progress, Result};

/// A project's camera, receiver and the texture that lies on it.
pub(super) struct CameraView<'a> {
    pub(super) project: &'a Project,
    pub(super) scene: Option<&'a Arc<Scene>>,
    /// Size of the plane; its longer side is 1.
    pub(super) extent: Vec2,
    pub(super) layout: TextureLayout,
    /// How the picture without caustics is made.
    pub(super) background: BackgroundQuality,
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
        let Prepared { project, extent, plan, .. } = prepared;
        let first = first_radius(&project.render, *extent);
        let radii = (first, radius_of_pass(first, plan.passes - 1));
        let layout = layout_for(prepared.scene.as_deref(), *extent, &project.render, radii);
        let shown = project.output.shows_background();
        let background = if shown { BackgroundQuality::Final } else { BackgroundQuality::None };
        Self { project, scene: prepared.scene.as_ref(), extent: *extent, layout, background }
    }
}

impl Stages {
    /// Coverage and depth of what the camera sees; none without a scene, and where no file asks for them.
    ///
    /// # Errors
    /// `Cancelled`.
    pub(super) fn first_hits(
        &self,
        slot: Slot,
        prepared: &Prepared,
        meter: &Meter,
        progress: &Progress,
    ) -> Result<Option<Arc<FirstHits>>> {
        let Project { render, output, seed, .. } = &prepared.project;
        let Some(scene) = prepared.scene.as_ref().filter(|_| output.shows_surfaces()) else {
            return Ok(None);
        };
        let size = [render.width as usize, render.height as usize];
        let input = (Same::of(scene), size, *seed);
        let made = self.first_hits.get(slot, input, progress, |_| {
            meter.measure("visible", || FirstHits::new(scene, size, *seed, progress).map(Arc::new))
        });
        made.map(Some)
    }

    /// The texels that each pixel of the camera sees, and the picture without caustics.
    ///
    /// # Errors
    /// `Cancelled`.
    pub(super) fn look(
        &self,
        slot: Slot,
        view: &CameraView,
        meter: &Meter,
        progress: &Progress,
    ) -> Result<(Arc<GatherMatrix>, Arc<Image>)> {
        let CameraView { project, scene, extent, layout, background: quality } = *view;
        let (render, seed) = (&project.render, project.seed);
        // Photons change nothing here but the layout, and the view transform changes nothing at all.
        let seen = RenderSettings { passes: 1, photons: 1, view: Default::default(), ..render.clone() };
        let input = ViewInput {
            scene: scene.map(Same::of),
            render: seen,
            extent,
            seed,
            layout: None,
            rough: quality == BackgroundQuality::Rough,
        };
        let visible = ViewInput { layout: Some(layout), rough: false, ..input.clone() };
        let visible = self.visible.get(slot, visible, progress, |_| {
            meter.measure("visible", || match scene {
                Some(scene) => {
                    GatherMatrix::through_camera(scene, &layout, render, seed, progress).map(Arc::new)
                }
                None => GatherMatrix::flat(extent, &layout, render, progress).map(Arc::new),
            })
        })?;
        let background = match scene.filter(|_| quality != BackgroundQuality::None) {
            None => Arc::new(Image::new(render.width as usize, render.height as usize)),
            Some(scene) => self.backgrounds.get(slot, input, progress, |_| {
                let draw = if quality == BackgroundQuality::Rough { rough_background } else { background };
                meter.measure("background", || draw(scene, render, seed, progress).map(Arc::new))
            })?,
        };
        Ok((visible, background))
    }
}
