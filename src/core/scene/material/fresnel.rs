//! Reflection and refraction at a smooth boundary between two clear media (Born & Wolf, Principles of Optics, 1.5).

use glam::Vec3;

use crate::scene::Hit;

/// The unpolarised reflectance and the cosine of the refracted ray, for a ray that meets the boundary at an angle of
/// cosine `cos_i` in (0, 1] and passes from index n1 to n2, `eta = n2 / n1`. Total reflection gives (1, 0).
pub fn fresnel(cos_i: f32, eta: f32) -> (f32, f32) {
    let sin2_t = (1.0 - cos_i * cos_i) / (eta * eta); // Snell
    if sin2_t >= 1.0 {
        return (1.0, 0.0);
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    (0.5 * (parallel * parallel + perpendicular * perpendicular), cos_t)
}

/// The reflection of `direction` at a surface with unit `normal`.
pub fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    (direction - 2.0 * direction.dot(normal) * normal).normalize()
}

/// The refraction of `direction` at a surface with unit `normal` against it; `cos_t` from [`fresnel`].
pub fn refract(direction: Vec3, normal: Vec3, cos_i: f32, cos_t: f32, eta: f32) -> Vec3 {
    ((direction + normal * cos_i) / eta - normal * cos_t).normalize()
}

/// Geometric and shading normal turned against `direction`. Where the shading normal faces away though the surface does not
/// (near a silhouette), the geometric one replaces it.
pub fn facing_normals(hit: &Hit, direction: Vec3) -> (Vec3, Vec3) {
    let sign = if direction.dot(hit.geometric_normal) < 0.0 { 1.0 } else { -1.0 };
    let (geometric, shading) = (hit.geometric_normal * sign, hit.shading_normal * sign);
    if direction.dot(shading) < 0.0 { (geometric, shading) } else { (geometric, geometric) }
}
