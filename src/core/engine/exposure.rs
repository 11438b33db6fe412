//! Progressive rendering: each pass carries its own photons through all frames (Sec. 4).
//!
//! All frames refine together, so a run that is stopped has every frame at the quality reached so far. Nothing of a
//! pass outlives it but its sum in the [`ProgressiveRender`].

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::flow::FittedSegment;
use super::frame_times::FrameTimes;
use super::job::Job;
use super::key_photons::{all_flux, all_positions};
use super::trajectories::SegmentTrajectories;
use super::walk::{MapsFrom, Walk};
use crate::flow::{WallViolations, flux};
use crate::render::splat::OutsidePhotons;
use crate::render::{ProgressiveRender, Workspace};
use crate::{Error, Progress, Result};

/// Adds the photons of passes to all frames.
pub(super) struct Exposures<'a> {
    render: &'a ProgressiveRender,
    /// One is filled while the other is stored.
    works: [Workspace; 2],
    /// The frame whose light is in the second, not yet stored.
    pending: Option<usize>,
    positions: Vec<Vec2>,
    flux: Vec<Vec3>,
    /// Over all frames and passes.
    pub(super) balance: EnergyBalance,
}

/// The conservation of flux over all frames and passes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EnergyBalance {
    /// Most photons of one frame that flowed beyond the texture.
    pub(super) outside: usize,
    /// Flux of the photons over the requested flux; the frame farthest from 1.
    pub(super) flux_ratio: Option<f64>,
    /// Flux in the texture over flux of the photons on it, the frame farthest from 1.
    pub(super) texture_ratio: Option<f64>,
    /// Photons of all passes that crossed a wall although a path leads around it.
    pub(super) crossings: usize,
    /// Most photons of one pass and segment whose target no path reaches.
    pub(super) unreachable: usize,
}

impl<'a> Exposures<'a> {
    pub(super) fn new(render: &'a ProgressiveRender) -> Self {
        Self {
            render,
            works: [(); 2].map(|()| Workspace::new(*render.layout())),
            pending: None,
            positions: Vec::new(),
            flux: Vec::new(),
            balance: EnergyBalance::default(),
        }
    }

    /// Carries the photons of pass number `pass` of a job through all moments, which `progress` counts. `kernel` is the pass
    /// whose kernel is used.
    ///
    /// # Errors
    /// Photons that are not finite; input and output; cancelled.
    pub(super) fn run(
        &mut self,
        job: &Job,
        segments: &[Arc<FittedSegment>],
        times: &FrameTimes,
        (pass, kernel): (usize, usize),
        progress: &Progress,
    ) -> Result<()> {
        let mut walk = Walk::start(job, pass as u64)?;
        if segments.is_empty() {
            self.positions = all_positions(walk.at()).collect();
            self.flux = all_flux(walk.at()).collect();
            self.expose(0, kernel, walk.requested(), |_, _| Ok(()))?;
            progress.advance(1);
        }
        for (i, fitted) in segments.iter().enumerate() {
            let maps = match pass {
                0 if job.remembers => MapsFrom::Own { bounded: true },
                _ => MapsFrom::Others(&fitted.maps),
            };
            let photons = walk.next(maps)?.ok_or(Error::Cancelled)?;
            let trajectories = SegmentTrajectories::new(fitted, &photons.from, &photons.to);
            let moments = times.of_segment(i);
            self.carry(trajectories, photons.requested, kernel, moments, progress)?;
        }
        self.pending.take().map_or(Ok(()), |slot| self.render.accumulate(slot, &self.works[1]))
    }

    /// Carries the photons through the moments of one segment; `requested` is the flux they should have at its ends.
    fn carry(
        &mut self,
        mut trajectories: SegmentTrajectories,
        requested: [f64; 2],
        kernel: usize,
        moments: impl Iterator<Item = (usize, f64)>,
        progress: &Progress,
    ) -> Result<()> {
        self.positions.resize(trajectories.len(), Vec2::ZERO);
        self.flux.resize(trajectories.len(), Vec3::ZERO);
        for (slot, time) in moments {
            self.expose(slot, kernel, between(requested, time), |positions, flux| {
                trajectories.flux_at(time, flux);
                trajectories.positions_at(time, positions, &progress.inner())
            })?;
            progress.advance(1);
            progress.check()?;
        }
        self.balance.keep_violations(trajectories.wall_violations());
        Ok(())
    }

    /// Adds the photons, whose positions and flux `place` fills in, to the frame of `slot`; `requested` is the flux they
    /// should have, watts. Meanwhile the frame before goes to the store.
    fn expose(
        &mut self,
        slot: usize,
        kernel: usize,
        requested: f64,
        place: impl FnOnce(&mut [Vec2], &mut [Vec3]) -> Result<()> + Send,
    ) -> Result<()> {
        let Self { render, works: [work, before], pending, positions, flux, balance } = self;
        let keep = || pending.take().map_or(Ok(()), |slot| render.accumulate(slot, before));
        let expose = || {
            place(positions, flux)?;
            let outside = render.expose(kernel, positions, flux, work);
            balance.keep(outside, total(flux), requested, work.texture().total().element_sum());
            Ok(())
        };
        let (exposed, kept) = rayon::join(expose, keep);
        kept.and(exposed)?;
        self.works.swap(0, 1);
        self.pending = Some(slot);
        Ok(())
    }
}

impl EnergyBalance {
    /// Records the wall violations of one segment.
    pub(super) fn keep_violations(&mut self, violations: WallViolations) {
        self.crossings += violations.crossings;
        self.unreachable = self.unreachable.max(violations.unreachable);
    }

    /// Records one frame: the photons beyond the texture, and the flux of its photons, requested, and in the texture, watts.
    fn keep(&mut self, outside: OutsidePhotons, flux: f64, requested: f64, lit: f64) {
        self.outside = self.outside.max(outside.photons);
        self.keep_flux_ratio(flux, requested);
        farther(&mut self.texture_ratio, lit, flux - outside.flux.element_sum());
    }

    /// Records the flux of one frame's photons against the requested flux, watts.
    pub(super) fn keep_flux_ratio(&mut self, flux: f64, requested: f64) {
        farther(&mut self.flux_ratio, flux, requested);
    }
}

/// Keeps the ratio that is farther from 1; none where there is no light.
fn farther(kept: &mut Option<f64>, part: f64, whole: f64) {
    let ratio = part / whole;
    if whole > 0.0 && kept.is_none_or(|k| (ratio - 1.0).abs() > (k - 1.0).abs()) {
        *kept = Some(ratio);
    }
}

/// Linear interpolation between the values at the ends of a segment at time `t`, as flux is blended.
pub(super) fn between([from, to]: [f64; 2], t: f64) -> f64 {
    from * (1.0 - t) + to * t
}

/// Sum over photons and colours, in watts.
pub(super) fn total(flux: &[Vec3]) -> f64 {
    flux::total(flux).element_sum()
}
