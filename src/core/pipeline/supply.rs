//! What the key frames show, ready to give the photons of any pass.

use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

use super::grouping::{CausticLight, Grouping};
use crate::flow::flux;
use crate::matching::Method;
use crate::photon::Tracer;
use crate::project::{AssetFolder, Project, Shows};
use crate::scene::Scene;
use crate::target::{PictureSampler, Points, load_points};
use crate::{Error, Progress, Result};

/// The photons of one group in one pass at one key frame: columns of equal length.
#[derive(Clone, Debug, Default)]
pub(super) struct KeyPhotons {
    /// Plane coordinates.
    pub(super) positions: Vec<Vec2>,
    /// RGB flux in watts.
    pub(super) flux: Vec<Vec3>,
    /// Which traced photon each is, where they shall stay in place until the next key; else empty.
    origin: Vec<u32>,
    /// How far the photons' ways to this key bow from the straight ones at half-time; empty where the method bows none.
    pub(super) bows: Vec<Vec2>,
}

/// What a group shows at a key frame, resolved.
enum Supply {
    Physical,
    Picture(PictureSampler),
    Points(Points),
}

/// All key frames of a project, resolved.
pub(super) struct Supplies {
    /// By key, then by group.
    shown: Vec<Vec<Arc<Supply>>>,
    /// Factor on the light, by key, then by group.
    gains: Vec<Vec<Vec3>>,
    grouping: Grouping,
    traces: bool,
    notes: Vec<String>,
    seed: u64,
    rho: f32,
    watts: f32,
}

/// The light of one group in one pass.
struct GroupLight {
    /// The traced photons where a key shows them.
    physical: Option<KeyPhotons>,
    /// Flux of all its photons, watts, which the other keys share out.
    total: DVec3,
    /// How many they are.
    count: usize,
}

/// The light of one pass, group by group.
pub(super) struct PassLight {
    groups: Vec<GroupLight>,
}

impl Supplies {
    /// Opens the pictures and point files of a project, and finds its caustics in the scene.
    pub(super) fn load(
        project: &Project,
        scene: Option<&Scene>,
        extent: Vec2,
        assets: &AssetFolder,
    ) -> Result<Self> {
        let grouping = Grouping::resolve(project, scene)?;
        let mut notes = Vec::new();
        let mut open = |shows: &Shows, place: String| -> Result<Arc<Supply>> {
            let supply = open(shows, &place, extent, assets)?;
            if let Supply::Picture(picture) = &supply {
                notes.extend(picture.notes().iter().cloned());
            }
            Ok(Arc::new(supply))
        };
        let mut shown = Vec::new();
        for (i, key) in project.keys.iter().enumerate() {
            let mut groups = vec![open(&key.shows, format!("keys[{i}].shows"))?; grouping.count()];
            for (group, of_group) in groups.iter_mut().enumerate() {
                let own = grouping.name(group).and_then(|name| Some((name, key.caustics.get(name)?)));
                if let Some((name, Some(shows))) = own.map(|(name, own)| (name, &own.shows)) {
                    *of_group = open(shows, format!("keys[{i}].caustics.{name}.shows"))?;
                }
            }
            shown.push(groups);
        }
        let gains = (0..project.keys.len()).map(|key| grouping.gains(project, key)).collect();
        Ok(Self {
            shown,
            gains,
            grouping,
            traces: project.traces(),
            notes,
            seed: project.seed,
            rho: project.flow.rho,
            watts: project.plane.watts,
        })
    }

    /// What was odd about a picture, such as pixels that were not finite.
    pub(super) fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// The seed of all random numbers.
    pub(super) fn seed(&self) -> u64 {
        self.seed
    }

    /// The groups of photons.
    pub(super) fn grouping(&self) -> &Grouping {
        &self.grouping
    }

    /// Whether `count` photons show all there is, so that another pass would bring nothing new.
    pub(super) fn is_fixed(&self, count: usize) -> bool {
        let is_fixed = |supply: &Arc<Supply>| match &**supply {
            Supply::Points(points) => points.positions.len() <= count,
            Supply::Physical | Supply::Picture(_) => false,
        };
        self.grouping.count() == 1 && self.shown.iter().flatten().all(is_fixed)
    }

    /// The rows of the point files where rows are paired as given: all files must have the same number.
    pub(super) fn given_rows(&self, method: Method) -> Result<Option<usize>> {
        let mut rows = None;
        for (i, key) in self.shown.iter().enumerate() {
            let (Supply::Points(points), Method::Given) = (&*key[0], method) else { continue };
            let count = points.positions.len();
            match rows {
                Some(first) if first != count => {
                    let what = format!(
                        "has {count} points but the first key has {first}; \"given\" pairs row with row"
                    );
                    return Err(Error::value(format!("keys[{i}].shows.points.file"), what));
                }
                _ => rows = Some(count),
            }
        }
        Ok(rows)
    }

