//! The light that does not flow, in every frame: it shows the physical caustic, and fades as that one leaves.

use glam::{Vec2, Vec3, vec2};
use rayon::prelude::*;

use super::energy_balance::between;
use super::grouping::Grouping;
use crate::photon::{EmissionGuiding, LightPart, Photons, Tracer};
use crate::project::{Project, SegmentTime, Shows};
use crate::render::density::{KernelFilter, default_radius};
use crate::render::splat::Splatter;
use crate::render::{
    Image, ReceiverTexture, StillPictures, StillTextures, still_layout, still_pictures, watts_at,
};
use crate::scene::Scene;
use crate::{Progress, Result};

/// Most photons: enough for light that is smoothed more than what flows.
const MOST_PHOTONS: u64 = 2_000_000;
/// Most texels along the receiver's longer side.
const MOST_TEXELS: f32 = 1024.0;
/// Random-stream pass number of its photons; no render reaches it.
const PASS: u64 = u64::MAX - 2;

/// Shares of the light of a caustic in the frames: RGB factors by key frame, linear in the time between.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, serde::Serialize)]
pub(super) struct StillShares {
    /// Of what stays on the border and the floor: 1 while the caustic is physical.
    stays: Vec<Vec3>,
    /// Of what glass keeps of the whole caustic while it shows something else.
    kept: Vec<Vec3>,
}

/// The shares of each group; none for one that is physical at no key.
pub(super) fn shares(project: &Project, grouping: &Grouping) -> Vec<Option<StillShares>> {
    let of_group = |group: usize| {
        let gain =
            |key: usize| grouping.gains(project, key)[group] * if key == 0 { 1.0 } else { project.flow.rho };
        let shows = |key: usize| project.keys[key].shown_by(grouping.name(group));
        let physical: Vec<bool> =
            (0..project.keys.len()).map(|key| *shows(key) == Shows::PhysicalCaustic).collect();
        let first = gain(physical.iter().position(|physical| *physical)?) * project.render.kept_in_glass;
        let share = |stays: bool, (key, is_physical): (usize, &bool)| match (is_physical, stays) {
            (true, true) => gain(key),
            (false, false) => first,
            (true, false) | (false, true) => Vec3::ZERO,
        };
        Some(StillShares {
            stays: physical.iter().enumerate().map(|key| share(true, key)).collect(),
            kept: physical.iter().enumerate().map(|key| share(false, key)).collect(),
        })
    };
    (0..grouping.count()).map(of_group).collect()
}

/// The light that does not flow, as the camera sees it.
#[derive(serde::Deserialize, serde::Serialize)]
pub(super) struct StillLight {
    /// Groups with equal shares have their pictures in common, unless all are wanted apart.
    layers: Vec<Layer>,
}

/// The light of some groups of photons.
#[derive(serde::Deserialize, serde::Serialize)]
struct Layer {
    /// By number, in order.
    groups: Vec<usize>,
    shares: StillShares,
    pictures: StillPictures,
    /// What stays, on the plane, where that is wanted.
    on_plane: Option<ReceiverTexture>,
}

impl StillLight {
    /// Traces and renders the light of groups with these shares.
    ///
    /// # Errors
    /// No caustic falls on the receiver; cancelled.
    pub(super) fn new(
        scene: &Scene,
        project: &Project,
        (grouping, shares): (&Grouping, &[Option<StillShares>]),
        progress: &Progress,
    ) -> Result<Self> {
        let layers = layers(shares, project.output.separates_caustics());
        if layers.is_empty() {
            return Ok(Self { layers: Vec::new() });
        }
        let (render, seed) = (&project.render, project.seed);
        let count = render.photons.saturating_mul(render.passes.into()).min(MOST_PHOTONS.max(render.photons));
        let tracer =
            Tracer::of_part((scene, LightPart::Shown), EmissionGuiding::Learned, seed, &progress.inner())?;
        let (photons, _) = tracer.trace(PASS, count as usize, &progress.inner())?;
        let textures = layers.iter().map(|(groups, _)| {
            let is_in =
                |row: &usize| groups.contains(&grouping.group_of(photons.light[*row], photons.mesh[*row]));
            let rows: Vec<usize> = (0..photons.len()).filter(is_in).collect();
            textures(scene, render.max_texels, &photons, &rows)
        });
        let textures: Vec<StillTextures> = textures.collect();
        let pictures = still_pictures(scene, &textures, render, seed, progress)?;
        let layers =
            layers.into_iter().zip(pictures).zip(textures).map(|(((groups, shares), pictures), light)| {
                let on_plane = project.output.shows_plane().then_some(light.stays);
                Layer { groups, shares: shares.clone(), pictures, on_plane }
            });
        Ok(Self { layers: layers.collect() })
    }

