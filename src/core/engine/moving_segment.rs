//! One moment of many flows: the photons halfway between two keys, traced and matched once.

use std::time::Instant;

use glam::{Vec2, Vec3};

use super::acting::{Acting, acting};
use super::batch::Batch;
use super::light::KeyPhotons;
use super::meter::Meter;
use super::motion::{LayerMoments, Leg, layers, match_next};
use super::{Pipeline, learn};
use crate::flow::{FlowReport, FlowSettings, Movement, flux};
use crate::project::Project;
use crate::render::Paper;
use crate::{Error, Progress, Result};

/// The photons of the first two keys between which light moves, matched.
pub(crate) struct Stills {
    project: Project,
    extent: Vec2,
    paper: Paper,
    acting: Acting,
    /// Which segment it is, from 0.
    number: usize,
    at: Vec<KeyPhotons>,
    next: Vec<KeyPhotons>,
    /// Groups that flow together.
    layers: Vec<Vec<usize>>,
}

/// The photons of one flow halfway.
pub(crate) struct Still {
    /// Plane coordinates, row by row of [`Stills::flux`].
    pub(crate) positions: Vec<Vec2>,
    /// How the caustics that share a field flow.
    pub(crate) report: FlowReport,
    /// Seconds of the fit.
    pub(crate) seconds: f64,
}

impl Pipeline {
    /// Traces and matches at most `photons` photons, whatever the project's method.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; nothing that moves; cancelled.
    pub(crate) fn stills(
        &mut self,
        project: &Project,
        photons: usize,
        progress: &Progress,
    ) -> Result<Stills> {
        let project = Project { method: Movement::Flow, ..project.clone() };
        let mut meter = Meter::quick();
        let prepared = self.prepare(&project, &mut meter, progress)?;
        let tracer = learn(&prepared, &project, &mut meter, progress)?;
        let (supplies, photons) = prepared.supplies.thinned(project.matching, photons)?;
        let light = supplies.light(tracer.as_ref(), 0, photons, &progress.inner())?;
        let extent = prepared.extent;
        let paper = prepared.scene.as_ref().map_or(Paper::WHITE, |scene| Paper::of(scene.receiver()));
        let mut batch = Batch::start(&supplies, light, 0, &project, extent);
        for number in 0..project.keys.len().saturating_sub(1) {
            let next = match_next(&batch, false, &progress.inner())?.next;
            let layers = layers(&batch);
            if !layers.is_empty() {
                let (at, acting) = (std::mem::take(&mut batch.at), acting(&project, number, extent));
                return Ok(Stills { project, extent, paper, acting, number, at, next, layers });
            }
            batch.arrive(next);
        }
        Err(Error::value(
            "keys",
            "no photon moves from one key frame to the next, so there is no flow to look at",
        ))
    }
}

impl Stills {
    /// Size of the plane; its longer side is 1.
    pub(crate) fn extent(&self) -> Vec2 {
        self.extent
    }

    /// What light on the plane looks like.
    pub(crate) fn paper(&self) -> Paper {
        self.paper
    }

    /// RGB flux of all photons halfway, watts.
    pub(crate) fn flux(&self) -> Vec<Vec3> {
        let column = |at: &[KeyPhotons]| at.iter().flat_map(|group| &group.flux).copied().collect::<Vec<_>>();
        let (from, to) = (column(&self.at), column(&self.next));
        let mut halfway = vec![Vec3::ZERO; from.len()];
        flux::blend(&from, &to, 0.5, &mut halfway);
        halfway
    }

    /// Fits a flow to all photons and shows them halfway; what does not flow is where it was.
    ///
    /// # Errors
    /// A fit that fails; cancelled.
    pub(crate) fn halfway(&self, flow: &FlowSettings, progress: &Progress) -> Result<Still> {
        let Self { at, next, acting, number, extent, .. } = self;
        let count = at.iter().map(|group| group.positions.len()).sum::<usize>();
        let flow = FlowSettings { guides: u32::try_from(count).unwrap_or(u32::MAX), ..flow.clone() };
        let project = Project { flow, ..self.project.clone() };
        let leg = Leg { at, next, acting, number: *number, extent: *extent };
        let mut groups: Vec<Vec<Vec2>> = at.iter().map(|group| group.positions.clone()).collect();
        let show = &mut |of: &[usize], _: usize, positions: &[Vec2]| {
            let mut rest = positions;
            for &group in of {
                let (own, others) = rest.split_at(groups[group].len());
                groups[group].copy_from_slice(own);
                rest = others;
            }
        };
        let moments = Some(LayerMoments { times: &[0.5], show });
        let start = Instant::now();
        let layers = self.layers.clone();
        let (_, reports) = leg.fit(layers, &project, moments, &mut Meter::quick(), &progress.inner())?;
        let seconds = start.elapsed().as_secs_f64();
        let report = reports.into_iter().next();
        let report = report.ok_or(Error::Numeric { stage: "fit", what: "nothing flows".to_owned() })?;
        Ok(Still { positions: groups.concat(), report, seconds })
    }
}
