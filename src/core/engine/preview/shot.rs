//! The project's camera without photons: the picture without caustics, to which the light of a preview is added.

use super::Preview;
use super::light::{finest_radius, margin};
use crate::engine::camera::{BackgroundQuality, CameraPictures, CameraView};
use crate::engine::memo::Slot;
use crate::engine::meter::Meter;
use crate::engine::{Engine, Quality};
use crate::project::Project;
use crate::render::{Image, PlaneView, ReceiverTexture, RenderSettings, TextureLayout, layout_for};
use crate::{Progress, Result};

/// The picture of the project's camera without caustics, and the points of the receiver that its pixels see.
#[derive(Clone)]
pub struct Shot {
    camera: CameraPictures,
    /// Projection of plane points to pixels.
    pub plane: PlaneView,
}

/// Most photons of the light that does not flow.
const MOST_PHOTONS: u64 = 150_000;

impl Shot {
    /// The layout of the texture that the camera sees.
    pub fn layout(&self) -> &TextureLayout {
        self.camera.visible.layout()
    }

    /// Texels along the longer side of the receiver: the resolution that a [`super::PreviewExposure`] for it needs.
    pub fn resolution(&self) -> usize {
        self.layout().texel.recip().round() as usize
    }

    /// The picture without caustics, linear.
    pub fn background(&self) -> &Image {
        &self.camera.background.image
    }

    /// The picture with the light of a texture at a frame of a preview, linear. None for a texture of another resolution or
    /// receiver.
    pub fn picture(&self, light: &ReceiverTexture, preview: &Preview, frame: i32) -> Option<Image> {
        let fits = light.layout() == self.layout();
        fits.then(|| self.camera.background.image.plus(&self.camera.caustic(light, preview.moment(frame))))
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
            photons: project.render.photons.min(MOST_PHOTONS),
            passes: 1,
            ..project.render.clone()
        };
        let project = &Project { render, ..project.clone() };
        project.check()?;
        let scene = match &project.scene {
            Some(desc) => Some(self.stages.scene(self.client, desc, progress)?.0.0),
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
            surfaces: false,
            bake: None,
        };
        let slot = Slot { client: self.client, quality: Quality::Preview, index: 0 };
        let camera = self.stages.look(slot, &view, &Meter::quick(), progress)?;
        Ok(Shot { camera, plane: PlaneView::new(scene.as_deref(), extent) })
    }
}
