//! The flow for other programs: photon tracks, flux and fields as NPY and NPZ files.

use std::io::{self, Write as _};
use std::path::Path;

use glam::{Vec2, Vec3};
use npyz::WriterBuilder as _;

use super::batch::Batch;
use super::motion::Motion;
use super::passes::{Account, total};
use super::supply::KeyPhotons;
use crate::files::write_atomic;
use crate::flow::{Fields, flux};
use crate::project::Project;
use crate::{Progress, Result};

/// The project with no more photons than the fit itself looks at: those are the tracks that are written.
pub(super) fn with_guides_alone(project: &Project) -> Project {
    let mut project = project.clone();
    project.render.photons = project.render.photons.min(project.flow.guides.into());
    project
}

/// Writes `tracks.npy` (steps + 1, photons, 2), `flux.npy` (steps + 1, photons, 3) and, where the method has fields,
/// `fields.npz` into `out`.
///
/// The steps of all segments follow each other; the end of one segment is the start of the next and stands once.
pub(super) fn write(
    batch: Batch,
    motion: &Motion,
    project: &Project,
    out: &Path,
    progress: &Progress,
    saved: &(dyn Fn(&Path) + Sync),
) -> Result<Account> {
    let stops = stops(batch, motion, progress)?;
    progress.begin("write", 3);
    let steps = project.flow.steps as usize;
    let table = Table { stops: &stops, motion, steps };
    let tracks = out.join("tracks.npy");
    table.write_tracks(&tracks, progress)?;
    saved(&tracks);
    progress.advance(1);
    let flux = out.join("flux.npy");
    let account = table.write_flux(&flux)?;
    saved(&flux);
    progress.advance(1);
    let fields: Vec<&Fields> = motion.segments.iter().filter_map(|segment| segment.course.fields()).collect();
    if !fields.is_empty() {
        let path = out.join("fields.npz");
        write_fields(&path, &fields)?;
        saved(&path);
    }
    progress.advance(1);
    Ok(account)
}

/// The photons at every key, row k always being photon k.
fn stops(mut batch: Batch, motion: &Motion, progress: &Progress) -> Result<Vec<KeyPhotons>> {
    let mut stops = vec![batch.at.clone()];
    for segment in &motion.segments {
        let next = batch.pair(batch.next_points(), segment.map.as_ref(), &progress.inner())?;
        stops.push(next.clone());
        batch.arrive(next);
    }
    Ok(stops)
}

struct Table<'a> {
    stops: &'a [KeyPhotons],
    motion: &'a Motion,
    steps: usize,
}

impl Table<'_> {
    fn rows(&self) -> u64 {
        (self.motion.segments.len() * self.steps + 1) as u64
    }

    /// The flow's times of the rows that segment `segment` adds.
    fn times(&self, segment: usize) -> impl Iterator<Item = f64> + use<> {
        let steps = self.steps;
        (usize::from(segment > 0)..=steps).map(move |step| step as f64 / steps as f64)
    }

    fn write_tracks(&self, path: &Path, progress: &Progress) -> Result<()> {
        let photons = self.stops[0].positions.len();
        let mut failure = None;
        let written = write_atomic(path, |file| {
            let shape = [self.rows(), photons as u64, 2];
            let mut npy = npyz::WriteOptions::new().default_dtype().shape(&shape).writer(file).begin_nd()?;
            let mut positions = vec![Vec2::ZERO; photons];
            for (i, segment) in self.motion.segments.iter().enumerate() {
                let (from, to) = (&self.stops[i].positions, &self.stops[i + 1]);
                let mut carriage = segment.course.carry(from, &to.positions, &to.bows);
                for time in self.times(i) {
                    if let Err(error) = carriage.positions_at(time, &mut positions, &progress.inner()) {
                        failure = Some(error);
                        return Err(io::Error::other("the advection failed"));
                    }
                    npy.extend(positions.iter().flat_map(|p| p.to_array()))?;
                }
            }
            npy.finish()
        });
        failure.map_or(written, Err)
    }

    fn write_flux(&self, path: &Path) -> Result<Account> {
        let photons = self.stops[0].flux.len();
        let mut account = Account::default();
        let source = total(&self.stops[0].flux);
        write_atomic(path, |file| {
            let shape = [self.rows(), photons as u64, 3];
            let mut npy = npyz::WriteOptions::new().default_dtype().shape(&shape).writer(file).begin_nd()?;
            let mut now = vec![Vec3::ZERO; photons];
            for i in 0..self.motion.segments.len() {
                for time in self.times(i) {
                    flux::blend(&self.stops[i].flux, &self.stops[i + 1].flux, time as f32, &mut now);
                    account.keep_flux_ratio(total(&now), source);
                    npy.extend(now.iter().flat_map(|f| f.to_array()))?;
                }
            }
            npy.finish()
        })?;
        Ok(account)
    }
}

/// Writes the coefficients of all fields: for segment i `psi_i` and `phi_i` of shape (steps, N + 3, M + 3) for M x N
/// cells, each fitted at the time in `times_i`; and `grid` (M, N) and `extent` of the plane. u = J grad psi + grad phi.
fn write_fields(path: &Path, segments: &[&Fields]) -> Result<()> {
    write_atomic(path, |file| {
        let mut npz = npyz::npz::NpzWriter::new(file);
        for (i, fields) in segments.iter().enumerate() {
            let Some(grid) = fields.nodes().first().map(|field| field.grid()) else { continue };
            let [columns, rows] = grid.nodes().map(|n| n as u64);
            let shape = [fields.nodes().len() as u64, rows, columns];
            for (name, pick) in [("psi", 0), ("phi", 1)] {
                let potentials = fields.nodes().iter().flat_map(|field| {
                    let (psi, phi) = field.potentials();
                    [psi, phi].into_iter().nth(pick).unwrap_or_default()
                });
                array(&mut npz, &format!("{name}_{i}"), &shape, potentials)?;
            }
            let times = (0..fields.nodes().len()).map(|n| n as f32 / fields.steps() as f32);
            array(&mut npz, &format!("times_{i}"), &shape[..1], times)?;
            if i == 0 {
                array(&mut npz, "grid", &[2], grid.cells.map(|n| n as f32).into_iter())?;
                array(&mut npz, "extent", &[2], grid.extent.to_array().into_iter())?;
            }
        }
        npz.zip_writer().flush()
    })
}

/// Writes one array of float32 into an NPZ file.
fn array<W: io::Write + io::Seek>(
    npz: &mut npyz::npz::NpzWriter<W>,
    name: &str,
    shape: &[u64],
    values: impl Iterator<Item = f32>,
) -> io::Result<()> {
    let options = npyz::zip::write::FileOptions::default();
    let mut npy = npz.array(name, options)?.default_dtype().shape(shape).begin_nd()?;
    npy.extend(values)?;
    npy.finish()
}
