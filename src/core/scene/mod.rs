//! The scene (Sec. 2): meshes, materials, lights, camera, receiver.
//!
//! [`SceneDesc`] is the saved description; [`Scene::load`] resolves it once into checked world-space geometry for the photon
//! tracer and the renderer. World space is in metres, right-handed, Y up.

pub mod camera;
pub mod environment;
pub mod gltf;
pub mod light;
pub mod material;
pub mod mesh;
pub mod receiver;

mod accel;
mod check;
mod contact;
mod geometry;
mod media;
mod object;
mod resolve;
mod sunk;
mod surface;

use std::sync::Arc;

use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use camera::CameraDesc;
pub use environment::EnvironmentDesc;
pub use geometry::Geometry;
pub use light::{LightDesc, Sphere};
pub use material::Material;
pub use media::Media;
pub use mesh::MeshDesc;
pub use object::Mesh;
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
    /// The triangles that lie in the plane of the receiver; none in most scenes.
    on_receiver: Option<contact::OnReceiver>,
    /// Whether anything touches, so that hits need a second look.
    has_contacts: bool,
}

impl Scene {
    /// The geometry of its meshes.
    pub fn geometry(&self) -> &Arc<Geometry> {
        &self.geometry
    }

    /// The nearest surface along the ray: a mesh, the receiver or the floor around it.
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        if self.has_contacts {
            return self.intersect_in_contact(ray);
        }
        self.nearest(ray)
    }

    #[inline]
    fn nearest(&self, ray: &Ray) -> Option<Hit> {
        let floor = self.receiver.intersect(ray);
        let limit = floor.map_or(f32::INFINITY, |(t, _)| t);
        let hit = self.geometry.intersect(ray, limit);
        hit.or_else(|| floor.map(|floor| self.receiver.hit(floor)))
    }

    /// As [`Self::intersect`] in a scene in which something touches: triangles that lie on the receiver or its floor are the
    /// receiver or its floor.
    #[cold]
    fn intersect_in_contact(&self, ray: &Ray) -> Option<Hit> {
        let mut found = self.nearest(ray).map(|hit| self.geometry.known(hit));
        let Some(on) = &self.on_receiver else { return found };
        let mut passed = 0.0;
        // More than one only by rounding, at an edge.
        for _ in 0..8 {
            let hit = found.filter(|hit| on.contains(hit));
            let Some((hit, floor)) = hit.and_then(|hit| Some((hit, self.receiver.hit_at(&hit)?))) else {
                break;
            };
            if ray.from != Primitive::FLOOR {
                return Some(floor);
            }
            passed += hit.t;
            let next = self.geometry.intersect(&Ray::leaving(&hit, ray.direction), f32::INFINITY);
            found = next.map(|hit| self.geometry.known(hit));
        }
        found.map(|hit| Hit { t: passed + hit.t, ..hit })
    }

    /// Whether any mesh, glass included, blocks the ray before `distance` (m). The floor never does.
    pub fn occluded(&self, ray: &Ray, distance: f32) -> bool {
        if self.on_receiver.is_some() && ray.from == Primitive::FLOOR {
            return self.intersect(ray).is_some_and(|hit| hit.t <= distance);
        }
        self.geometry.occluded(ray, distance)
    }

    /// The glass solids that contain `point`.
    pub fn media_at(&self, point: Vec3) -> Media {
        let mut media = Media::default();
        let ray = Ray::new(point, Vec3::new(0.37139, 0.80178, 0.46812).normalize());
        let mut depth = vec![0_i32; self.meshes().len()];
        self.geometry
            .each_crossing(&ray, |mesh, leaving| depth[mesh as usize] += if leaving { 1 } else { -1 });
        for (mesh, crossings) in depth.iter().enumerate() {
            if *crossings > 0 && matches!(self.meshes()[mesh].material, Material::Glass(_)) {
                media.enter(mesh as u16);
            }
        }
        media
    }

    /// The material of a surface.
    pub fn material(&self, surface: SurfaceId) -> &Material {
        match self.mesh_of(surface) {
            Some(mesh) => &self.meshes()[mesh as usize].material,
            None => self.receiver.material(),
        }
    }

    /// The mesh that a surface belongs to, where several lie in one another the one that stands for them; none for the
    /// receiver and the floor.
    #[inline]
    pub fn mesh_of(&self, surface: SurfaceId) -> Option<u16> {
        self.geometry.mesh_of(surface)
    }

    /// All meshes; a [`SurfaceId::Mesh`] and the mesh column of the photons index this.
    pub fn meshes(&self) -> &[Mesh] {
        self.geometry.meshes()
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
