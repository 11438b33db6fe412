//! The first segment in which photons move, traced and matched once, for those who fit many flows to it.

use std::time::Instant;

use glam::{Vec2, Vec3};

use super::Engine;
use super::active_constraints::{ActiveConstraints, active};
use super::flow::LayerSamples;
use super::job::Job;
use super::key_photons::{all_flux, count};
use super::meter::Meter;
use super::pairing::takes_part;
use super::ray_benchmark::Traced;
use super::segment_photons::SegmentPhotons;
use super::walk::{MapsFrom, Walk};
use crate::constraint::{ActiveLine, ActiveWall};
use crate::flow::guidance::mean_straight;
use crate::flow::{FlowReport, FlowSettings, Segment, flux};
use crate::photon::Tracer;
use crate::project::Project;
use crate::render::PlaneMaterial;
use crate::{Error, Progress, Result};

/// The photons of the first two key frames between which they move, matched: row k of [`Self::target`] is where photon k of
/// [`Self::source`] goes.
pub struct MovingSegment {
    /// Positions at the earlier key frame, plane units: those of the caustics that share a field, or of the first that flows
    /// by itself.
    pub source: Vec<Vec2>,
    /// Positions at the later one.
    pub target: Vec<Vec2>,
    /// Size of the plane; its longer side is 1.
    pub extent: Vec2,
    /// Number of the segment, from 0.
    pub number: usize,
    /// Directed lines that act in the segment.
    pub lines: Vec<ActiveLine>,
    /// Walls that act in the segment.
    pub walls: Vec<ActiveWall>,
    /// The tracing of the photons; none where none are traced.
    pub traced: Option<Traced>,
    /// Seconds of the matching, over all segments up to this one.
    pub match_seconds: f64,
    /// The look of light on the plane.
    pub plane_material: PlaneMaterial,
    project: Project,
    photons: SegmentPhotons,
}

/// The photons of one flow at the middle of the segment.
pub struct Halfway {
    /// Plane coordinates, row by row of [`MovingSegment::flux`].
    pub positions: Vec<Vec2>,
    /// Report on the flow of the caustics that share a field.
    pub report: FlowReport,
    /// Seconds of the fit.
    pub seconds: f64,
}

impl Engine {
    /// Traces and matches the photons of pass 0, at most `most` of them, up to the first segment in which they move. Both
    /// are done anew, and timed; the result is not remembered.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; nothing that moves; cancelled.
    pub fn moving_segment(
        &self,
        project: &Project,
        most: Option<usize>,
        progress: &Progress,
    ) -> Result<MovingSegment> {
        let meter = Meter::quick();
        let mut prepared = self.prepare(project, &meter, progress)?;
        if let Some(most) = most {
            prepared = prepared.limited(prepared.quality, most)?;
        }
        let meter = Meter::quick();
        let job = Job { remembers: false, ..self.job(&prepared, &meter, progress)? };
        let trace = |tracer: Tracer| tracer.trace(0, job.photons, &progress.inner());
        let (landed, report) = job.tracer().map(trace).transpose()?.unzip();
        let traced = report.map(|report| Traced {
            photons: job.photons,
            rays: report.balance.rays,
            seconds: report.seconds,
        });
        let mut walk = Walk::with_light(&job, 0, job.sources.light_of(landed, job.photons));
        let start = Instant::now();
        while let Some(photons) = walk.next(MapsFrom::Own { bounded: false })? {
            let match_seconds = start.elapsed().as_secs_f64();
            for groups in &photons.layers {
                let [source, target] = photons.columns(groups);
                if mean_straight(&source, &target) > 0.0 {
                    let ActiveConstraints { lines, walls } = active(project, photons.number, prepared.extent);
                    return Ok(MovingSegment {
                        source: source.into_owned(),
                        target: target.into_owned(),
                        extent: prepared.extent,
                        number: photons.number,
                        lines,
                        walls,
                        traced,
                        match_seconds,
                        plane_material: prepared.plane_material(),
                        project: project.clone(),
                        photons,
                    });
                }
            }
        }
        let what = "no photon moves from one key frame to the next, so there is no flow to look at";
        Err(Error::value("keys", what))
    }
}

impl MovingSegment {
    /// Walls that take part in the matching; photons only go around the others.
    pub fn matched_walls(&self) -> Vec<&ActiveWall> {
        self.walls.iter().filter(|wall| takes_part(wall)).collect()
    }

    /// The segment with these flow settings.
    pub fn segment<'a>(&'a self, settings: &'a FlowSettings) -> Segment<'a> {
        let Self { source, target, extent, number, lines, walls, .. } = self;
        Segment { source, target, extent: *extent, settings, lines, walls, number: *number }
    }

    /// RGB flux of the photons of all groups at the middle of the segment, watts.
    pub fn flux(&self) -> Vec<Vec3> {
        let [from, to] = [&self.photons.from, &self.photons.to].map(|at| all_flux(at).collect::<Vec<_>>());
        let mut halfway = vec![Vec3::ZERO; from.len()];
        flux::blend(&from, &to, 0.5, &mut halfway);
        halfway
    }

    /// Fits a flow to the photons of all groups and returns them at the middle of the segment; those that do not flow stay
    /// where they were.
    ///
    /// # Errors
    /// A fit that fails; cancelled.
    pub fn halfway(&self, flow: &FlowSettings, progress: &Progress) -> Result<Halfway> {
        let guides = u32::try_from(count(&self.photons.from)).unwrap_or(u32::MAX);
        let project = Project { flow: FlowSettings { guides, ..flow.clone() }, ..self.project.clone() };
        let mut groups: Vec<Vec<Vec2>> =
            self.photons.from.iter().map(|group| group.positions.clone()).collect();
        let show = &mut |of: &[usize], _: usize, positions: &[Vec2]| {
            let mut rest = positions;
            for &group in of {
                let (own, others) = rest.split_at(groups[group].len());
                groups[group].copy_from_slice(own);
                rest = others;
            }
        };
        let samples = Some(LayerSamples { times: &[0.5], first: None, show });
        let drawn = (&*self.lines, &*self.walls);
        let (start, meter) = (Instant::now(), Meter::quick());
        let (_, reports) =
            self.photons.fit(&project, self.extent, drawn, samples, &meter, &progress.inner())?;
        let seconds = start.elapsed().as_secs_f64();
        let report = reports.into_iter().next();
        let report = report.ok_or(Error::Numeric { stage: "fit", what: "nothing flows".to_owned() })?;
        Ok(Halfway { positions: groups.concat(), report, seconds })
    }
}
