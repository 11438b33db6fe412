//! The orbit view: a schematic picture of a scene from anywhere, for orientation.
//!
//! One ray per pixel passes straight through glass, shown as a tinted shape with bright rims, to the first matt surface or
//! mirror, lit by a lamp at the camera. The receiver shows the caustic as it is.

use glam::{Vec3, Vec4Swizzles, vec2};
use rayon::prelude::*;

use super::image::Image;
use super::texture::ReceiverTexture;
use crate::scene::camera::Camera;
use crate::scene::material::{Diffuse, Material};
use crate::scene::{Hit, Ray, Scene, SurfaceId};
use crate::{Progress, Result};

/// Most glass surfaces of a ray.
const LAYERS: usize = 12;
/// Reflected share of the albedo, at grazing angle and facing the camera.
const FACING: [f32; 2] = [0.12, 0.55];
/// Reflectance of glass, facing the camera and at its rims.
const GLASS: [f32; 2] = [0.012, 0.4];
/// Transmittance of glass, facing the camera and at its rims.
const CLEAR: [f32; 2] = [0.93, 0.3];
/// Radiance of the background, below and above.
const BEHIND: [f32; 2] = [0.015, 0.06];
/// Brightness of the receiver and the floor, relative to other matt surfaces: dark, so that the caustic stands out.
const GROUND: [f32; 2] = [0.4, 0.25];
/// Width of the outline of the receiver, pixels.
const BORDER: f32 = 1.5;

/// The light in an orbit view.
#[derive(Clone, Copy)]
pub struct OrbitLight<'a> {
    /// The caustic on the receiver, watts per texel.
    pub caustic: Option<&'a ReceiverTexture>,
    /// Factor on the lamp at the camera, 2^-exposure: equally bright on the screen at any exposure.
    pub lamp: f32,
}

/// The orbit view of `scene` through `camera`, `size` pixels, linear light.
///
/// # Errors
/// `Cancelled`.
pub fn orbit_image(
    scene: &Scene,
    camera: &Camera,
    size: [u32; 2],
    light: OrbitLight,
    progress: &Progress,
) -> Result<Image> {
    let mut image = Image::new(size[0] as usize, size[1] as usize);
    let shader = OrbitShader { scene, light, pixel: 2.0 * camera.half_height / size[1] as f32 };
    let extent = vec2(size[0] as f32, size[1] as f32);
    image.pixels.par_chunks_mut(size[0].max(1) as usize).enumerate().try_for_each(|(y, row)| {
        progress.check()?;
        for (x, pixel) in row.iter_mut().enumerate() {
            let at = vec2(x as f32 + 0.5, y as f32 + 0.5) / extent * 2.0 - 1.0;
            *pixel = shader.colour(camera.ray(at.x, -at.y, extent.x / extent.y));
        }
        Ok(())
    })?;
    Ok(image)
}

struct OrbitShader<'a> {
    scene: &'a Scene,
    light: OrbitLight<'a>,
    /// Approximate angle of a pixel.
    pixel: f32,
}

impl OrbitShader<'_> {
    /// The radiance along one ray.
    fn colour(&self, mut ray: Ray) -> Vec3 {
        let (mut colour, mut weight, mut distance) = (Vec3::ZERO, Vec3::ONE, 0.0);
        for _ in 0..LAYERS {
            let Some(hit) = self.scene.intersect(&ray) else { break };
            distance += hit.t;
            let facing = ray.direction.dot(hit.shading_normal).abs();
            match self.scene.material(hit.surface) {
                Material::Glass(glass) => {
                    let leaves = ray.direction.dot(hit.geometric_normal) > 0.0;
                    if leaves {
                        weight *= glass.transmittance(hit.t);
                    }
                    let rim = (1.0 - facing).powi(3);
                    colour += weight * self.light.lamp * between(GLASS, rim);
                    weight *= between(CLEAR, rim);
                    ray = Ray::leaving(&hit, ray.direction);
                }
                Material::Mirror(mirror) => {
                    let reflected =
                        ray.direction - 2.0 * ray.direction.dot(hit.shading_normal) * hit.shading_normal;
                    let sky = between(BEHIND, 0.5 + 0.5 * reflected.y) + 0.3 * facing * facing;
                    return colour + weight * Vec3::from(mirror.reflectance) * (sky * self.light.lamp);
                }
                Material::Diffuse(diffuse) => {
                    return colour + weight * self.matt(&hit, facing, distance, diffuse);
                }
            }
        }
        colour + weight * self.light.lamp * between(BEHIND, 0.5 + 0.5 * ray.direction.y)
    }

    /// The radiance of a matt surface at `distance` metres.
    fn matt(&self, hit: &Hit, facing: f32, distance: f32, diffuse: &Diffuse) -> Vec3 {
        let albedo = Vec3::from(diffuse.albedo);
        let lit = albedo * (self.light.lamp * between(FACING, facing));
        match hit.surface {
            SurfaceId::Mesh(_) | SurfaceId::Contact(_) => lit,
            SurfaceId::Floor => lit * GROUND[1] + self.caustic(hit) * albedo,
            SurfaceId::Receiver => {
                let receiver = self.scene.receiver();
                let p = receiver.plane_from_world(hit.point);
                let edge = p.min(receiver.extent() - p).min_element();
                // At grazing angles a pixel covers more of the plane.
                let border =
                    BORDER * self.pixel * distance / facing.max(0.05) / receiver.metres_per_plane_unit();
                let line = if edge < border { 0.25 * self.light.lamp } else { 0.0 };
                lit * GROUND[0] + self.caustic(hit) * albedo + line
            }
        }
    }

    /// Radiance of the caustic at a hit, for albedo 1.
    fn caustic(&self, hit: &Hit) -> Vec3 {
        let Some(texture) = self.light.caustic else { return Vec3::ZERO };
        let receiver = self.scene.receiver();
        let layout = texture.layout();
        let taps = layout.bilinear(receiver.plane_from_world(hit.point)).into_iter().flatten();
        let watts: Vec3 = taps.map(|(texel, share)| texture.texels()[texel].xyz() * share).sum();
        let side = layout.texel * receiver.metres_per_plane_unit();
        watts / (side * side * std::f32::consts::PI)
    }
}

fn between([from, to]: [f32; 2], x: f32) -> f32 {
    from + (to - from) * x
}
