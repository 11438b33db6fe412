//! Rays and surface hits.

use glam::Vec3;

/// The identity of a triangle or the floor. A ray that starts on a surface skips it by this; an offset origin instead would
/// bias the flux (3e-4 of a sphere's transmitted light).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Primitive(pub(super) u32);

impl Primitive {
    /// No surface: the ray starts in the open.
    pub const NONE: Self = Self(u32::MAX);
    /// The plane of the receiver and the floor.
    pub(super) const FLOOR: Self = Self(u32::MAX - 1);

    /// The number of a triangle of a mesh: neighbours in space have near numbers.
    pub(crate) fn index(self) -> u32 {
        self.0
    }
}

/// A half-line, world space (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Its origin.
    pub origin: Vec3,
    /// Unit vector.
    pub direction: Vec3,
    /// The surface it starts on.
    pub from: Primitive,
}

impl Ray {
    /// A ray that starts in the open.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, from: Primitive::NONE }
    }

    /// A ray that leaves the surface of a hit.
    pub fn leaving(hit: &Hit, direction: Vec3) -> Self {
        Self { origin: hit.point, direction, from: hit.primitive }
    }
}

/// The object of a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SurfaceId {
    /// An index into [`super::Scene::meshes`].
    Mesh(u16),
    /// A place where several meshes lie in one another; a number of the scene's own.
    Contact(u16),
    /// The receiver's rectangle.
    Receiver,
    /// The floor around the receiver; of the same material.
    Floor,
}

impl SurfaceId {
    /// Whether it is the receiver or the floor around it.
    pub fn is_ground(self) -> bool {
        matches!(self, Self::Receiver | Self::Floor)
    }
}

/// The hit of a ray on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the ray's origin (m).
    pub t: f32,
    /// World (m); computed on the surface, not along the ray.
    pub point: Vec3,
    /// Unit normal of the triangle, by its winding (outward); not turned towards the ray.
    pub geometric_normal: Vec3,
    /// Unit normal interpolated between the vertices, on the same side as the geometric one.
    pub shading_normal: Vec3,
    /// The object.
    pub surface: SurfaceId,
    /// Its identity, for [`Ray::leaving`].
    pub primitive: Primitive,
}
