//! What the key frames show, ready to give the photons of any pass.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

use super::grouping::{CausticLight, Grouping};
use super::light::{GroupLight, KeyPhotons, PassLight};
use super::stage::Stamp;
use crate::flow::flux;
use crate::matching::Method;
use crate::photon::{Photons, Tracer};
use crate::project::{AssetFolder, Project, Shows};
use crate::scene::Scene;
use crate::targets::{PictureSampler, Points, load_points};
use crate::{Error, Progress, Result};

/// What a group shows at a key frame, resolved.
pub(super) enum Supply {
    Physical,
    Picture(PictureSampler),
    Points(Points),
}

/// What the keys of a project showed last, resolved: a picture that they go on showing is not read again.
#[derive(Default)]
pub(super) struct Opened {
    known: Vec<Known>,
}

/// Something that was opened.
struct Known {
    from: OpenInput,
    supply: Arc<Supply>,
    /// Whether a key still shows it.
    shown: bool,
}

/// What a supply is made from.
#[derive(PartialEq)]
struct OpenInput {
    shows: Shows,
    extent: Vec2,
    file: Option<Stamp>,
}

/// All key frames of a project, resolved.
#[derive(Clone)]
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
    /// The rows of point files that stand for all, where rows are paired as given and not all are wanted.
    rows: Option<Vec<usize>>,
}

impl Supplies {
    /// Opens the pictures and point files of a project, and finds its caustics in the scene.
    pub(super) fn load(
        project: &Project,
        scene: Option<&Scene>,
        extent: Vec2,
        (assets, opened): (&AssetFolder, &mut Opened),
        progress: &Progress,
    ) -> Result<Self> {
        let grouping = Grouping::resolve(project, scene)?;
        let mut notes = Vec::new();
        opened.known.iter_mut().for_each(|known| known.shown = false);
        let mut open = |shows: &Shows, place: String| -> Result<Arc<Supply>> {
            progress.check()?;
            let supply = opened.get(shows, &place, extent, assets)?;
            if let Supply::Picture(picture) = &*supply {
                notes.extend(picture.notes().iter().cloned());
            }
            Ok(supply)
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
        opened.known.retain(|known| known.shown);
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
            rows: None,
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

    /// The same with other random numbers.
    pub(super) fn with_seed(&self, seed: u64) -> Self {
        Self { seed, ..self.clone() }
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

    /// The same of which at most `count` rows of the point files, the same of each, stand for all where rows are paired as
    /// given; and how many photons that leaves of `count`.
    pub(super) fn thinned(&self, method: Method, count: usize) -> Result<(Self, usize)> {
        let mut thinned = self.clone();
        let Some(rows) = self.given_rows(method)? else { return Ok((thinned, count)) };
        if rows > count {
            let row = |i: usize| (i as u128 * rows as u128 / count as u128) as usize;
            thinned.rows = Some((0..count).map(row).collect());
        }
        Ok((thinned, rows.min(count)))
    }

    /// What all groups show at a key.
    pub(super) fn shown_at(&self, key: usize) -> &[Arc<Supply>] {
        &self.shown[key]
    }

    /// Traces the photons of `pass`, where a key shows them or caustics are told apart.
    pub(super) fn light(
        &self,
        tracer: Option<&Tracer>,
        pass: u64,
        count: usize,
        progress: &Progress,
    ) -> Result<PassLight> {
        let photons = match tracer.filter(|_| self.traces) {
            Some(tracer) => Some(tracer.trace(pass, count, progress)?.0),
            None => None,
        };
        Ok(self.light_of(photons, count))
    }

    /// The light of `count` photons: those that were traced, where any must be.
    pub(super) fn light_of(&self, photons: Option<Photons>, count: usize) -> PassLight {
        let Some(photons) = photons else {
            let total = DVec3::splat(f64::from(self.watts) / 3.0);
            return PassLight { groups: vec![GroupLight { physical: None, total, count }] };
        };
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
        PassLight { groups: groups.collect() }
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
            Supply::Points(points) => match &self.rows {
                Some(rows) => points.rows(rows),
                None => points.resampled(*count, seed, pass),
            },
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

impl Opened {
    /// What `shows` means, which stands at `place`: as it is known, if its file is still the same.
    fn get(&mut self, shows: &Shows, place: &str, extent: Vec2, assets: &AssetFolder) -> Result<Arc<Supply>> {
        let file = match shows {
            Shows::PhysicalCaustic => None,
            Shows::Image(image) => Some(assets.resolve(&image.file, &format!("{place}.image.file"))?),
            Shows::Points(points) => Some(assets.resolve(&points.file, &format!("{place}.points.file"))?),
        };
        let from = OpenInput { shows: shows.clone(), extent, file: file.as_deref().map(Stamp::of) };
        if let Some(known) = self.known.iter_mut().find(|known| known.from == from) {
            known.shown = true;
            return Ok(known.supply.clone());
        }
        let supply = Arc::new(open(shows, file.as_deref(), place, extent)?);
        self.known.push(Known { from, supply: supply.clone(), shown: true });
        Ok(supply)
    }
}

fn open(shows: &Shows, file: Option<&Path>, place: &str, extent: Vec2) -> Result<Supply> {
    Ok(match (shows, file) {
        (Shows::Image(image), Some(path)) => {
            Supply::Picture(PictureSampler::load(path, image, extent, &format!("{place}.image"))?)
        }
        (Shows::Points(_), Some(path)) => Supply::Points(load_points(path)?),
        _ => Supply::Physical,
    })
}
