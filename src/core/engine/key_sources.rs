//! The sources of the light at the key frames: the physical caustic, pictures and points, ready to give the photons of any
//! pass.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

use super::grouping::{CausticFlux, Grouping};
use super::key_photons::{GroupLight, KeyPhotons, PassLight, colours};
use super::memo::{FileStamp, Same};
use crate::flow::flux;
use crate::matching::MatchingMethod;
use crate::note::About;
use crate::photon::Photons;
use crate::project::{AssetFolder, Project, Shows};
use crate::scene::Scene;
use crate::targets::{PictureSampler, Points, load_points};
use crate::{Error, Note, Progress, Result};

/// The source of a group's light at a key frame.
pub(super) enum KeySource {
    Physical,
    Picture(PictureSampler),
    Points(Points),
}

/// Everything that a source depends on.
#[derive(PartialEq)]
pub(super) struct SourceInput {
    shows: Shows,
    extent: Vec2,
    file: Option<FileStamp>,
}

/// The sources at all key frames of a project.
#[derive(Clone)]
pub(super) struct KeySources {
    /// By key, then by group.
    shown: Vec<Vec<Arc<KeySource>>>,
    /// Factor on the light, by key, then by group.
    gains: Vec<Vec<Vec3>>,
    grouping: Grouping,
    traces: bool,
    notes: Vec<Note>,
    seed: u64,
    rho: f32,
    watts: f32,
    /// The rows of point files that stand for all, where rows are paired as given and not all are wanted.
    rows: Option<Vec<usize>>,
}

/// Opens what a key shows: gets it, its place in the project and a number of its own.
type OpenSource<'a> = dyn Fn(&Shows, &str, usize) -> Result<Arc<KeySource>> + 'a;

