//! The orbit view: the scene through any camera, lit by a lamp at the eye.

use std::sync::Arc;

use crate::engine::Engine;
use crate::project::Project;
use crate::render::{Image, OrbitLight, PlaneView, ReceiverTexture, orbit_image};
use crate::scene::{CameraDesc, ReceiverDesc, Scene, SceneDesc};
use crate::{Progress, Result};

/// A picture of the scene through any camera.
#[derive(Clone)]
pub struct OrbitView {
    /// Linear light, to be shown at the project's exposure.
    pub image: Image,
    /// The scene in it, for ray queries.
    pub scene: Arc<Scene>,
    /// Projection of plane points to pixels.
    pub plane: PlaneView,
}

impl Engine {
    /// The scene through `camera` in `size` pixels, with `light` on the receiver. A project without scene shows its plane,
    /// one metre along the longer side, facing up.
    ///
    /// # Errors
    /// The place of the first value of scene or camera that cannot be used, or a mesh that cannot be read; cancelled.
    pub fn orbit_view(
        &self,
        project: &Project,
        camera: &CameraDesc,
        size: [u32; 2],
        light: Option<&ReceiverTexture>,
        progress: &Progress,
    ) -> Result<OrbitView> {
        let camera = camera.resolve("camera")?;
        let bare;
        let desc = match &project.scene {
            Some(desc) => desc,
            None => {
                project.check()?;
                let receiver = ReceiverDesc { size: project.plane.extent().to_array(), ..Default::default() };
                bare = SceneDesc { receiver, ..Default::default() };
                &bare
            }
        };
        let ((scene, _), _) = self.stages.scene(self.client, desc, progress)?;
        let lamp = (-project.render.view.exposure).exp2();
        let image = orbit_image(&scene, &camera, size, OrbitLight { caustic: light, lamp }, progress)?;
        Ok(OrbitView { image, plane: PlaneView::through(camera, scene.receiver().clone()), scene })
    }
}
