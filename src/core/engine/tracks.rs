//! The flow for other programs: photon tracks, flux and fields as NPY and NPZ files.

use std::io::{self, Write as _};
use std::path::Path;
use std::sync::Arc;

use glam::{Vec2, Vec3};
use npyz::WriterBuilder as _;

use super::exposure::{EnergyBalance, between, total};
use super::flow::FittedFlow;
use super::grouping::Grouping;
use super::job::Job;
use super::key_photons::{KeyPhotons, count};
use super::trajectories::SegmentTrajectories;
use super::walk::{MapsFrom, Walk};
use crate::files::write_atomic;
use crate::flow::Fields;
use crate::flow::field::Field;
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
/// The steps are those of the flow, four times as many where walls stand.
///
/// The steps of all segments follow each other; the end of one segment is the start of the next and stands once. The photons
/// of each named caustic follow each other too, in the order of the project, and the rest comes last: `summary.json` has
/// their numbers.
pub(super) fn write(
    job: &Job,
    flow: &FittedFlow,
    out: &Path,
    progress: &Progress,
    saved: &(dyn Fn(&Path) + Sync),
) -> Result<EnergyBalance> {
    let grouping = job.sources.grouping();
    let stops = stops(job, flow)?;
    progress.begin("write", 3);
    // Where walls stand there are more steps: the way between two rows shall cross none.
    let fields = flow.segments.iter().flat_map(|segment| segment.fields(grouping));
    let steps = fields.map(|(_, fields)| fields.steps()).max().unwrap_or(job.project.flow.steps as usize);
    let table = Table { stops: &stops, flow, steps };
    let tracks = out.join("tracks.npy");
    table.write_tracks(&tracks, progress)?;
    saved(&tracks);
    progress.advance(1);
    let flux = out.join("flux.npy");
    let balance = table.write_flux(&flux)?;
    saved(&flux);
    progress.advance(1);
    if flow.segments.iter().any(|segment| segment.fields(grouping).next().is_some()) {
        let path = out.join("fields.npz");
        write_fields(&path, flow, grouping)?;
        saved(&path);
    }
    progress.advance(1);
    Ok(balance)
}

/// The photons at one key frame.
struct Stop {
    /// By group.
    at: Arc<Vec<KeyPhotons>>,
    /// The flux they should have, watts.
    requested: f64,
}

/// The photons at every key frame, row k of a group always being its photon k.
fn stops(job: &Job, flow: &FittedFlow) -> Result<Vec<Stop>> {
    let mut walk = Walk::start(job, 0)?;
    let mut stops = vec![Stop { at: walk.at().clone(), requested: walk.requested() }];
    for segment in &flow.segments {
        let photons = walk.next(MapsFrom::Own { bounded: true })?;
        debug_assert!(
            photons.is_some_and(|p| Arc::ptr_eq(&p.matched.maps, &segment.maps)),
            "it is remembered"
        );
        stops.push(Stop { at: walk.at().clone(), requested: walk.requested() });
    }
    Ok(stops)
}

struct Table<'a> {
    stops: &'a [Stop],
    flow: &'a FittedFlow,
    steps: usize,
}

