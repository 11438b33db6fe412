//! The rectangle on which the caustics fall, and its two-dimensional coordinates.
//!
//! Plane coordinates: the longer side is 1, the origin is a corner, x runs along the width and y along the height of
//! the rectangle. Unrotated, the receiver is horizontal: plane x is world +x, plane y is world -z, its normal +y.

use glam::{DQuat, DVec3, EulerRot, Quat, Vec2, Vec3, vec2};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::material::{Diffuse, Material};
use super::{Hit, Primitive, Ray, SurfaceId};
use crate::Result;
use crate::math::smoothstep::smoothstep;
use crate::setting::schema::Describe;
use crate::setting::{Setting, settings};

/// The receiving rectangle as saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(transform = Describe(Self::SETTINGS))]
pub struct ReceiverDesc {
    /// Its centre, world (m).
    pub centre: [f32; 3],
    /// Width and height (m).
    pub size: [f32; 2],
    /// Turn about the X, then Y, then Z axis, degrees.
    pub rotate: [f32; 3],
    /// Share of light it gives back, linear Rec.709.
    pub albedo: [f32; 3],
    /// Width of the floor around it in the picture (m).
    pub surround: f32,
    /// Width of the soft border within it, plane units ([`Self::BORDER`]).
    pub border: f32,
}

settings! { ReceiverDesc {
    /// Centre of the rectangle on which the caustics fall, x y z.
    CENTRE = Setting::vector("scene.receiver.centre", [-1e6, 1e6], &[0.0; 3]).unit("m");
    /// Width and height of the rectangle. What was drawn keeps its place in shares of the longer side.
    SIZE = Setting::vector("scene.receiver.size", [1e-4, 1e5], &[1.0, 1.0]).unit("m");
    /// Turn about the x, then y, then z axis; without it the rectangle is horizontal and faces up.
    ROTATE = Setting::vector("scene.receiver.rotate", [-36_000.0, 36_000.0], &[0.0; 3]).unit("°");
    /// Share of light the rectangle gives back, linear Rec.709. Darker tables let caustics stand out.
    ALBEDO = Setting::colour("scene.receiver.albedo", [0.0, 1.0], &[0.8, 0.8, 0.8]);
    /// Width of the floor around the rectangle in the picture.
    SURROUND = Setting::real("scene.receiver.surround", [0.0, 1e5], &[0.0]).unit("m");
    /// Width of the soft border within the rectangle, where ever less of the light flows: what stays, and what fell on the
    /// floor beside it, fades in its place while the rest leaves. At 0 the edge of the rectangle moves with the light.
    BORDER = Setting::real("scene.receiver.border", [0.0, 0.5], &[0.1]).unit("plane units");
} }

impl Default for ReceiverDesc {
    fn default() -> Self {
        Self {
            centre: Self::CENTRE.value(),
            size: Self::SIZE.value(),
            rotate: Self::ROTATE.value(),
            albedo: Self::ALBEDO.value(),
            surround: Self::SURROUND.value(),
            border: Self::BORDER.value(),
        }
    }
}

impl ReceiverDesc {
    /// Refuses an empty rectangle, an albedo above 1 and non-finite values.
    pub fn check(&self, place: &str) -> Result<()> {
        Self::CENTRE.check(self.centre, place)?;
        Self::SIZE.check(self.size, place)?;
        Self::ROTATE.check(self.rotate, place)?;
        Self::ALBEDO.check(self.albedo, place)?;
        Self::SURROUND.check(self.surround, place)?;
        Self::BORDER.check(self.border, place)
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
        let [x, y, z] = self.rotate.map(|degrees| f64::from(degrees).to_radians());
        let exact_turn = DQuat::from_euler(EulerRot::ZYX, z, y, x);
        let (x_axis, y_axis) = (turn * Vec3::X, turn * Vec3::NEG_Z);
        let [width, height] = self.size;
        let corner = Vec3::from(self.centre) - x_axis * (width / 2.0) - y_axis * (height / 2.0);
        let unit = width.max(height);
        Ok(Receiver {
            corner,
            x_axis,
            y_axis,
            normal: turn * Vec3::Y,
            centre: DVec3::from(self.centre.map(f64::from)),
            exact_normal: exact_turn * DVec3::Y,
            unit,
            extent: self.extent(),
            surround: self.surround / unit,
            border: self.border,
            material: Material::Diffuse(Diffuse { albedo: self.albedo }),
        })
    }
}

/// Widest floor beside the rectangle on which light is shown, plane units: beyond it the light of a glass is thin.
const MARGIN: f32 = 0.4;

/// The resolved receiver.
#[derive(Clone, Debug, PartialEq)]
pub struct Receiver {
    corner: Vec3,
    x_axis: Vec3,
    y_axis: Vec3,
    normal: Vec3,
    centre: DVec3,
    exact_normal: DVec3,
    unit: f32,
    extent: Vec2,
    surround: f32,
    border: f32,
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

