//! The flow for other programs: photon tracks, flux and fields as NPY and NPZ files.

use std::io;
use std::path::Path;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::energy_balance::{EnergyBalance, between, total};
use super::fitted_segment::FittedFlow;
use super::job::Job;
use super::key_photons::{KeyPhotons, count};
use super::trajectories::SegmentTrajectories;
use super::walk::{MapsFrom, Walk};
use crate::export::{SegmentFields, write_fields};
use crate::files::npy::NpyWriter;
use crate::files::write_atomic;
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
    let key_states = key_states(job, flow)?;
    progress.begin("write", 3);
    // Where walls stand there are more steps: the way between two rows shall cross none.
    let layers = flow.segments.iter().flat_map(|segment| &segment.layers);
    let steps =
        layers.filter_map(|layer| layer.flow.steps()).max().unwrap_or(job.project.flow.steps as usize);
    let table = Table { key_states: &key_states, flow, steps };
    let tracks = out.join("tracks.npy");
    table.write_tracks(&tracks, progress)?;
    saved(&tracks);
    progress.advance(1);
    let flux = out.join("flux.npy");
    let balance = table.write_flux(&flux)?;
    saved(&flux);
    progress.advance(1);
    let all_fields: Vec<_> = flow
        .segments
        .iter()
        .enumerate()
        .flat_map(|(segment, own)| {
            own.fields(grouping).map(move |(caustic, flow)| SegmentFields { segment, caustic, flow })
        })
        .collect();
    if !all_fields.is_empty() {
        let path = out.join("fields.npz");
        write_fields(&path, &all_fields)?;
        saved(&path);
    }
    progress.advance(1);
    Ok(balance)
}

/// The photons at one key frame.
struct KeyState {
    /// By group.
    at: Arc<Vec<KeyPhotons>>,
    /// The flux they should have, watts.
    requested: f64,
}

/// The photons at every key frame, row k of a group always being its photon k.
fn key_states(job: &Job, flow: &FittedFlow) -> Result<Vec<KeyState>> {
    let mut walk = Walk::start(job, 0)?;
    let mut key_states = vec![KeyState { at: walk.at().clone(), requested: walk.requested() }];
    for segment in &flow.segments {
        let photons = walk.next(MapsFrom::Own { bounded: true })?;
        debug_assert!(
            photons.is_some_and(|p| Arc::ptr_eq(&p.matched.maps, &segment.maps)),
            "it is remembered"
        );
        key_states.push(KeyState { at: walk.at().clone(), requested: walk.requested() });
    }
    Ok(key_states)
}

struct Table<'a> {
    key_states: &'a [KeyState],
    flow: &'a FittedFlow,
    steps: usize,
}

impl Table<'_> {
    fn rows(&self) -> u64 {
        (self.flow.segments.len() * self.steps + 1) as u64
    }

    /// The trajectories of the photons through segment `i`.
    fn trajectories(&self, i: usize) -> SegmentTrajectories<'_> {
        SegmentTrajectories::new(&self.flow.segments[i], &self.key_states[i].at, &self.key_states[i + 1].at)
    }

    fn photons(&self) -> usize {
        count(&self.key_states[0].at)
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
            let mut npy = NpyWriter::new(file, &shape)?;
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
            let mut npy = NpyWriter::new(file, &shape)?;
            let mut now = vec![Vec3::ZERO; photons];
            for i in 0..self.flow.segments.len() {
                let trajectories = self.trajectories(i);
                let requested = [i, i + 1].map(|key| self.key_states[key].requested);
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
