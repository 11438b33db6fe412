//! Pictures of light that does not flow: what falls on the receiver's soft border and on the floor beside it, and what glass
//! shows of a caustic. It is traced and rendered once; frames add it in shares.

use glam::{Vec3, Vec4Swizzles};
use rayon::prelude::*;

use super::camera_sampler::CameraSampler;
use super::fireflies::clamp_speckles;
use super::image::Image;
use super::settings::RenderSettings;
use super::texture::{ReceiverTexture, TextureLayout};
use crate::math::rng::{Purpose, Stream};
use crate::scene::Scene;
use crate::{Progress, Result};

/// Share of the camera samples: this light is smooth, and glass takes more samples anyway.
const SAMPLES: u32 = 4;

/// Light on the plane: what stays of it, and all of it. Textures of one layout.
pub struct StillTextures {
    /// Light on the soft border and the floor.
    pub stays: ReceiverTexture,
    /// All light.
    pub all: ReceiverTexture,
}

/// The camera's pictures of [`StillTextures`].
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
pub struct StillPictures {
    /// The light that stays, wherever it is seen.
    pub stays: Image,
    /// All light, where it is seen by way of glass.
    pub in_glass: Image,
}

/// The pictures of several lights. The same seed gives the same bytes for any number of threads.
///
/// # Errors
/// `Cancelled`.
pub fn still_pictures(
    scene: &Scene,
    lights: &[StillTextures],
    settings: &RenderSettings,
    seed: u64,
    progress: &Progress,
) -> Result<Vec<StillPictures>> {
    let size @ [width, height] = [settings.width as usize, settings.height as usize];
    let camera = CameraSampler::new(scene, size);
    let samples = settings.camera_samples.div_ceil(SAMPLES);
    let metres = scene.receiver().metres_per_plane_unit();
    let layouts = lights.iter().map(|light| *light.all.layout());
    let watts: Vec<f32> = layouts.map(|layout| (layout.texel * metres).powi(2).recip()).collect();
    progress.begin("still", height as u64);
    let rows = (0..height).into_par_iter().map(|y| {
        let mut row = vec![[Vec3::ZERO; 2]; width * lights.len()];
        for (x, pixel) in row.chunks_exact_mut(lights.len()).enumerate() {
            progress.check()?;
            let rng = Stream::new(seed, Purpose::Visible, 2, (y * width + x) as u64);
            let taken = camera.pixel([x, y], samples, rng, &mut |seen| {
                for (light, [stays, in_glass]) in lights.iter().zip(&mut *pixel) {
                    *stays += seen.weight * watts_at(&light.stays, seen.point);
                    if seen.in_glass {
                        *in_glass += seen.weight * watts_at(&light.all, seen.point);
                    }
                }
            });
            for (sums, watts) in pixel.iter_mut().zip(&watts) {
                *sums = sums.map(|sum| sum * (watts / taken as f32));
            }
        }
        progress.advance(1);
        Ok(row)
    });
    let rows = rows.collect::<Result<Vec<_>>>()?;
    let picture = |light: usize, of: usize| {
        let pixels = rows.iter().flat_map(|row| row.chunks_exact(lights.len()).map(|pixel| pixel[light][of]));
        Image { width, height, pixels: pixels.collect() }
    };
    let pictures = |light| {
        let mut in_glass = picture(light, 1);
        clamp_speckles(&mut in_glass);
        StillPictures { stays: picture(light, 0), in_glass }
    };
    Ok((0..lights.len()).map(pictures).collect())
}

/// The layout of textures that hold the light on a receiver and on the floor beside it.
pub fn still_layout(scene: &Scene, resolution: usize) -> TextureLayout {
    TextureLayout::new(scene.receiver().extent(), resolution, scene.receiver().margin())
}

/// Watts per texel at a point of the plane; none beside the texture.
pub fn watts_at(texture: &ReceiverTexture, point: glam::Vec2) -> Vec3 {
    let taps = texture.layout().bilinear(point).into_iter().flatten();
    taps.map(|(texel, share)| texture.texels()[texel].xyz() * share).sum()
}