    /// The world point (m) of a plane point.
    pub fn world_from_plane(&self, point: Vec2) -> Vec3 {
        self.corner + self.x_axis * (point.x * self.unit) + self.y_axis * (point.y * self.unit)
    }

    /// The orthogonal projection of a world point (m) to the plane.
    pub fn plane_from_world(&self, point: Vec3) -> Vec2 {
        let offset = point - self.corner;
        vec2(offset.dot(self.x_axis), offset.dot(self.y_axis)) / self.unit
    }

    /// The intersection of a ray with the plane, also beyond the rectangle; none for a ray away from it.
    pub fn plane_from_ray(&self, ray: &Ray) -> Option<Vec2> {
        let t = (self.corner - ray.origin).dot(self.normal) / ray.direction.dot(self.normal);
        (t > 0.0 && t < f32::INFINITY).then(|| self.plane_from_world(ray.origin + ray.direction * t))
    }

    /// The share of the light at a plane point that flows: 1 within the soft border, 0 at the edge and beyond, smooth between.
    pub fn flowing_share(&self, point: Vec2) -> f32 {
        let inward = point.min(self.extent - point);
        if inward.min_element() < 0.0 {
            return 0.0;
        }
        let border = self.border.min(self.extent.min_element() / 2.0);
        if border <= 0.0 {
            return 1.0;
        }
        let [x, y] = (inward / border).to_array().map(|share| smoothstep(f64::from(share)) as f32);
        x * y
    }

    /// The share of the light at a plane point that is shown at all: 1 on the rectangle, then ever less over the floor, to 0
    /// at [`Self::margin`].
    pub fn shown_share(&self, point: Vec2) -> f32 {
        let outside = point - point.clamp(Vec2::ZERO, self.extent);
        let margin = self.margin();
        if outside == Vec2::ZERO {
            1.0
        } else {
            smoothstep(f64::from(1.0 - outside.length() / margin)) as f32
        }
    }

    /// Width of the floor beside the rectangle on which light is shown, plane units; none with a hard edge.
    pub fn margin(&self) -> f32 {
        if self.border > 0.0 { self.surround.min(MARGIN) } else { 0.0 }
    }

    /// Whether a plane point lies on the rectangle.
    pub fn contains(&self, point: Vec2) -> bool {
        point.cmpge(Vec2::ZERO).all() && point.cmple(self.extent).all()
    }

    /// Lower and upper world corner of the rectangle and the floor around it (m).
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let s = Vec2::splat(self.surround);
        let far = self.extent + s;
        let corners = [-s, vec2(far.x, -s.y), vec2(-s.x, far.y), far].map(|p| self.world_from_plane(p));
        (
            corners.into_iter().reduce(Vec3::min).unwrap_or(self.corner),
            corners.into_iter().reduce(Vec3::max).unwrap_or(self.corner),
        )
    }

    /// The distance at which a ray meets the rectangle or the floor, and where.
    pub(super) fn intersect(&self, ray: &Ray) -> Option<(f32, Vec2)> {
        if ray.from == Primitive::FLOOR {
            return None;
        }
        let t = (self.corner - ray.origin).dot(self.normal) / ray.direction.dot(self.normal);
        if !(t > 0.0 && t < f32::INFINITY) {
            return None;
        }
        let plane = self.plane_from_world(ray.origin + ray.direction * t);
        self.reaches(plane).then_some((t, plane))
    }

    /// The hit of a surface that lies in the plane, as one of the receiver or the floor; none beyond.
    pub(super) fn hit_at(&self, hit: &Hit) -> Option<Hit> {
        let plane = self.plane_from_world(hit.point);
        self.reaches(plane).then(|| self.hit((hit.t, plane)))
    }

    /// Whether the floor reaches there.
    pub(super) fn reaches(&self, plane: Vec2) -> bool {
        let (lower, upper) = self.reach();
        plane.cmpge(lower).all() && plane.cmple(upper).all()
    }

    /// The hit of a ray that meets the plane there.
    pub(super) fn hit(&self, (t, plane): (f32, Vec2)) -> Hit {
        Hit {
            t,
            point: self.world_from_plane(plane),
            geometric_normal: self.normal,
            shading_normal: self.normal,
            surface: if self.contains(plane) { SurfaceId::Receiver } else { SurfaceId::Floor },
            primitive: Primitive::FLOOR,
        }
    }

    /// Lower and upper corner of the floor, plane units.
    pub(super) fn reach(&self) -> (Vec2, Vec2) {
        let reach = Vec2::splat(self.surround);
        (-reach, self.extent + reach)
    }

    /// Height of a point above the plane (m), in f64 from the saved turn: the f32 axes are rounded by as much as contact may be.
    pub(super) fn height(&self, point: Vec3) -> f64 {
        (point.as_dvec3() - self.centre).dot(self.exact_normal)
    }

    /// Largest coordinate of the centre (m).
    pub(super) fn largest_coordinate(&self) -> f32 {
        self.centre.abs().max_element() as f32
    }
}
