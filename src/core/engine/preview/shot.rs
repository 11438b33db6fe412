//! The project's camera without photons: the picture without caustics, to which the light of a preview is added.

use std::sync::Arc;

use super::light::{finest_radius, margin};
use crate::engine::camera::{BackgroundQuality, CameraView};
use crate::engine::memo::Slot;
use crate::engine::meter::Meter;
use crate::engine::{Engine, Quality};
use crate::project::Project;
use crate::render::{
    GatherMatrix, Image, PlaneView, ReceiverTexture, RenderSettings, TextureLayout, layout_for,
};
use crate::{Progress, Result};

/// The picture of the project's camera without caustics, and the points of the receiver that its pixels see.
#[derive(Clone)]
pub struct Shot {
    /// Linear light, without caustics.
    pub background: Arc<Image>,
    /// Projection of plane points to pixels.
    pub plane: PlaneView,
    visible: Arc<GatherMatrix>,
}

impl Shot {
    /// The layout of the texture that the camera sees.
    pub fn layout(&self) -> &TextureLayout {
        self.visible.layout()
    }

    /// Texels along the longer side of the receiver: the resolution that a [`super::PreviewExposure`] for it needs.
    pub fn resolution(&self) -> usize {
        self.layout().texel.recip().round() as usize
    }

    /// The picture with the light of a texture, linear. None for a texture of another resolution or receiver.
    pub fn picture(&self, light: &ReceiverTexture) -> Option<Image> {
        let fits = light.layout() == self.layout();
        fits.then(|| self.background.plus(&self.visible.gather(light)))
    }
}

impl Engine {
    /// The shot of the project's camera in `size` pixels, with `samples` light paths and camera samples per pixel: noisy
    /// with few, and ready at once. Remembered until the scene, the size or the samples change.
    ///
    /// # Errors
    /// As a render of the project; cancelled.
    pub fn shot(&self, project: &Project, size: [u32; 2], samples: u32, progress: &Progress) -> Result<Shot> {
        let render = RenderSettings {
            width: size[0],
            height: size[1],
            camera_samples: samples,
            background_samples: samples,
            ..project.render.clone()
        };
        let project = &Project { render, ..project.clone() };
        project.check()?;
        let scene = match &project.scene {
            Some(desc) => Some(self.stages.scene(self.client, desc, progress)?.0),
            None => None,
        };
        let extent = scene.as_ref().map_or_else(|| project.plane.extent(), |s| s.receiver().extent());
        let radii = (margin(extent), finest_radius(extent));
        let layout = layout_for(scene.as_deref(), extent, &project.render, radii);
        let view = CameraView {
            project,
            scene: scene.as_ref(),
            extent,
            layout,
            background: BackgroundQuality::Rough,
        };
        let slot = Slot { client: self.client, quality: Quality::Preview, index: 0 };
        let (visible, background) = self.stages.look(slot, &view, &Meter::quick(), progress)?;
        Ok(Shot { background, plane: PlaneView::new(scene.as_deref(), extent), visible })
    }
}
