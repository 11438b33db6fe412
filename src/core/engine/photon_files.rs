//! The photons of all frames for other programs: places, velocities and flux in the world, and the drawn lines.

use std::path::Path;

use glam::{Vec2, Vec3};

use super::Engine;
use super::energy_balance::{EnergyBalance, between, total};
use super::fitted_project::FittedProject;
use super::job::Job;
use super::key_photons::{all_flux, all_positions, count};
use super::meter::Meter;
use super::summary::{Done, Summary};
use super::trajectories::SegmentTrajectories;
use super::walk::{MapsFrom, Walk};
use crate::constraint::{Constraint, stroke};
use crate::export::{DrawnLine, MAGENTA, ORANGE, PhotonFormat, PhotonFrame, PhotonSequence, PhotonWriter};
use crate::project::{KeyFrame, Project};
use crate::scene::Receiver;
use crate::{Progress, Result};

/// Half the time over which a velocity is taken, frames.
const HALF_FRAME: f64 = 0.5;

/// Where a photon is in the world (m).
struct Place<'a>(Option<&'a Receiver>);

impl Place<'_> {
    /// The world point of a plane point. A project without scene has its plane on the floor, one metre long.
    fn world(&self, point: Vec2) -> Vec3 {
        self.0.map_or(Vec3::new(point.x, 0.0, -point.y), |receiver| receiver.world_from_plane(point))
    }

    fn metres(&self) -> f32 {
        self.0.map_or(1.0, Receiver::metres_per_plane_unit)
    }
}

/// The photons of a frame on the plane, and where they were and will be around it.
struct Columns {
    positions: Vec<Vec2>,
    before: Vec<Vec2>,
    after: Vec<Vec2>,
    flux: Vec<Vec3>,
}

impl Engine {
    /// Carries the photons of one pass through all frames, and writes where they are, how fast, and their flux, with the drawn
    /// lines, into the folder `out`.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; photons that are not finite; input and output; cancelled.
    pub fn photons(
        &self,
        project: &Project,
        (out, format): (&Path, PhotonFormat),
        progress: &Progress,
        saved: &(dyn Fn(&Path) + Sync),
    ) -> Result<Summary> {
        let meter = Meter::default();
        let prepared = self.prepare(project, &meter, progress)?;
        let stages = prepared.plan.stages.iter().copied();
        progress.set_stages(
            stages.filter(|(stage, _)| ["trace", "plan", "fit", "match", "write"].contains(stage)).collect(),
        );
        let fitted = self.fit_prepared(prepared, &meter, progress)?;
        let balance = meter.measure("write", || write(&fitted, (out, format), progress, saved))?;
        let continuity = fitted.measured_unless_stopped(&meter, progress)?;
        let FittedProject { prepared, flow, .. } = fitted;
        let (bad_values, clamped) = Default::default();
        let done =
            Done { command: "photons", passes: 1, flow: &flow, continuity, balance, bad_values, clamped };
        Ok(Summary::new(&prepared, done, &meter))
    }
}

fn write(
    fitted: &FittedProject,
    (out, format): (&Path, PhotonFormat),
    progress: &Progress,
    saved: &(dyn Fn(&Path) + Sync),
) -> Result<EnergyBalance> {
    let FittedProject { engine, prepared, flow } = fitted;
    let (meter, inner) = (Meter::quick(), progress.inner());
    let job: Job = engine.job(prepared, &meter, &inner)?;
    let mut frames: Vec<i32> = prepared.times.frames.iter().map(|(frame, _)| *frame).collect();
    frames.sort_unstable();
    frames.dedup();
    progress.begin("write", frames.len() as u64);
    let mut walk = Walk::start(&job, 0)?;
    let place = Place(prepared.scene.as_deref().map(|scene| scene.receiver()));
    let sequence = sequence(&prepared.project, &place, &frames, (count(walk.at()), prepared.extent));
    let mut writer = PhotonWriter::new(format, &sequence, out)?;
    let mut balance = EnergyBalance::default();
    let rate = sequence.frames_per_second.map(f64::from);
    let mut tell = |frame: i32, columns: &Columns, span: f64| -> Result<()> {
        let seconds = span * rate[1] / rate[0];
        let world: Vec<Vec3> = columns.positions.iter().map(|p| place.world(*p)).collect();
        let speed = |(before, after): (&Vec2, &Vec2)| match seconds > 0.0 {
            true => (place.world(*after) - place.world(*before)) / seconds as f32,
            false => Vec3::ZERO,
        };
        let velocities: Vec<Vec3> = columns.before.iter().zip(&columns.after).map(speed).collect();
        let photons = PhotonFrame { frame, positions: &world, velocities: &velocities, flux: &columns.flux };
        writer.frame(&photons)?.iter().for_each(|path| saved(path));
        progress.advance(1);
        progress.check()
    };
    let keys = &prepared.project.keys;
    let mut columns = Columns::still(&walk);
    if flow.segments.is_empty() {
        frames.iter().try_for_each(|&frame| tell(frame, &columns, 0.0))?;
    }
    for (i, segment) in flow.segments.iter().enumerate() {
        let Some(photons) = walk.next(MapsFrom::Own { bounded: true })? else { break };
        let mut trajectories = SegmentTrajectories::new(segment, &photons.from, &photons.to);
        for &frame in frames.iter().filter(|frame| segment_of(keys, **frame) == i) {
            let [from, to] = [&keys[i], &keys[i + 1]];
            let moment = Moment::new(frame, from, to);
            let [before, now, after] = moment.times;
            trajectories.positions_at(before, &mut columns.before, &inner)?;
            trajectories.positions_at(now, &mut columns.positions, &inner)?;
            trajectories.positions_at(after, &mut columns.after, &inner)?;
            trajectories.flux_at(now, &mut columns.flux);
            balance.keep_flux_ratio(total(&columns.flux), between(photons.requested, now));
            tell(frame, &columns, moment.span)?;
        }
        balance.keep_violations(trajectories.wall_violations());
    }
    writer.finish(&sequence)?.iter().for_each(|path| saved(path));
    Ok(balance)
}

