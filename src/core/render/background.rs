//! The picture without caustics, path traced once.
//!
//! Direct light by a shadow ray to every light, specular paths from the camera, the sky, and a few diffuse
//! interreflections. Shadows of glass stay dark: a shadow ray stops at glass, and paths from a matt surface over glass or
//! a mirror to a light are left out, because that light is the caustic photons'. The sky emits no photons, so its light
//! does pass through glass.
//!
//! Sampling is adaptive (`adaptive`): pixels get more samples where their neighbours are noisy. A few samples can miss what is
//! rare and bright, but hardly in a whole neighbourhood. On the ground in smooth light, neighbours are taken together (`smooth`).
//! What still stands out alone in glass or on the ground is clamped, and counted.

use std::time::{Duration, Instant};

use glam::{Vec2, Vec3, vec2};
use rayon::prelude::*;

use super::adaptive::{Estimate, Need, needs};
use super::camera_sampler::FAINT as FAINT_WAY;
use super::fireflies::{ClampedLight, Shows, clamp_outliers};
use super::image::Image;
use super::sampler::{Sampler, tent};
use super::settings::RenderSettings;
use super::smooth::{Quadratic, neighbourhood};
use crate::math::colour::luminance;
use crate::math::rng::{Purpose, Stream};
use crate::scene::light::LightRole;
use crate::scene::material::fresnel::facing_normals;
use crate::scene::material::{Beam, Material};
use crate::scene::{Hit, LightDesc, Media, Ray, Scene};
use crate::{Progress, Result};

/// Most diffuse bounces.
const BOUNCES: u32 = 3;
/// Most surfaces of a path.
const MAX_SURFACES: usize = 32;
/// Throughput below which Russian roulette applies after a matt surface; before it, `FAINT_WAY`.
const FAINT: f32 = 0.1;
/// Times that the samples of a noisy pixel are doubled, at most.
const ROUNDS: u32 = 6;
/// Rows that are traced before the samples are looked at as a whole, at least.
const ROWS: usize = 64;
/// Clamp on fireflies: largest luminance of a light seen in glass or a mirror, over the mean of the picture. Lamps are
/// thousands of times brighter, and one chance reflection of a small lamp would sparkle; this is still white.
const FIREFLY_LIMIT: f32 = 50.0;

/// The picture without caustics.
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
pub struct Background {
    /// Linear light.
    pub image: Image,
    /// What was taken from it.
    pub clamped: ClampedLight,
}

/// Renders the picture without caustics. The same seed gives the same bytes for any number of threads.
pub fn background(
    scene: &Scene,
    settings: &RenderSettings,
    seed: u64,
    progress: &Progress,
) -> Result<Background> {
    render(None, scene, settings, (seed, true), (&mut Keeper::default(), progress))
}

/// As [`background`], from what an earlier run has kept of the same. `keep` is given the samples so far whenever the time
/// `every` is over, but no more often than costs a twentieth.
///
/// # Errors
/// Those of `keep`; cancelled.
pub fn background_from(
    kept: Option<BackgroundSamples>,
    scene: &Scene,
    settings: &RenderSettings,
    seed: u64,
    (keep, every): (KeepSamples, Duration),
    progress: &Progress,
) -> Result<Background> {
    render(
        kept,
        scene,
        settings,
        (seed, true),
        (&mut Keeper { keep: Some((keep, every)), due: None }, progress),
    )
}

/// As [`background`] without adaptive sampling: noisy, in a predictable time.
pub fn rough_background(
    scene: &Scene,
    settings: &RenderSettings,
    seed: u64,
    progress: &Progress,
) -> Result<Background> {
    render(None, scene, settings, (seed, false), (&mut Keeper::default(), progress))
}