    /// Adds the light of a moment to a picture of the same size: that of one group, which must be apart, or of all.
    pub(super) fn add_to(&self, picture: &mut Image, group: Option<usize>, moment: SegmentTime) {
        let wanted = |layer: &&Layer| group.is_none_or(|group| layer.groups == [group]);
        for Layer { shares, pictures: StillPictures { stays, in_glass }, .. } in
            self.layers.iter().filter(wanted)
        {
            for (share, light) in [(&shares.stays, stays), (&shares.kept, in_glass)] {
                let now = share_at(share, moment);
                if now != Vec3::ZERO {
                    let pixels = picture.pixels.iter_mut().zip(&light.pixels);
                    pixels.for_each(|(pixel, light)| *pixel += now * *light);
                }
            }
        }
    }

    /// Adds what stays of all groups to the irradiance on a receiver of `extent` (W/m²), where its textures were wanted; the
    /// top row is its upper edge.
    pub(super) fn add_to_plane(
        &self,
        irradiance: &mut Image,
        (extent, metres): (Vec2, f32),
        moment: SegmentTime,
    ) {
        let size = vec2(irradiance.width as f32, irradiance.height as f32);
        let lights = self.layers.iter().filter_map(|layer| Some((&layer.shares, layer.on_plane.as_ref()?)));
        for (shares, texture) in lights {
            let now = share_at(&shares.stays, moment) / (texture.layout().texel * metres).powi(2);
            if now == Vec3::ZERO {
                continue;
            }
            let width = irradiance.width;
            irradiance.pixels.par_iter_mut().enumerate().for_each(|(i, pixel)| {
                let place = vec2((i % width) as f32 + 0.5, (i / width) as f32 + 0.5) / size;
                *pixel += now * watts_at(texture, vec2(place.x, 1.0 - place.y) * extent);
            });
        }
    }
}

/// A share at a moment. A picture may be asked for a moment of a project that has got more keys since.
fn share_at(share: &[Vec3], SegmentTime { segment, time }: SegmentTime) -> Vec3 {
    let ends = [segment, segment + 1].map(|key| share[key.min(share.len() - 1)]);
    Vec3::from([0, 1, 2].map(|c| between(ends.map(|end| end[c].into()), time) as f32))
}

/// The groups that have light that does not flow: those with equal shares together, or each `apart`.
fn layers(shares: &[Option<StillShares>], apart: bool) -> Vec<(Vec<usize>, &StillShares)> {
    let mut layers: Vec<(Vec<usize>, &StillShares)> = Vec::new();
    for (group, shares) in shares.iter().enumerate() {
        let Some(shares) = shares else { continue };
        match layers.iter_mut().find(|(_, of)| !apart && *of == shares) {
            Some((groups, _)) => groups.push(group),
            None => layers.push((vec![group], shares)),
        }
    }
    layers
}

/// The light of some photons on the receiver and the floor: what stays, and all.
fn textures(scene: &Scene, most_texels: u32, photons: &Photons, rows: &[usize]) -> StillTextures {
    let receiver = scene.receiver();
    let layout = still_layout(scene, MOST_TEXELS.min(most_texels as f32) as usize);
    let size = receiver.extent() + Vec2::splat(2.0 * receiver.margin());
    let radius = default_radius(photons.len(), size.x * size.y).min(0.5);
    let positions: Vec<Vec2> = rows.iter().map(|&row| photons.positions[row]).collect();
    let texture = |share: &dyn Fn(Vec2) -> f32| {
        let flux: Vec<Vec3> =
            rows.iter().map(|&row| photons.flux[row] * share(photons.positions[row])).collect();
        let mut texture = ReceiverTexture::new(layout);
        Splatter::default().splat(&positions, &flux, &mut texture);
        KernelFilter::default().filter(&mut texture, radius);
        texture
    };
    StillTextures { stays: texture(&|place| 1.0 - receiver.flowing_share(place)), all: texture(&|_| 1.0) }
}
