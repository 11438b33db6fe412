//! The scene (Sec. 2): meshes, materials, lights, camera, receiver.
//!
//! [`SceneDesc`] is the saved description; [`Scene::load`] resolves it once into checked world-space geometry for the photon
//! tracer and the renderer. World space is in metres, right-handed, Y up.

pub mod camera;
pub mod environment;
pub mod light;
pub mod material;
pub mod mesh;
pub mod receiver;

mod accel;
mod check;
mod geometry;
mod media;
mod resolve;
mod surface;

use std::sync::Arc;

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use camera::CameraDesc;
pub use environment::EnvironmentDesc;
pub use geometry::{Geometry, Mesh};
pub use light::{LightDesc, Sphere};
pub use material::Material;
pub use media::Media;
pub use mesh::MeshDesc;
pub use receiver::{Receiver, ReceiverDesc};
pub use surface::{Hit, Primitive, Ray, SurfaceId};

use crate::Result;

/// What is lit, as saved in a project.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SceneDesc {
    /// Objects, at most 65 535 after splitting by material. Glass and mirrors cast the caustics.
    pub meshes: Vec<MeshDesc>,
    /// Light sources, at most 65 535. Default: none.
    pub lights: Vec<LightDesc>,
    /// From where the picture is taken.
    pub camera: CameraDesc,
    /// The rectangle on which the caustics fall and are animated.
    pub receiver: ReceiverDesc,
    /// The sky that the camera, glass and mirrors see; it casts no caustics.
    pub environment: EnvironmentDesc,
}

impl SceneDesc {
    /// The camera and the receiver, which need no file.
    ///
    /// # Errors
    /// A camera without a direction, a receiver without size.
    pub fn camera_and_receiver(&self) -> Result<(camera::Camera, Receiver)> {
        Ok((self.camera.resolve("scene.camera")?, self.receiver.resolve("scene.receiver")?))
    }
}

/// A scene resolved from its description: checked, in world space, ready for ray queries.
pub struct Scene {
    geometry: Arc<Geometry>,
    lights: Vec<LightDesc>,
    camera: camera::Camera,
    receiver: Receiver,
    environment: EnvironmentDesc,
}

impl Scene {
    /// The geometry of its meshes.
    pub fn geometry(&self) -> &Arc<Geometry> {
        &self.geometry
    }

    /// The nearest surface along the ray: a mesh, the receiver or the floor around it.
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let floor = self.receiver.intersect(ray);
        let limit = floor.map_or(f32::INFINITY, |(t, _)| t);
        self.geometry.accel.intersect(ray, limit).or_else(|| floor.map(|floor| self.receiver.hit(floor)))
    }

    /// Whether any mesh, glass included, blocks the ray before `distance` (m). The floor never does.
    pub fn occluded(&self, ray: &Ray, distance: f32) -> bool {
        self.geometry.accel.occluded(ray, distance)
    }

    /// The glass solids that contain `point`.
    pub fn media_at(&self, point: Vec3) -> Media {
        let mut media = Media::default();
        let ray = Ray::new(point, Vec3::new(0.37139, 0.80178, 0.46812).normalize());
        let mut depth = vec![0_i32; self.meshes().len()];
        self.geometry
            .accel
            .each_crossing(&ray, |mesh, leaving| depth[mesh as usize] += if leaving { 1 } else { -1 });
        for (mesh, crossings) in depth.iter().enumerate() {
            if *crossings > 0 && matches!(self.geometry.meshes[mesh].material, Material::Glass(_)) {
                media.enter(mesh as u16);
            }
        }
        media
    }

    /// The material of a surface.
    pub fn material(&self, surface: SurfaceId) -> &Material {
        match surface {
            SurfaceId::Mesh(mesh) => &self.geometry.meshes[mesh as usize].material,
            SurfaceId::Receiver | SurfaceId::Floor => self.receiver.material(),
        }
    }

    /// All meshes; a [`SurfaceId::Mesh`] and the mesh column of the photons index this.
    pub fn meshes(&self) -> &[Mesh] {
        &self.geometry.meshes
    }

    /// All lights, checked, in the order of the project.
    pub fn lights(&self) -> &[LightDesc] {
        &self.lights
    }

    /// The camera.
    pub fn camera(&self) -> &camera::Camera {
        &self.camera
    }

    /// The receiver: the plane of the caustics and its coordinates.
    pub fn receiver(&self) -> &Receiver {
        &self.receiver
    }

    /// The sky.
    pub fn environment(&self) -> &EnvironmentDesc {
        &self.environment
    }

    /// Lower and upper corner of everything: meshes, receiver, floor (m).
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let (mut lower, mut upper) = self.receiver.bounds();
        for mesh in self.meshes() {
            lower = lower.min(mesh.lower);
            upper = upper.max(mesh.upper);
        }
        (lower, upper)
    }
}