impl Table<'_> {
    fn rows(&self) -> u64 {
        (self.flow.segments.len() * self.steps + 1) as u64
    }

    /// The trajectories of the photons through segment `i`.
    fn trajectories(&self, i: usize) -> SegmentTrajectories<'_> {
        SegmentTrajectories::new(&self.flow.segments[i], &self.stops[i].at, &self.stops[i + 1].at)
    }

    fn photons(&self) -> usize {
        count(&self.stops[0].at)
    }

    /// The flow's times of the rows that segment `segment` adds.
    fn times(&self, segment: usize) -> impl Iterator<Item = f64> + use<> {
        let steps = self.steps;
        (usize::from(segment > 0)..=steps).map(move |step| step as f64 / steps as f64)
    }

    fn write_tracks(&self, path: &Path, progress: &Progress) -> Result<()> {
        let photons = self.photons();
        let mut failure = None;
        let written = write_atomic(path, |file| {
            let shape = [self.rows(), photons as u64, 2];
            let mut npy = npyz::WriteOptions::new().default_dtype().shape(&shape).writer(file).begin_nd()?;
            let mut positions = vec![Vec2::ZERO; photons];
            for i in 0..self.flow.segments.len() {
                let mut trajectories = self.trajectories(i);
                for time in self.times(i) {
                    if let Err(error) = trajectories.positions_at(time, &mut positions, &progress.inner()) {
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

    fn write_flux(&self, path: &Path) -> Result<EnergyBalance> {
        let photons = self.photons();
        let mut balance = EnergyBalance::default();
        write_atomic(path, |file| {
            let shape = [self.rows(), photons as u64, 3];
            let mut npy = npyz::WriteOptions::new().default_dtype().shape(&shape).writer(file).begin_nd()?;
            let mut now = vec![Vec3::ZERO; photons];
            for i in 0..self.flow.segments.len() {
                let trajectories = self.trajectories(i);
                let requested = [i, i + 1].map(|stop| self.stops[stop].requested);
                for time in self.times(i) {
                    trajectories.flux_at(time, &mut now);
                    balance.keep_flux_ratio(total(&now), between(requested, time));
                    npy.extend(now.iter().flat_map(|f| f.to_array()))?;
                }
            }
            npy.finish()
        })?;
        Ok(balance)
    }
}

/// Writes the coefficients of all fields: for segment i `psi_i` and `phi_i` of shape (steps, N + 3, M + 3) for M x N
/// cells, each fitted at the time in `times_i`; and `grid` (M, N) and `extent` of the plane. u = J grad psi + grad phi.
/// Each grid of the turbulence adds its own J grad psi at these times: `noise_i_C` for C cells along the longer side,
/// square ones, so that the last may reach beyond the plane. The own flow of caustic number c in the project, from 0,
/// adds `psi_i_c` and so on.
fn write_fields(path: &Path, flow: &FittedFlow, grouping: &Grouping) -> Result<()> {
    write_atomic(path, |file| {
        let mut npz = npyz::npz::NpzWriter::new(file);
        let mut described = false;
        for (i, segment) in flow.segments.iter().enumerate() {
            for (own, fields) in segment.fields(grouping) {
                let Some(grid) = fields.nodes().first().map(|field| field.grid()) else { continue };
                let name = own.map_or_else(|| i.to_string(), |caustic| format!("{i}_{caustic}"));
                write_layer(&mut npz, &name, fields)?;
                if !std::mem::replace(&mut described, true) {
                    array(&mut npz, "grid", &[2], grid.cells.map(|n| n as f32).into_iter())?;
                    array(&mut npz, "extent", &[2], grid.extent.to_array().into_iter())?;
                }
            }
        }
        npz.zip_writer().flush()
    })
}

/// Writes psi of each grid of a layer's turbulence at the times of the fits, where there is any.
fn write_noises<W: io::Write + io::Seek>(
    npz: &mut npyz::npz::NpzWriter<W>,
    layer: &str,
    fields: &Fields,
) -> io::Result<()> {
    let times = 0..fields.nodes().len();
    let noises: Vec<Vec<Field>> = times.map(|n| fields.noise(fields.node_time(n))).collect();
    for (k, noise) in noises.first().into_iter().flatten().enumerate() {
        let [columns, rows] = noise.grid().nodes().map(|n| n as u64);
        let psi = noises.iter().flat_map(|at_one_time| at_one_time[k].potentials().0);
        let cells = noise.grid().cells.into_iter().max().unwrap_or_default();
        array(npz, &format!("noise_{layer}_{cells}"), &[noises.len() as u64, rows, columns], psi)?;
    }
    Ok(())
}

/// Writes one sequence of fields.
fn write_layer<W: io::Write + io::Seek>(
    npz: &mut npyz::npz::NpzWriter<W>,
    layer: &str,
    fields: &Fields,
) -> io::Result<()> {
    let [columns, rows] = fields.nodes()[0].grid().nodes().map(|n| n as u64);
    let shape = [fields.nodes().len() as u64, rows, columns];
    for (name, pick) in [("psi", 0), ("phi", 1)] {
        let potentials = fields.nodes().iter().flat_map(|field| {
            let (psi, phi) = field.potentials();
            [psi, phi].into_iter().nth(pick).unwrap_or_default()
        });
        array(npz, &format!("{name}_{layer}"), &shape, potentials)?;
    }
    write_noises(npz, layer, fields)?;
    let times = (0..fields.nodes().len()).map(|n| fields.node_time(n) as f32);
    array(npz, &format!("times_{layer}"), &shape[..1], times)
}

/// Writes one array of float32 into an NPZ file.
fn array<W: io::Write + io::Seek>(
    npz: &mut npyz::npz::NpzWriter<W>,
    name: &str,
    shape: &[u64],
    values: impl Iterator<Item = f32>,
) -> io::Result<()> {
    // The same fields are the same bytes, whenever they are written.
    let time = npyz::zip::DateTime::default();
    let options = npyz::zip::write::FileOptions::default().last_modified_time(time);
    let mut npy = npz.array(name, options)?.default_dtype().shape(shape).begin_nd()?;
    npy.extend(values)?;
    npy.finish()
}