impl Columns {
    /// The photons at the first key frame, at rest.
    fn still(walk: &Walk) -> Self {
        let positions: Vec<Vec2> = all_positions(walk.at()).collect();
        Self {
            before: positions.clone(),
            after: positions.clone(),
            positions,
            flux: all_flux(walk.at()).collect(),
        }
    }
}

/// The segment in which a frame is shown; frames beside the keys are in the nearest.
fn segment_of(keys: &[KeyFrame], frame: i32) -> usize {
    crate::project::segment_time(keys, frame).segment
}

/// A frame in its segment.
struct Moment {
    /// Segment times half a frame before, at, and half a frame after the frame; within the segment.
    times: [f64; 3],
    /// Frames from the first to the last of them; 0 beside the keys.
    span: f64,
}

impl Moment {
    fn new(frame: i32, from: &KeyFrame, to: &KeyFrame) -> Self {
        let (first, last) = (f64::from(from.frame), f64::from(to.frame));
        let at = |offset: f64| (f64::from(frame) + offset).clamp(first, last);
        let frames = [at(-HALF_FRAME), at(0.0), at(HALF_FRAME)];
        let beside = frame < from.frame || frame > to.frame;
        let times = frames.map(|frame| from.ease.apply((frame - first) / (last - first)));
        if beside {
            return Self { times: [times[1]; 3], span: 0.0 };
        }
        Self { times, span: frames[2] - frames[0] }
    }
}

/// What all frames have in common.
fn sequence(
    project: &Project,
    place: &Place,
    frames: &[i32],
    (photons, extent): (usize, Vec2),
) -> PhotonSequence {
    let range = [frames.first(), frames.last()].map(|frame| frame.copied().unwrap_or_default());
    let spacing = (extent.x * extent.y / photons.max(1) as f32).sqrt();
    let width = spacing * place.metres();
    let shown = project.constraints.iter().enumerate().filter(|(_, constraint)| constraint.is_enabled());
    let lines = shown.filter_map(|(i, constraint)| drawn(i, constraint, place)).collect();
    let (name, frames_per_second) = (project.name.clone(), project.output.fps);
    PhotonSequence { name, range, frames_per_second, photons, width, lines }
}

/// A line or wall in the world; none where it is no longer than a dot.
fn drawn(index: usize, constraint: &Constraint, place: &Place) -> Option<DrawnLine> {
    let points: Vec<Vec3> = stroke::clean(constraint.points()).into_iter().map(|p| place.world(p)).collect();
    if points.len() < 2 {
        return None;
    }
    let (kind, width, screen) = match constraint {
        Constraint::DirectedLine(line) => ("directed_line", 2.0 * line.width, ORANGE),
        Constraint::Wall(wall) => ("wall", wall.thickness, MAGENTA),
    };
    Some(DrawnLine {
        name: format!("{kind}_{}", index + 1),
        points,
        width: width * place.metres(),
        // Screen values to linear light, about.
        colour: screen.powf(2.2),
        span: constraint.span().map(|span| [span.from, span.to]),
    })
}
