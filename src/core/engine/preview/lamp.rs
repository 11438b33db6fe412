//! Where the light of one lamp of a project goes.

use crate::engine::Engine;
use crate::photon::LampLight;
use crate::project::Project;
use crate::{Progress, Result};

impl Engine {
    /// The light of the lamp of index `light`; none where the project has no such lamp.
    ///
    /// # Errors
    /// The place of the first value of the scene that cannot be used, or a mesh that cannot be read; cancelled.
    pub fn lamp_light(
        &self,
        project: &Project,
        light: usize,
        progress: &Progress,
    ) -> Result<Option<LampLight>> {
        let Some(desc) = &project.scene else { return Ok(None) };
        let ((scene, _), _) = self.stages.scene(self.client, desc, progress)?;
        LampLight::trace(&scene, light, project.seed, progress)
    }
}
