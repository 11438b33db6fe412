//! The sparse matrix from texels to pixels: what the camera sees of the receiver directly, through glass and in mirrors.
//!
//! Every camera sample that reaches the receiver reads the texture bilinearly at one point. The samples of a pixel are a
//! short list of texels with RGB weights, a row of the matrix; it is built once per camera, then a frame is one product
//! with its texture. Light from the receiver on other matt surfaces is left out.

use glam::{Vec2, Vec3, Vec4, Vec4Swizzles, vec2};
use rayon::prelude::*;

use super::camera_sampler::CameraSampler;
use super::image::Image;
use super::sampler::{Sampler, tent};
use super::settings::RenderSettings;
use super::texture::{ReceiverTexture, TextureLayout};
use crate::math::rng::{Purpose, Stream};
use crate::scene::{Scene, SurfaceId};
use crate::{Progress, Result};

/// Weight below which a texel is dropped from a pixel.
const NEGLIGIBLE: f32 = 1e-7;

/// The sparse matrix from the texels of one layout to the pixels of one picture, compressed by rows.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub struct GatherMatrix {
    width: usize,
    height: usize,
    layout: TextureLayout,
    /// Start of each pixel's list in `weights`, and the end.
    starts: Vec<usize>,
    weights: Vec<TexelWeight>,
}

/// An entry of the matrix: a pixel's radiance [W/(sr m^2)] per watt in a texel.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
struct TexelWeight {
    texel: u32,
    weight: Vec3,
}

impl GatherMatrix {
    /// The matrix of a scene's camera. The same seed gives the same matrix for any number of threads.
    pub fn through_camera(
        scene: &Scene,
        layout: &TextureLayout,
        settings: &RenderSettings,
        seed: u64,
        progress: &Progress,
    ) -> Result<Self> {
        let (width, height) = (settings.width as usize, settings.height as usize);
        let camera = CameraSampler::new(scene, [width, height]);
        let watts = texel_area(layout, scene.receiver().metres_per_plane_unit()).recip();
        progress.begin("visible", height as u64);
        let rows = (0..height).into_par_iter().map(|y| {
            let mut row = Row::default();
            for x in 0..width {
                progress.check()?;
                let rng = Stream::new(seed, Purpose::Visible, 0, (y * width + x) as u64);
                let samples = camera.pixel([x, y], settings.camera_samples, rng, &mut |seen| {
                    row.add(layout, seen.point, seen.weight);
                });
                row.finish_pixel(watts / samples as f32);
            }
            progress.advance(1);
            Ok(row)
        });
        Ok(Self::from_rows(width, height, layout, rows.collect::<Result<Vec<_>>>()?))
    }

    /// The matrix of a project without scene: the plane seen straight on, whole and centred, white, one metre per plane unit.
    ///
    /// # Errors
    /// `Cancelled`.
    pub fn flat(
        extent: Vec2,
        layout: &TextureLayout,
        settings: &RenderSettings,
        progress: &Progress,
    ) -> Result<Self> {
        const WHITE: f32 = 1.0 / std::f32::consts::PI;
        let (width, height) = (settings.width as usize, settings.height as usize);
        let size = vec2(width as f32, height as f32);
        let pixel = flat_pixel(extent, size);
        let samples = settings.camera_samples;
        let rows = (0..height).into_par_iter().map(|y| {
            let mut row = Row::default();
            for x in 0..width {
                progress.check()?;
                let sampler = Sampler::new((y * width + x) as u32);
                for index in 0..samples {
                    let at = vec2(x as f32 + 0.5, y as f32 + 0.5) + tent(sampler.pair(index, 0));
                    let from_centre = at - size * 0.5;
                    let plane = extent * 0.5 + vec2(from_centre.x, -from_centre.y) * pixel;
                    let inside = plane.cmpge(Vec2::ZERO).all() && plane.cmple(extent).all();
                    if inside {
                        row.add(layout, plane, Vec3::splat(WHITE));
                    }
                }
                row.finish_pixel(1.0 / (texel_area(layout, 1.0) * samples as f32));
            }
            Ok(row)
        });
        Ok(Self::from_rows(width, height, layout, rows.collect::<Result<Vec<_>>>()?))
    }

    /// The picture of a texture: radiance per pixel, for flux in watts per texel.
    ///
    /// # Panics
    /// If the texture has another layout.
    pub fn gather(&self, texture: &ReceiverTexture) -> Image {
        let texels = self.texels([texture]);
        let mut image = Image::new(self.width, self.height);
        image.pixels.par_chunks_mut(self.width).enumerate().for_each(|(y, row)| {
            row.iter_mut().enumerate().for_each(|(x, pixel)| [*pixel] = self.pixel(x, y, texels));
        });
        image
    }

    /// The pictures of several textures, as [`Self::gather`] makes each: the matrix, which is larger than they are, is read once
    /// for four of them.
    ///
    /// # Panics
    /// If a texture has another layout.
    pub fn gather_all(&self, textures: &[&ReceiverTexture]) -> Vec<Image> {
        let (fours, rest) = textures.as_chunks::<4>();
        let fours = fours.iter().flat_map(|textures| self.gather_together(*textures));
        fours.chain(rest.iter().map(|texture| self.gather(texture))).collect()
    }