fn render(
    kept: Option<BackgroundSamples>,
    scene: &Scene,
    settings: &RenderSettings,
    (seed, adaptive): (u64, bool),
    (keeper, progress): (&mut Keeper, &Progress),
) -> Result<Background> {
    let (width, height) = (settings.width as usize, settings.height as usize);
    let media = scene.media_at(scene.camera().position);
    let mut tracer = PathTracer { scene, media, width, height, firefly_limit: 0.0 };
    let brightness = tracer.brightness(seed);
    tracer.firefly_limit = FIREFLY_LIMIT * brightness;
    let (first, floor) = (settings.background_samples, 0.5 * brightness);
    // Halves, so that there are two to compare; then rounds.
    let steps = if adaptive { 2 + ROUNDS } else { 2 };
    progress.begin("background", height as u64 * u64::from(steps));
    let fits = |kept: &BackgroundSamples| kept.pixels.len() == width * height;
    let mut samples = kept.filter(fits).unwrap_or_else(|| BackgroundSamples::new(width * height, seed));
    progress.advance(u64::from(samples.step) * height as u64 + samples.rows as u64);
    while samples.step < steps {
        let step = samples.step;
        if step >= 2 && samples.rows == 0 {
            let estimates: Vec<Estimate> = samples.pixels.iter().map(Pixel::estimate).collect();
            // What is settled stays so: its samples no longer change.
            let open = samples.need.iter_mut().zip(needs(&estimates, width, floor, first));
            open.filter(|(need, _)| **need == Need::Samples).for_each(|(need, now)| *need = now);
        }
        while samples.rows < height {
            tracer.trace(&mut samples, first, progress)?;
            keeper.offer(&samples)?;
        }
        (samples.step, samples.rows) = (step + 1, 0);
    }
    Ok(tracer.finish(&samples, floor))
}

/// Keeps samples for a run that takes them up.
pub type KeepSamples<'a> = &'a dyn Fn(&BackgroundSamples) -> Result<()>;

/// The samples of a picture on the way.
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
pub struct BackgroundSamples {
    /// The step: the first half of the samples of all pixels, the second, then rounds for noisy ones.
    step: u32,
    /// Rows from the top that are done in this step.
    rows: usize,
    /// What each pixel needs; those that need samples get them in the rounds.
    need: Vec<Need>,
    pixels: Vec<Pixel>,
}

impl BackgroundSamples {
    fn new(count: usize, seed: u64) -> Self {
        let pixel = |i| Pixel::new(Stream::new(seed, Purpose::Background, 0, i as u64));
        Self { step: 0, rows: 0, need: vec![Need::Samples; count], pixels: (0..count).map(pixel).collect() }
    }
}

/// Keeps the samples from time to time, or never.
#[derive(Default)]
struct Keeper<'a> {
    /// What keeps them, and how often.
    keep: Option<(KeepSamples<'a>, Duration)>,
    /// None before the first offer.
    due: Option<Instant>,
}

impl Keeper<'_> {
    /// Keeps them where it is time.
    fn offer(&mut self, samples: &BackgroundSamples) -> Result<()> {
        let Some((keep, every)) = self.keep else { return Ok(()) };
        let start = Instant::now();
        if start >= *self.due.get_or_insert(start + every) {
            keep(samples)?;
            self.due = Some(Instant::now() + every.max(20 * start.elapsed()));
        }
        Ok(())
    }
}

/// The accumulated samples of a pixel.
#[derive(Clone, Debug, serde::Deserialize, serde::Serialize)]
struct Pixel {
    rng: Stream,
    sampler: Sampler,
    sum: Vec3,
    /// The sum when there were half as many samples.
    half: Vec3,
    count: u32,
    /// Sum of the luminance that was clamped.
    clamped: f32,
    /// Whether a path met glass or a mirror first.
    specular: bool,
    /// Whether all paths met the ground first: the receiver or the floor around it.
    even: bool,
}

impl Pixel {
    fn new(mut rng: Stream) -> Self {
        let sampler = Sampler::new(rng.u32());
        let sum = Vec3::ZERO;
        Self { rng, sampler, sum, half: sum, count: 0, clamped: 0.0, specular: false, even: true }
    }

    fn add(&mut self, value: Vec3) {
        self.sum += value;
        self.count += 1;
    }

    fn mean(&self) -> Vec3 {
        self.sum / self.count.max(1) as f32
    }

    fn luminance(&self) -> f32 {
        luminance(self.mean())
    }

    fn shows(&self) -> Shows {
        match self {
            Self { specular: true, .. } => Shows::Specular,
            Self { even: true, .. } => Shows::Even,
            _ => Shows::Detail,
        }
    }

    /// Of a pixel whose samples were doubled last.
    fn estimate(&self) -> Estimate {
        let luminance_of_half = luminance(self.half / self.count.div_ceil(2).max(1) as f32);
        Estimate {
            luminance: self.luminance(),
            change: luminance_of_half - self.luminance(),
            count: self.count,
            branches: self.specular,
            even: self.even,
        }
    }
}

/// A path that is still to be followed.
struct Open {
    ray: Ray,
    beam: Beam,
    surfaces: usize,
}

/// The path tracer.
struct PathTracer<'a> {
    scene: &'a Scene,
    media: Media,
    width: usize,
    height: usize,
    /// Largest luminance of a light seen in glass or a mirror ([`FIREFLY_LIMIT`]).
    firefly_limit: f32,
}