impl KeySources {
    /// Opens the pictures and point files of a project by `open`, which gets the source, its place in the project and a
    /// number of its own, and finds the caustics in the scene.
    pub(super) fn load(project: &Project, scene: Option<&Scene>, open: &OpenSource<'_>) -> Result<Self> {
        let grouping = Grouping::resolve(project, scene)?;
        let mut notes = Vec::new();
        let mut open =
            |shows: &Shows, place: String, (key, slot): (usize, usize)| -> Result<Arc<KeySource>> {
                let source = open(shows, &place, slot)?;
                if let KeySource::Picture(picture) = &*source {
                    notes.extend(About::Key(key).notes(picture.notes().iter().cloned()));
                }
                Ok(source)
            };
        let mut shown = Vec::new();
        let slots = grouping.count() + 1;
        for (i, key) in project.keys.iter().enumerate() {
            let shared = open(&key.shows, format!("keys[{i}].shows"), (i, i * slots))?;
            let mut groups = vec![shared; grouping.count()];
            for (group, of_group) in groups.iter_mut().enumerate() {
                let own = grouping.name(group).and_then(|name| Some((name, key.caustics.get(name)?)));
                if let Some((name, Some(shows))) = own.map(|(name, own)| (name, &own.shows)) {
                    let place = format!("keys[{i}].caustics.{name}.shows");
                    *of_group = open(shows, place, (i, i * slots + 1 + group))?;
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
            rows: None,
        })
    }

    /// Notes on the pictures, such as on pixels that are not finite.
    pub(super) fn notes(&self) -> Vec<Note> {
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
        let is_fixed = |supply: &Arc<KeySource>| match &**supply {
            KeySource::Points(points) => points.positions.len() <= count,
            KeySource::Physical | KeySource::Picture(_) => false,
        };
        self.grouping.count() == 1 && self.shown.iter().flatten().all(is_fixed)
    }

    /// The rows of the point files where rows are paired as given: all files must have the same number.
    pub(super) fn given_rows(&self, method: MatchingMethod) -> Result<Option<usize>> {
        let mut rows = None;
        for (i, key) in self.shown.iter().enumerate() {
            let (KeySource::Points(points), MatchingMethod::Given) = (&*key[0], method) else { continue };
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
    /// given; and the number of photons that remain of `count`.
    pub(super) fn thinned(&self, method: MatchingMethod, count: usize) -> Result<(Self, usize)> {
        let mut thinned = self.clone();
        let Some(rows) = self.given_rows(method)? else { return Ok((thinned, count)) };
        if rows > count {
            let row = |i: usize| (i as u128 * rows as u128 / count as u128) as usize;
            thinned.rows = Some((0..count).map(row).collect());
        }
        Ok((thinned, rows.min(count)))
    }

    /// The sources of all groups at a key frame, by identity.
    pub(super) fn at_key(&self, key: usize) -> Vec<Same<KeySource>> {
        self.shown[key].iter().map(Same::of).collect()
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
                colours: colours(&share.flux),
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
        self.shown.iter().any(|key| matches!(*key[group], KeySource::Physical))
    }

    /// Whether the photons of a group stay in place from key `key` to the next: it is the physical caustic at both.
    pub(super) fn rests(&self, key: usize, group: usize) -> bool {
        let physical =
            |key: usize| self.shown.get(key).is_some_and(|k| matches!(*k[group], KeySource::Physical));
        physical(key) && physical(key + 1)
    }

    /// The photons of a group at key `key` in `pass`.
    ///
    /// Pictures and points share the flux of the group evenly (Sec. 3, "Flux Blending"), times rho except at the first
    /// key, times the caustic's colour and brightness, times their own relative colours. Without colours of their own their
    /// light is that of the whole group, until photons bring theirs ([`Self::keep_colours`]).
    pub(super) fn key(&self, key: usize, group: usize, light: &PassLight, pass: u64) -> KeyPhotons {
        let GroupLight { physical, total, count } = &light.groups[group];
        // Keys and caustics draw from seeds of their own, so that two with one picture are not the same points.
        let number = (group + 1) as u64 % self.grouping.count() as u64;
        let seed = self.seed ^ ((key as u64) << 40) ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let gain = self.gain(key, group);
        let points = match &*self.shown[key][group] {
            KeySource::Physical => {
                let mut photons = physical.clone().unwrap_or_default();
                photons.flux.iter_mut().for_each(|flux| *flux *= gain);
                if self.rests(key, group) {
                    photons.origin = (0..photons.positions.len() as u32).collect();
                }
                return photons;
            }
            KeySource::Picture(picture) => picture.sample(seed, pass, *count),
            KeySource::Points(points) => match &self.rows {
                Some(rows) => points.rows(rows),
                None => points.resampled(*count, seed, pass),
            },
        };
        let flux = flux::share_out(*total * gain.as_dvec3(), &points.colours, *count);
        let colours = if points.colours.is_empty() {
            Vec::new()
        } else {
            colours(&flux::share_out(*total, &points.colours, *count))
        };
        KeyPhotons { positions: points.positions, flux, colours, ..KeyPhotons::default() }
    }

    /// Gives the photons of a group the colours that they have at the key frame before `key`, where `key` gives none: each
    /// keeps its own, and as much light as before.
    pub(super) fn keep_colours(
        &self,
        (key, group): (usize, usize),
        before: &KeyPhotons,
        at: &mut KeyPhotons,
    ) {
        if at.colours.is_empty() && before.colours.len() == at.flux.len() {
            at.flux = flux::coloured(flux::total(&at.flux), &before.colours, self.gain(key, group));
            at.colours.clone_from(&before.colours);
        }
    }

    /// Factor on the light of a group at a key.
    fn gain(&self, key: usize, group: usize) -> Vec3 {
        self.gains[key][group] * if key == 0 { 1.0 } else { self.rho }
    }

    /// The flux that the photons of a pass should have at key `key`, watts; rho does not count.
    pub(super) fn requested(&self, key: usize, light: &PassLight) -> f64 {
        let gains = self.gains[key].iter().map(|gain| gain.as_dvec3());
        light.groups.iter().zip(gains).map(|(group, gain)| (group.total * gain).element_sum()).sum()
    }

    /// The flux of each caustic in a pass; empty where none is named.
    pub(super) fn caustics(&self, light: &PassLight) -> Vec<CausticFlux> {
        self.grouping.lights(light.groups.iter().map(|group| (group.count, group.total)))
    }
}

impl SourceInput {
    /// The input of the source that `shows` asks for at `place` of the project, and its file.
    ///
    /// # Errors
    /// A file outside the folders that a project may read.
    pub(super) fn new(
        shows: &Shows,
        place: &str,
        extent: Vec2,
        assets: &AssetFolder,
    ) -> Result<(Self, Option<PathBuf>)> {
        let file = match shows {
            Shows::PhysicalCaustic => None,
            Shows::Image(image) => Some(assets.resolve(&image.file, &format!("{place}.image.file"))?),
            Shows::Points(points) => Some(assets.resolve(&points.file, &format!("{place}.points.file"))?),
        };
        let stamp = file.as_deref().map(FileStamp::of);
        Ok((Self { shows: shows.clone(), extent, file: stamp }, file))
    }
}

/// Reads the picture or the points of a source.
///
/// # Errors
/// A file that cannot be read, with the place in the project that names it.
pub(super) fn open(
    shows: &Shows,
    file: Option<&Path>,
    (place, extent): (&str, Vec2),
    progress: &Progress,
) -> Result<KeySource> {
    Ok(match (shows, file) {
        (Shows::Image(image), Some(path)) => {
            let place = format!("{place}.image");
            KeySource::Picture(PictureSampler::load_cancellable(path, image, (extent, &place), progress)?)
        }
        (Shows::Points(_), Some(path)) => KeySource::Points(load_points(path)?),
        _ => KeySource::Physical,
    })
}