    /// Traces the photons of `pass`, where a key shows them or caustics are told apart.
    pub(super) fn light(
        &self,
        tracer: Option<&Tracer>,
        pass: u64,
        count: usize,
        progress: &Progress,
    ) -> Result<PassLight> {
        let Some(tracer) = tracer.filter(|_| self.traces) else {
            let total = DVec3::splat(f64::from(self.watts) / 3.0);
            return Ok(PassLight { groups: vec![GroupLight { physical: None, total, count }] });
        };
        let (photons, _) = tracer.trace(pass, count, progress)?;
        let shares = self.grouping.split(photons).into_iter().enumerate();
        let groups = shares.map(|(group, share)| GroupLight {
            total: share.total,
            count: share.positions.len(),
            physical: self.shows_physical(group).then_some(KeyPhotons {
                positions: share.positions,
                flux: share.flux,
                ..KeyPhotons::default()
            }),
        });
        Ok(PassLight { groups: groups.collect() })
    }

    /// Whether photons must be traced.
    pub(super) fn traces(&self) -> bool {
        self.traces
    }

    fn shows_physical(&self, group: usize) -> bool {
        self.shown.iter().any(|key| matches!(*key[group], Supply::Physical))
    }

    /// Whether the photons of a group stay in place from key `key` to the next: it is the physical caustic at both.
    pub(super) fn rests(&self, key: usize, group: usize) -> bool {
        let physical =
            |key: usize| self.shown.get(key).is_some_and(|k| matches!(*k[group], Supply::Physical));
        physical(key) && physical(key + 1)
    }

    /// The photons of a group at key `key` in `pass`.
    ///
    /// Pictures and points share the flux of the group evenly (Sec. 3, "Flux Blending"), times rho except at the first
    /// key, times the caustic's colour and brightness, times their own relative colours.
    pub(super) fn key(&self, key: usize, group: usize, light: &PassLight, pass: u64) -> KeyPhotons {
        let GroupLight { physical, total, count } = &light.groups[group];
        // Keys and caustics draw from seeds of their own, so that two with one picture are not the same points.
        let number = (group + 1) as u64 % self.grouping.count() as u64;
        let seed = self.seed ^ ((key as u64) << 40) ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let gain = self.gains[key][group] * if key == 0 { 1.0 } else { self.rho };
        let points = match &*self.shown[key][group] {
            Supply::Physical => {
                let mut photons = physical.clone().unwrap_or_default();
                photons.flux.iter_mut().for_each(|flux| *flux *= gain);
                if self.rests(key, group) {
                    photons.origin = (0..photons.positions.len() as u32).collect();
                }
                return photons;
            }
            Supply::Picture(picture) => picture.sample(seed, pass, *count),
            Supply::Points(points) => points.resampled(*count, seed, pass),
        };
        let flux = flux::share_out(*total * gain.as_dvec3(), &points.colours, *count);
        KeyPhotons { positions: points.positions, flux, ..KeyPhotons::default() }
    }

    /// The flux that the photons of a pass should have at key `key`, watts; rho does not count.
    pub(super) fn asked(&self, key: usize, light: &PassLight) -> f64 {
        let gains = self.gains[key].iter().map(|gain| gain.as_dvec3());
        light.groups.iter().zip(gains).map(|(group, gain)| (group.total * gain).element_sum()).sum()
    }

    /// How the light of a pass falls to the caustics; empty where none is named.
    pub(super) fn caustics(&self, light: &PassLight) -> Vec<CausticLight> {
        self.grouping.lights(light.groups.iter().map(|group| (group.count, group.total)))
    }
}

fn open(shows: &Shows, place: &str, extent: Vec2, assets: &AssetFolder) -> Result<Supply> {
    Ok(match shows {
        Shows::PhysicalCaustic => Supply::Physical,
        Shows::Image(image) => {
            let place = format!("{place}.image");
            let path = assets.resolve(&image.file, &format!("{place}.file"))?;
            Supply::Picture(PictureSampler::load(&path, image, extent, &place)?)
        }
        Shows::Points(points) => {
            let path = assets.resolve(&points.file, &format!("{place}.points.file"))?;
            Supply::Points(load_points(&path)?)
        }
    })
}

impl PassLight {
    /// Groups of photons.
    pub(super) fn groups(&self) -> usize {
        self.groups.len()
    }
}

impl KeyPhotons {
    /// Row k of the result is row `order[k]` of this, not yet paired.
    pub(super) fn permuted(&self, order: &[u32]) -> Self {
        let origin = if self.origin.is_empty() {
            Vec::new()
        } else {
            order.iter().map(|&i| self.origin[i as usize]).collect()
        };
        Self {
            positions: order.iter().map(|&i| self.positions[i as usize]).collect(),
            flux: order.iter().map(|&i| self.flux[i as usize]).collect(),
            origin,
            bows: Vec::new(),
        }
    }

    /// The traced photons `next`, each in the row in which it stands here.
    pub(super) fn in_place(&self, next: &Self) -> Self {
        next.permuted(&self.origin)
    }
}