impl PathTracer<'_> {
    /// Traces the next rows in their step; `first` are the samples that all pixels get.
    fn trace(&self, samples: &mut BackgroundSamples, first: u32, progress: &Progress) -> Result<()> {
        let (start, width, step) = (samples.rows, self.width, samples.step);
        let end = self.height.min(start + ROWS.max(8 * rayon::current_num_threads()));
        let need = &samples.need;
        // Samples that a pixel is to have.
        let wanted = |i: usize, pixel: &Pixel| match step {
            0 => first.div_ceil(2),
            1 => first,
            _ if need[i] == Need::Samples => 2 * pixel.count,
            _ => 0,
        };
        let rows = samples.pixels[start * width..end * width].par_chunks_mut(width).enumerate();
        rows.try_for_each(|(row, pixels)| -> Result<()> {
            let y = start + row;
            for (x, pixel) in pixels.iter_mut().enumerate() {
                progress.check()?;
                let more = wanted(y * width + x, pixel).saturating_sub(pixel.count);
                if more > 0 {
                    pixel.half = pixel.sum;
                    (0..more).for_each(|_| self.sample(x, y, pixel));
                }
            }
            progress.advance(1);
            Ok(())
        })?;
        samples.rows = end;
        Ok(())
    }

    /// Mean luminance of the picture, without lights in glass and mirrors, estimated by a few thousand paths.
    fn brightness(&self, seed: u64) -> f32 {
        const PATHS: usize = 4096;
        let pixels = self.width * self.height;
        let lights = (0..PATHS).map(|i| {
            let place = i * pixels / PATHS;
            let mut pixel = Pixel::new(Stream::new(seed, Purpose::Background, 1, i as u64));
            self.sample(place % self.width, place / self.width, &mut pixel);
            f64::from(pixel.luminance())
        });
        (lights.sum::<f64>() / PATHS as f64) as f32
    }

    /// The means of the pixels, or of those together that need it, without outliers (those in glass that are brighter than `floor`).
    fn finish(&self, BackgroundSamples { need, pixels, .. }: &BackgroundSamples, floor: f32) -> Background {
        let (width, height) = (self.width, self.height);
        let alone: Vec<Vec3> = pixels.iter().map(Pixel::mean).collect();
        let value = |i: usize| match neighbourhood(i, [width, height]) {
            Some(around) if need[i] == Need::Neighbours => {
                let channel = |c: usize| Quadratic::through(&around.map(|j| alone[j][c])).middle;
                Vec3::from_array([0, 1, 2].map(channel)).max(Vec3::ZERO)
            }
            _ => alone[i],
        };
        let mut image =
            Image { width, height, pixels: (0..pixels.len()).into_par_iter().map(value).collect() };
        let shows: Vec<Shows> = pixels.iter().map(Pixel::shows).collect();
        let mut lost = clamp_outliers(&mut image, &shows, floor);
        for (lost, pixel) in lost.iter_mut().zip(pixels) {
            *lost += pixel.clamped / pixel.count.max(1) as f32;
        }
        let sum: f64 = lost.iter().copied().map(f64::from).sum();
        let kept: f64 = image.pixels.iter().map(|pixel| f64::from(luminance(*pixel))).sum();
        let share = if sum > 0.0 { sum / (sum + kept) } else { 0.0 };
        let clamped = ClampedLight { pixels: lost.iter().filter(|lost| **lost > 0.0).count(), share };
        Background { image, clamped }
    }

    /// One more path through a pixel.
    fn sample(&self, x: usize, y: usize, pixel: &mut Pixel) {
        let Pixel { sampler, count: index, .. } = *pixel;
        let size = vec2(self.width as f32, self.height as f32);
        let at = vec2(x as f32 + 0.5, y as f32 + 0.5) + tent(sampler.pair(index, 0));
        let place: Vec2 = at / size * 2.0 - 1.0;
        let ray = self.scene.camera().ray(place.x, -place.y, size.x / size.y);
        let radiance = self.radiance(ray, index, pixel);
        pixel.add(if radiance.is_finite() { radiance } else { Vec3::ZERO });
    }

    /// The radiance that arrives along the ray. Ways that branch at glass before a matt surface are followed both, down to faint
    /// ones: a lamp in a reflection of four per cent would sparkle if one path in twenty-five saw it.
    fn radiance(&self, ray: Ray, index: u32, pixel: &mut Pixel) -> Vec3 {
        let beam = Beam::new(Vec3::ONE, self.media);
        let mut rest = vec![Open { ray, beam, surfaces: 0 }];
        let mut radiance = Vec3::ZERO;
        while let Some(path) = rest.pop() {
            radiance += self.follow(path, index, pixel, &mut rest);
        }
        radiance
    }

    /// The radiance along one path; other ways at its branches go to `rest`.
    fn follow(
        &self,
        Open { mut ray, mut beam, surfaces }: Open,
        index: u32,
        Pixel { sampler, rng, clamped, specular, even, .. }: &mut Pixel,
        rest: &mut Vec<Open>,
    ) -> Vec3 {
        let (scene, sampler) = (self.scene, *sampler);
        let mut radiance = Vec3::ZERO;
        let mut bounces = 0;
        for surface in surfaces..MAX_SURFACES {
            let hit = scene.intersect(&ray);
            if bounces == 0 {
                // Rays pass through lights: the radiance behind is added.
                let seen = beam.weight * self.lights_along(&ray, hit.map_or(f32::INFINITY, |hit| hit.t));
                let most = if surface == 0 { f32::INFINITY } else { self.firefly_limit };
                let bright = luminance(seen);
                radiance += seen * (most / bright.max(f32::MIN_POSITIVE)).min(1.0);
                *clamped += (bright - most).max(0.0);
            }
            *even &= surface > 0 || hit.is_some_and(|hit| hit.surface.is_ground());
            let Some(hit) = hit else {
                return radiance + beam.weight * scene.environment().radiance(ray.direction);
            };
            beam.travel(scene.meshes(), hit.t);
            let material = scene.material(hit.surface);
            *specular |= surface == 0 && material.is_specular();
            let next = if let Material::Diffuse(diffuse) = material {
                beam.weight *= Vec3::from(diffuse.albedo);
                let (geometric, normal) = facing_normals(&hit, ray.direction);
                radiance += beam.weight * self.direct(&hit, geometric, normal, index, bounces, sampler);
                let next = cosine_direction(normal, sampler.pair(index, 1 + bounces));
                bounces += 1;
                (bounces <= BOUNCES && next.dot(geometric) > 0.0).then_some(next)
            } else {
                let least = if bounces == 0 { FAINT_WAY } else { f32::INFINITY };
                let [way, other] =
                    material.split(scene.geometry(), &hit, ray.direction, beam.clone(), least, rng);
                rest.extend(other.map(|(direction, beam)| Open {
                    ray: Ray::leaving(&hit, direction),
                    beam,
                    surfaces: surface + 1,
                }));
                way.map(|(direction, light)| {
                    beam = light;
                    direction
                })
            };
            let Some(next) = next else { return radiance };
            let (strength, faint) = (beam.weight.max_element(), if bounces == 0 { FAINT_WAY } else { FAINT });
            if strength < faint {
                if rng.f32() * faint >= strength {
                    return radiance;
                }
                beam.weight *= faint / strength;
            }
            ray = Ray::leaving(&hit, next);
        }
        radiance
    }

    /// The lights that are seen, with their numbers.
    fn lights(&self) -> impl Iterator<Item = (usize, &LightDesc)> {
        self.scene.lights().iter().enumerate().filter(|(_, light)| light.role() != LightRole::Caustics)
    }

    /// Radiance of the area lights on the ray before `distance`.
    fn lights_along(&self, ray: &Ray, distance: f32) -> Vec3 {
        let met = self.lights().filter_map(|(_, light)| light.intersect(ray));
        met.filter(|(t, _)| *t < distance).map(|(_, radiance)| radiance).sum()
    }

    /// Direct lighting: the radiance of a white matt surface lit by all lights.
    fn direct(
        &self,
        hit: &Hit,
        geometric: Vec3,
        normal: Vec3,
        index: u32,
        bounce: u32,
        sampler: Sampler,
    ) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for (i, light) in self.lights() {
            let pair = (i as u32 + 1) * 16 + bounce;
            let Some(lit) = light.illuminate(hit.point, sampler.pair(index, pair)) else { continue };
            let cosine = lit.direction.dot(normal);
            if cosine <= 0.0 || lit.direction.dot(geometric) <= 0.0 {
                continue;
            }
            if !self.scene.occluded(&Ray::leaving(hit, lit.direction), lit.distance) {
                sum += lit.irradiance * cosine;
            }
        }
        sum / std::f32::consts::PI
    }
}

/// A cosine-weighted direction around `normal`.
fn cosine_direction(normal: Vec3, u: [f32; 2]) -> Vec3 {
    let (x, y) = normal.any_orthonormal_pair();
    let (sin, cos) = (std::f32::consts::TAU * u[0]).sin_cos();
    let radius = u[1].sqrt();
    (x * (radius * cos) + y * (radius * sin) + normal * (1.0 - u[1]).max(0.0).sqrt()).normalize()
}
