//! The rectangle on which the caustics fall, and its two-dimensional coordinates.
//!
//! Plane coordinates: the longer side is 1, the origin is a corner, x runs along the width and y along the height of
//! the rectangle. Unrotated, the receiver is horizontal: plane x is world +x, plane y is world -z, its normal +y.

use glam::{EulerRot, Quat, Vec2, Vec3, vec2};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::material::{Diffuse, Material};
use super::{Hit, Primitive, Ray, SurfaceId, check};
use crate::Result;

/// The receiving rectangle as saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ReceiverDesc {
    /// The middle of the rectangle, world [m]. Default the origin.
    pub centre: [f32; 3],
    /// Width and height [m], each 1e-4 to 1e5. Default (1, 1).
    pub size: [f32; 2],
    /// Turn about the X, then Y, then Z axis in degrees. Default none: horizontal, facing up.
    pub rotate: [f32; 3],
    /// Share of light it gives back, linear Rec.709, 0 to 1. Default 0.8.
    pub albedo: [f32; 3],
    /// How much further the floor reaches around the rectangle in the picture [m], 0 to 1e5. Default 0.
    pub surround: f32,
}

impl Default for ReceiverDesc {
    fn default() -> Self {
        Self { centre: [0.0; 3], size: [1.0; 2], rotate: [0.0; 3], albedo: [0.8; 3], surround: 0.0 }
    }
}

impl ReceiverDesc {
    /// Refuses an empty rectangle, an albedo above 1 and non-finite values.
    pub fn check(&self, place: &str) -> Result<()> {
        check::within(place, "centre", &self.centre, -1e6, 1e6)?;
        check::within(place, "size", &self.size, 1e-4, 1e5)?;
        check::within(place, "rotate", &self.rotate, -36_000.0, 36_000.0)?;
        check::within(place, "albedo", &self.albedo, 0.0, 1.0)?;
        check::within(place, "surround", &[self.surround], 0.0, 1e5)
    }

    /// Width and height in plane units; the longer is 1.
    pub fn extent(&self) -> Vec2 {
        Vec2::from(self.size) / self.size[0].max(self.size[1])
    }

    pub(super) fn resolve(&self, place: &str) -> Result<Receiver> {
        self.check(place)?;
        let [x, y, z] = self.rotate.map(f32::to_radians);
        // Intrinsic Z, Y, X is extrinsic X, then Y, then Z.
        let turn = Quat::from_euler(EulerRot::ZYX, z, y, x);
        let (x_axis, y_axis) = (turn * Vec3::X, turn * Vec3::NEG_Z);
        let [width, height] = self.size;
        let corner = Vec3::from(self.centre) - x_axis * (width / 2.0) - y_axis * (height / 2.0);
        let unit = width.max(height);
        Ok(Receiver {
            corner,
            x_axis,
            y_axis,
            normal: turn * Vec3::Y,
            unit,
            extent: self.extent(),
            surround: self.surround / unit,
            material: Material::Diffuse(Diffuse { albedo: self.albedo }),
        })
    }
}

/// The resolved receiver.
#[derive(Clone, Debug, PartialEq)]
pub struct Receiver {
    corner: Vec3,
    x_axis: Vec3,
    y_axis: Vec3,
    normal: Vec3,
    unit: f32,
    extent: Vec2,
    surround: f32,
    material: Material,
}

impl Receiver {
    /// Width and height in plane units; the longer is 1.
    pub fn extent(&self) -> Vec2 {
        self.extent
    }

    /// Metres per plane unit: the longer side.
    pub fn metres_per_plane_unit(&self) -> f32 {
        self.unit
    }

    /// Unit normal of the lit side.
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// Its diffuse material, also that of the floor.
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// The world point [m] of a plane point.
    pub fn world_from_plane(&self, point: Vec2) -> Vec3 {
        self.corner + self.x_axis * (point.x * self.unit) + self.y_axis * (point.y * self.unit)
    }

    /// The orthogonal projection of a world point [m] to the plane.
    pub fn plane_from_world(&self, point: Vec3) -> Vec2 {
        let offset = point - self.corner;
        vec2(offset.dot(self.x_axis), offset.dot(self.y_axis)) / self.unit
    }

    /// The intersection of a ray with the plane, also beyond the rectangle; none for a ray away from it.
    pub fn plane_from_ray(&self, ray: &Ray) -> Option<Vec2> {
        let t = (self.corner - ray.origin).dot(self.normal) / ray.direction.dot(self.normal);
        (t > 0.0 && t < f32::INFINITY).then(|| self.plane_from_world(ray.origin + ray.direction * t))
    }

    /// Whether a plane point lies on the rectangle.
    pub fn contains(&self, point: Vec2) -> bool {
        point.cmpge(Vec2::ZERO).all() && point.cmple(self.extent).all()
    }

    /// Lower and upper world corner of the rectangle and the floor around it [m].
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let s = Vec2::splat(self.surround);
        let far = self.extent + s;
        let corners = [-s, vec2(far.x, -s.y), vec2(-s.x, far.y), far].map(|p| self.world_from_plane(p));
        (
            corners.into_iter().reduce(Vec3::min).unwrap_or(self.corner),
            corners.into_iter().reduce(Vec3::max).unwrap_or(self.corner),
        )
    }

    pub(super) fn intersect(&self, ray: &Ray) -> Option<Hit> {
        if ray.from == Primitive::FLOOR {
            return None;
        }
        let t = (self.corner - ray.origin).dot(self.normal) / ray.direction.dot(self.normal);
        if !(t > 0.0 && t < f32::INFINITY) {
            return None;
        }
        let plane = self.plane_from_world(ray.origin + ray.direction * t);
        let reach = Vec2::splat(self.surround);
        let surface = if self.contains(plane) {
            SurfaceId::Receiver
        } else if plane.cmpge(-reach).all() && plane.cmple(self.extent + reach).all() {
            SurfaceId::Floor
        } else {
            return None;
        };
        Some(Hit {
            t,
            point: self.world_from_plane(plane),
            geometric_normal: self.normal,
            shading_normal: self.normal,
            surface,
            primitive: Primitive::FLOOR,
        })
    }
}
