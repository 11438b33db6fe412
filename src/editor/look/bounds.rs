//! Bounds of objects: those of a mesh are taken from the last scene that was loaded, and follow its transform since.

use glam::{BVec3, DMat3, DVec3, EulerRot, Vec3};
use lightloom_core::project::Project;
use lightloom_core::scene::mesh::Transform;
use lightloom_core::scene::{LightDesc, Scene, SceneDesc};

use super::lamp;
use super::object::SceneObject;

/// The last scene that was loaded, and the project it was loaded from.
#[derive(Clone, Copy)]
pub struct Loaded<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its project.
    pub project: &'a Project,
}

/// Turn with scale, and offset, of a transform.
fn placement(transform: &Transform) -> (DMat3, DVec3) {
    let [x, y, z] = transform.rotate.map(|degrees| f64::from(degrees).to_radians());
    let turn = DMat3::from_euler(EulerRot::ZYX, z, y, x);
    (turn * f64::from(transform.scale), transform.translate.into())
}

impl Loaded<'_> {
    /// The eight corners of the box around a mesh of `scene`, by the bits of their index x, y, z; none where it was not loaded.
    pub fn corners(&self, scene: &SceneDesc, index: usize) -> Option<[Vec3; 8]> {
        let (mesh, old) = (scene.meshes.get(index)?, self.project.scene.as_ref()?.meshes.get(index)?);
        if mesh.file != old.file {
            return None;
        }
        let parts = || self.scene.meshes().iter().filter(|part| part.desc == index);
        let lower = parts().map(|part| part.lower).reduce(Vec3::min)?;
        let upper = parts().map(|part| part.upper).reduce(Vec3::max)?;
        let ((was, from), (is, to)) = (placement(&old.transform), placement(&mesh.transform));
        let back = was.inverse();
        let corner = |i: usize| {
            let corner = Vec3::select(BVec3::new(i & 1 != 0, i & 2 != 0, i & 4 != 0), upper, lower);
            (is * (back * (corner.as_dvec3() - from)) + to).as_vec3()
        };
        Some(std::array::from_fn(corner))
    }
}

/// The centre and the longer side of the receiver (m).
fn table(scene: &SceneDesc) -> (Vec3, f32) {
    (scene.receiver.centre.into(), scene.receiver.size[0].max(scene.receiver.size[1]))
}

/// Where the handle of a light is drawn: a directional one stands before the receiver.
pub fn lamp_place(scene: &SceneDesc, light: &LightDesc) -> Vec3 {
    let (centre, side) = table(scene);
    match light {
        LightDesc::Directional(sun) => {
            centre - Vec3::from(sun.direction).normalize_or(Vec3::NEG_Y) * 0.9 * side
        }
        _ => light.position().unwrap_or(centre),
    }
}

/// The point about which an object is turned and scaled, and where its handles are. None of an object that the scene does not
/// have.
pub fn pivot(scene: &SceneDesc, object: SceneObject, loaded: Option<Loaded>) -> Option<Vec3> {
    Some(match object {
        SceneObject::Mesh(index) => {
            let transform = &scene.meshes.get(index)?.transform;
            match loaded.and_then(|loaded| loaded.corners(scene, index)) {
                Some(corners) => (corners[0] + corners[7]) / 2.0,
                None => DVec3::from(transform.translate).as_vec3(),
            }
        }
        SceneObject::Light(index) => lamp_place(scene, scene.lights.get(index)?),
        SceneObject::LightTarget(index) => lamp::target(scene.lights.get(index)?)?,
        SceneObject::Camera => scene.camera.position.into(),
        SceneObject::CameraTarget => scene.camera.look_at.into(),
        SceneObject::Receiver => scene.receiver.centre.into(),
    })
}

/// Centre and radius of a sphere around an object, to frame it.
pub fn sphere(scene: &SceneDesc, object: SceneObject, loaded: Option<Loaded>) -> Option<(Vec3, f32)> {
    let centre = pivot(scene, object, loaded)?;
    let (_, side) = table(scene);
    let radius = match object {
        SceneObject::Mesh(index) => {
            let corners = loaded.and_then(|loaded| loaded.corners(scene, index));
            corners.map_or(0.2 * side, |corners| corners[0].distance(corners[7]) / 2.0)
        }
        SceneObject::Receiver => 0.7 * side,
        _ => 0.2 * side,
    };
    Some((centre, radius.max(1e-4)))
}