    fn gather_together<const N: usize>(&self, textures: [&ReceiverTexture; N]) -> [Image; N] {
        let texels = self.texels(textures);
        let mut pixels = vec![[Vec3::ZERO; N]; self.width * self.height];
        pixels.par_chunks_mut(self.width).enumerate().for_each(|(y, row)| {
            row.iter_mut().enumerate().for_each(|(x, pixels)| *pixels = self.pixel(x, y, texels));
        });
        std::array::from_fn(|n| {
            let pixels = pixels.iter().map(|pixels| pixels[n]).collect();
            Image { width: self.width, height: self.height, pixels }
        })
    }

    fn texels<'a, const N: usize>(&self, textures: [&'a ReceiverTexture; N]) -> [&'a [Vec4]; N] {
        textures.map(|texture| {
            assert_eq!(*texture.layout(), self.layout, "the layout that the camera was looked through for");
            texture.texels()
        })
    }

    /// A pixel of the pictures of several textures.
    fn pixel<const N: usize>(&self, x: usize, y: usize, texels: [&[Vec4]; N]) -> [Vec3; N] {
        let index = y * self.width + x;
        // Of one known length: it is looked once whether a texel is there.
        let texels = texels.map(|texels| &texels[..self.layout.len()]);
        let mut sums = [Vec4::ZERO; N];
        for entry in &self.weights[self.starts[index]..self.starts[index + 1]] {
            let weight = entry.weight.extend(0.0);
            for (sum, texels) in sums.iter_mut().zip(texels) {
                *sum += weight * texels[entry.texel as usize];
            }
        }
        sums.map(Vec4Swizzles::xyz)
    }

    /// The layout of the texture.
    pub fn layout(&self) -> &TextureLayout {
        &self.layout
    }

    fn from_rows(width: usize, height: usize, layout: &TextureLayout, rows: Vec<Row>) -> Self {
        let mut starts = Vec::with_capacity(width * height + 1);
        let mut weights = Vec::with_capacity(rows.iter().map(|row| row.weights.len()).sum());
        starts.push(0);
        for row in rows {
            starts.extend(row.ends.iter().map(|end| weights.len() + end));
            weights.extend_from_slice(&row.weights);
        }
        Self { width, height, layout: *layout, starts, weights }
    }
}

/// The texture layout for a camera, or for the flat view without a scene: as fine as the sharper tenth of the picture or
/// the kernel of the last pass, whichever is coarser; with a margin as wide as the kernel of the first. `radius` is
/// that of the first and the last pass, plane units.
pub fn layout_for(
    scene: Option<&Scene>,
    extent: Vec2,
    settings: &RenderSettings,
    radius: (f32, f32),
) -> TextureLayout {
    let pixel = match scene {
        Some(scene) => camera_pixel(scene, settings).unwrap_or(1.0),
        None => flat_pixel(extent, vec2(settings.width as f32, settings.height as f32)),
    };
    // The kernel's standard deviation is a third of its radius.
    let texel = pixel.max(radius.1 / 4.0).max(1.0 / settings.max_texels as f32).min(1.0 / 64.0);
    TextureLayout::new(extent, (1.0 / texel).ceil() as usize, radius.0)
}

/// Plane units per pixel of the flat view in a picture of `size` pixels.
pub(super) fn flat_pixel(extent: Vec2, size: Vec2) -> f32 {
    (extent / size).max_element()
}

/// Plane units per pixel in the sharper tenth of the receiver's directly visible part.
fn camera_pixel(scene: &Scene, settings: &RenderSettings) -> Option<f32> {
    const PROBES: usize = 64;
    let (width, height) = (settings.width as usize, settings.height as usize);
    let camera = CameraSampler::new(scene, [width, height]);
    let place = |x: f32, y: f32| {
        let hit = scene.intersect(&camera.ray(vec2(x, y)))?;
        (hit.surface == SurfaceId::Receiver).then(|| scene.receiver().plane_from_world(hit.point))
    };
    let mut sizes: Vec<f32> = (0..PROBES * PROBES)
        .filter_map(|i| {
            let x = ((i % PROBES) as f32 + 0.5) / PROBES as f32 * width as f32;
            let y = ((i / PROBES) as f32 + 0.5) / PROBES as f32 * height as f32;
            let middle = place(x, y)?;
            Some(middle.distance(place(x + 1.0, y)?).min(middle.distance(place(x, y + 1.0)?)))
        })
        .collect();
    sizes.sort_by(f32::total_cmp);
    sizes.get(sizes.len() / 10).copied()
}

fn texel_area(layout: &TextureLayout, metres: f32) -> f32 {
    (layout.texel * metres).powi(2)
}

/// The pixels of one row of the picture, under construction.
#[derive(Debug, Default)]
struct Row {
    ends: Vec<usize>,
    weights: Vec<TexelWeight>,
    /// Taps of the samples of the current pixel.
    loose: Vec<TexelWeight>,
}

impl Row {
    /// Adds one sample to the current pixel.
    fn add(&mut self, layout: &TextureLayout, point: Vec2, weight: Vec3) {
        for (texel, share) in layout.bilinear(point).into_iter().flatten() {
            self.loose.push(TexelWeight { texel: texel as u32, weight: weight * share });
        }
    }

    /// Merges the weights of the current pixel, times `scale`, and begins the next.
    fn finish_pixel(&mut self, scale: f32) {
        self.loose.sort_by_key(|entry| entry.texel);
        for same in self.loose.chunk_by(|a, b| a.texel == b.texel) {
            let weight: Vec3 = same.iter().map(|entry| entry.weight).sum();
            if weight.max_element() > NEGLIGIBLE {
                self.weights.push(TexelWeight { texel: same[0].texel, weight: weight * scale });
            }
        }
        self.loose.clear();
        self.ends.push(self.weights.len());
    }
}
