//! The objects of a scene that can be selected: one selection for the orbit view and the panels.

use lightloom_core::scene::SceneDesc;

/// An object of a scene, or the point that one looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SceneObject {
    /// A mesh, by index.
    Mesh(usize),
    /// A light, by index.
    Light(usize),
    /// The point that a light looks at, by index of the light.
    LightTarget(usize),
    /// The camera of the rendered pictures.
    Camera,
    /// The point that the camera looks at.
    CameraTarget,
    /// The receiver.
    Receiver,
}

impl SceneObject {
    /// The index of a mesh.
    pub fn mesh(self) -> Option<usize> {
        if let Self::Mesh(index) = self { Some(index) } else { None }
    }

    /// The index of a light, also that of a selected target.
    pub fn light(self) -> Option<usize> {
        if let Self::Light(index) | Self::LightTarget(index) = self { Some(index) } else { None }
    }

    /// Whether it is the camera, or what that looks at.
    pub fn is_camera(self) -> bool {
        matches!(self, Self::Camera | Self::CameraTarget)
    }

    /// Whether a scene has it.
    pub fn is_in(self, scene: &SceneDesc) -> bool {
        match self {
            Self::Mesh(index) => index < scene.meshes.len(),
            Self::Light(index) | Self::LightTarget(index) => index < scene.lights.len(),
            Self::Camera | Self::CameraTarget | Self::Receiver => true,
        }
    }

    /// Its name for messages; empty where the scene does not have it.
    pub fn name(self, scene: &SceneDesc) -> String {
        let light = |index: usize| scene.lights.get(index).map_or("", |light| light.name());
        match self {
            Self::Mesh(index) => scene.meshes.get(index).map_or("", |mesh| &mesh.name).to_owned(),
            Self::Light(index) => light(index).to_owned(),
            Self::LightTarget(index) => format!("target of {}", light(index)),
            Self::Camera => "camera".to_owned(),
            Self::CameraTarget => "target of the camera".to_owned(),
            Self::Receiver => "receiver".to_owned(),
        }
    }
}
