//! What the project's camera sees, and any other: without photons, to lay light into.

use std::sync::Arc;

use super::Sketcher;
use super::exposure::{finest_radius, margin};
use crate::engine::meter::Meter;
use crate::engine::seen::Seen;
use crate::project::Project;
use crate::render::{
    Image, LookLight, Mark, PlaneView, ReceiverTexture, RenderSettings, TextureLayout, Visible, layout_for,
    look, marks, rough_background,
};
use crate::scene::{CameraDesc, Geometry, ReceiverDesc, Scene, SceneDesc};
use crate::{Progress, Result};

/// What the project's camera sees: the picture without caustics, and where each pixel sees the receiver.
#[derive(Clone)]
pub struct Shot {
    /// Linear light, without caustics.
    pub background: Arc<Image>,
    /// Where the camera sees points of the plane.
    pub plane: PlaneView,
    visible: Arc<Visible>,
}

impl Shot {
    /// The texture that it looks at.
    pub fn layout(&self) -> &TextureLayout {
        self.visible.layout()
    }

    /// Texels along the longer side of the receiver: what a [`super::Exposure`] for it is to have.
    pub fn resolution(&self) -> usize {
        self.layout().texel.recip().round() as usize
    }

    /// The picture with the light of a texture, linear. None for a texture of another resolution or receiver.
    pub fn picture(&self, light: &ReceiverTexture) -> Option<Image> {
        let fits = light.layout() == self.layout();
        fits.then(|| self.background.plus(&self.visible.gather(light)))
    }
}

/// A look at the scene from anywhere.
#[derive(Clone)]
pub struct Look {
    /// Linear light, to be shown at the project's exposure.
    pub image: Image,
    /// The lights and the project's camera.
    pub marks: Vec<Mark>,
    /// Where points of the plane are seen.
    pub plane: PlaneView,
}

/// The camera's stages, and a plane without a scene.
#[derive(Default)]
pub(super) struct Views {
    seen: Seen,
    empty: Option<Arc<Geometry>>,
}

impl Sketcher {
    /// What the project's camera sees in a picture of `size` pixels, with so many light paths and camera samples per
    /// pixel: noisy with few, and ready at once. Remembered until the scene, the size or the samples change.
    ///
    /// # Errors
    /// As a render of the project; cancelled.
    pub fn shot(
        &mut self,
        project: &Project,
        size: [u32; 2],
        samples: u32,
        progress: &Progress,
    ) -> Result<Shot> {
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
            Some(desc) => Some(self.loader.scene(desc, &mut Vec::new(), progress)?),
            None => None,
        };
        let extent = scene.as_ref().map_or_else(|| project.plane.extent(), |s| s.receiver().extent());
        let radii = (margin(extent), finest_radius(extent));
        let layout = layout_for(scene.as_deref(), extent, &project.render, radii);
        let mut meter = Meter::quick();
        let plane = (extent, layout);
        let (visible, background) =
            self.views.seen.look(project, scene.as_ref(), plane, rough_background, &mut meter, progress)?;
        Ok(Shot { background, plane: PlaneView::new(scene.as_deref(), extent), visible })
    }

    /// The scene through any camera in a picture of `size` pixels, lit by a lamp at the eye, with `light` on the receiver.
    /// A project without scene shows its plane, one metre along the longer side, facing up.
    ///
    /// # Errors
    /// The place of the first value of scene or camera that cannot be used, or a mesh that cannot be read; cancelled.
    pub fn look(
        &mut self,
        project: &Project,
        camera: &CameraDesc,
        size: [u32; 2],
        light: Option<&ReceiverTexture>,
        progress: &Progress,
    ) -> Result<Look> {
        let camera = camera.resolve("camera")?;
        let scene = match &project.scene {
            Some(desc) => self.loader.scene(desc, &mut Vec::new(), progress)?,
            None => self.views.plane_alone(project, progress)?,
        };
        let lamp = (-project.render.view.exposure).exp2();
        let image = look(&scene, &camera, size, LookLight { caustic: light, lamp }, progress)?;
        let marks = match &project.scene {
            Some(_) => marks(&scene, &camera, size),
            None => Vec::new(),
        };
        Ok(Look { image, marks, plane: PlaneView::through(camera, scene.receiver().clone()) })
    }
}

impl Views {
    /// A scene of nothing but the plane.
    fn plane_alone(&mut self, project: &Project, progress: &Progress) -> Result<Arc<Scene>> {
        project.check()?;
        let geometry = match &self.empty {
            Some(geometry) => geometry.clone(),
            None => {
                let nothing = |_: &str, _: &str| Ok(std::path::PathBuf::new());
                Arc::new(Geometry::load(&[], &nothing, progress)?.0)
            }
        };
        self.empty = Some(geometry.clone());
        let receiver = ReceiverDesc { size: project.plane.extent().to_array(), ..Default::default() };
        Ok(Arc::new(Scene::with(&SceneDesc { receiver, ..Default::default() }, geometry)?.0))
    }
}
