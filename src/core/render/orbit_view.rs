//! A quick look at a scene from anywhere, to find one's distance in it: no picture of its light.
//!
//! One ray per pixel goes straight on through glass, which shows as a tinted shape with bright rims, and ends on what is
//! matt or a mirror, lit by a lamp at the shader. The receiver shows the caustic as it is.

use glam::{Vec2, Vec3, Vec4Swizzles, vec2};
use rayon::prelude::*;

use super::image::Image;
use super::texture::ReceiverTexture;
use crate::scene::camera::Camera;
use crate::scene::material::{Diffuse, Material};
use crate::scene::{Hit, Ray, Scene, SurfaceId};
use crate::{Progress, Result};

/// Surfaces of glass that a ray goes through.
const LAYERS: usize = 12;
/// What a surface that faces the eye gives back of its albedo, and one that is seen along it.
const FACING: [f32; 2] = [0.12, 0.55];
/// What glass gives back where it faces the eye, and at its rims.
const GLASS: [f32; 2] = [0.012, 0.4];
/// What glass lets through where it faces the eye, and at its rims.
const CLEAR: [f32; 2] = [0.93, 0.3];
/// The light behind everything, below and above.
const BEHIND: [f32; 2] = [0.015, 0.06];
/// The receiver and the floor around it, over other matt things: dark, so that the caustic stands out.
const GROUND: [f32; 2] = [0.4, 0.25];
/// Width of the line around the receiver, pixels.
const BORDER: f32 = 1.5;

/// What a look shows beside the scene.
#[derive(Clone, Copy)]
pub struct OrbitLight<'a> {
    /// The light on the receiver, watts per texel.
    pub caustic: Option<&'a ReceiverTexture>,
    /// Factor on the lamp at the eye, so that it is as bright on the screen at any exposure: 2^-exposure.
    pub lamp: f32,
}

/// Looks at `scene` through `camera` in a picture of `size` pixels, linear light.
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
    /// Angle of a pixel, about.
    pixel: f32,
}

impl OrbitShader<'_> {
    /// The light along one ray.
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

    /// What a matt surface gives back that is hit after `distance` metres.
    fn matt(&self, hit: &Hit, facing: f32, distance: f32, diffuse: &Diffuse) -> Vec3 {
        let albedo = Vec3::from(diffuse.albedo);
        let lit = albedo * (self.light.lamp * between(FACING, facing));
        match hit.surface {
            SurfaceId::Mesh(_) => lit,
            SurfaceId::Floor => lit * GROUND[1] + self.caustic(hit) * albedo,
            SurfaceId::Receiver => {
                let receiver = self.scene.receiver();
                let p = receiver.plane_from_world(hit.point);
                let edge = p.min(receiver.extent() - p).min_element();
                // Seen along it, a pixel covers more of the plane.
                let border =
                    BORDER * self.pixel * distance / facing.max(0.05) / receiver.metres_per_plane_unit();
                let line = if edge < border { 0.25 * self.light.lamp } else { 0.0 };
                lit * GROUND[0] + self.caustic(hit) * albedo + line
            }
        }
    }

    /// Radiance of the caustic on white paper at a place of the plane.
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

/// Something of a scene that no ray meets, in a look at it.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneMarker {
    /// What it is.
    pub kind: MarkerKind,
    /// Its place in pixels from the upper left corner; it may lie beyond the picture.
    pub at: Vec2,
}

/// What a [`SceneMarker`] stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkerKind {
    /// The light of this number in the scene.
    Light(usize),
    /// The camera that the pictures are taken with.
    Camera,
}

/// Where the lights and the camera of a scene are in a look at it; those behind the eye, and directional lights, are
/// nowhere.
pub fn scene_markers(scene: &Scene, camera: &Camera, size: [u32; 2]) -> Vec<SceneMarker> {
    let size = vec2(size[0] as f32, size[1] as f32);
    let lights = scene.lights().iter().enumerate();
    let lights = lights.filter_map(|(i, light)| Some((MarkerKind::Light(i), light.position()?)));
    let all = lights.chain([(MarkerKind::Camera, scene.camera().position)]);
    let mark = |(kind, place)| {
        let at = camera.project(place, size.x / size.y)?;
        Some(SceneMarker { kind, at: (vec2(at.x, -at.y) + 1.0) * 0.5 * size })
    };
    all.filter_map(mark).collect()
}
