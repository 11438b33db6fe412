//! What the key frames show, ready to give the photons of any pass.

use glam::{DVec3, Vec2, Vec3};

use crate::flow::flux;
use crate::matching::Method;
use crate::photon::Tracer;
use crate::project::{AssetFolder, Project, Shows};
use crate::target::{PictureSampler, Points, load_points};
use crate::{Error, Progress, Result};

/// The photons of one pass at one key frame: columns of equal length.
#[derive(Clone, Debug, Default)]
pub(super) struct KeyPhotons {
    /// Plane coordinates.
    pub(super) positions: Vec<Vec2>,
    /// RGB flux in watts.
    pub(super) flux: Vec<Vec3>,
    /// How far the photons' ways to this key bow from the straight ones at half-time; empty where the method bows none.
    pub(super) bows: Vec<Vec2>,
}

/// One key frame, resolved.
enum Supply {
    Physical,
    Picture(PictureSampler),
    Points(Points),
}

/// All key frames of a project, resolved.
pub(super) struct Supplies {
    keys: Vec<Supply>,
    seed: u64,
    rho: f32,
    watts: f32,
}

/// The light of one pass: the traced caustic where a key shows it, and the flux the other keys share out.
pub(super) struct PassLight {
    physical: Option<KeyPhotons>,
    /// Flux of all photons of the pass, watts.
    total: DVec3,
}

impl Supplies {
    /// Opens the pictures and point files of a project.
    pub(super) fn load(project: &Project, extent: Vec2, assets: &AssetFolder) -> Result<Self> {
        let open = |(i, shows): (usize, &Shows)| -> Result<Supply> {
            Ok(match shows {
                Shows::PhysicalCaustic => Supply::Physical,
                Shows::Image(image) => {
                    let place = format!("keys[{i}].shows.image");
                    let path = assets.resolve(&image.file, &format!("{place}.file"))?;
                    Supply::Picture(PictureSampler::load(&path, image, extent, &place)?)
                }
                Shows::Points(points) => {
                    let path = assets.resolve(&points.file, &format!("keys[{i}].shows.points.file"))?;
                    Supply::Points(load_points(&path)?)
                }
            })
        };
        let keys = project.keys.iter().map(|key| &key.shows).enumerate().map(open).collect::<Result<_>>()?;
        Ok(Self { keys, seed: project.seed, rho: project.flow.rho, watts: project.plane.watts })
    }

    /// What was odd about a picture, such as pixels that were not finite.
    pub(super) fn notes(&self) -> Vec<String> {
        let pictures = self.keys.iter().filter_map(|key| match key {
            Supply::Picture(picture) => Some(picture),
            _ => None,
        });
        pictures.flat_map(|picture| picture.notes().iter().cloned()).collect()
    }

    /// The seed of all random numbers.
    pub(super) fn seed(&self) -> u64 {
        self.seed
    }

    /// Whether `count` photons show all there is, so that another pass would bring nothing new.
    pub(super) fn is_fixed(&self, count: usize) -> bool {
        self.keys.iter().all(|key| matches!(key, Supply::Points(points) if points.positions.len() <= count))
    }

    /// The rows of the point files where rows are paired as given: all files must have the same number.
    pub(super) fn given_rows(&self, method: Method) -> Result<Option<usize>> {
        let mut rows = None;
        for (i, key) in self.keys.iter().enumerate() {
            let (Supply::Points(points), Method::Given) = (key, method) else { continue };
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

    /// Traces the physical caustic of `pass` where a key shows it.
    pub(super) fn light(
        &self,
        tracer: Option<&Tracer>,
        pass: u64,
        count: usize,
        progress: &Progress,
    ) -> Result<PassLight> {
        let Some(tracer) = tracer.filter(|_| self.shows_physical()) else {
            return Ok(PassLight { physical: None, total: DVec3::splat(f64::from(self.watts) / 3.0) });
        };
        let (photons, _) = tracer.trace(pass, count, progress)?;
        let total = photons.total_flux();
        Ok(PassLight {
            physical: Some(KeyPhotons {
                positions: photons.positions,
                flux: photons.flux,
                ..Default::default()
            }),
            total,
        })
    }

    /// Whether a key shows the physical caustic.
    pub(super) fn shows_physical(&self) -> bool {
        self.keys.iter().any(|key| matches!(key, Supply::Physical))
    }

    /// The photons of key `key` in `pass`, `count` of them.
    ///
    /// Pictures and points share the flux of the pass evenly (Sec. 3, "Flux Blending"), times rho except at the first
    /// key, times their own relative colours.
    pub(super) fn key(&self, key: usize, light: &PassLight, pass: u64, count: usize) -> KeyPhotons {
        // Keys draw from seeds of their own, so that two keys with one picture are not the same points.
        let seed = self.seed ^ ((key as u64) << 40);
        let rho = if key == 0 { 1.0 } else { self.rho };
        let points = match &self.keys[key] {
            Supply::Physical => {
                let mut photons = light.physical.clone().unwrap_or_default();
                photons.flux.iter_mut().for_each(|flux| *flux *= rho);
                return photons;
            }
            Supply::Picture(picture) => picture.sample(seed, pass, count),
            Supply::Points(points) => points.resampled(count, seed, pass),
        };
        let flux = flux::share_out(light.total * f64::from(rho), &points.colours, count);
        KeyPhotons { positions: points.positions, flux, ..Default::default() }
    }
}
