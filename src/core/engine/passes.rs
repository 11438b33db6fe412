//! Progressive rendering: each pass carries its own photons through all frames (Sec. 4).
//!
//! All frames refine together, so a run that is stopped has every frame at the quality reached so far. Nothing of a
//! pass outlives it but its sum in the [`ProgressiveRender`].

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::energy_balance::{EnergyBalance, between, total};
use super::fitted_segment::FittedSegment;
use super::frame_times::FrameTimes;
use super::job::Job;
use super::key_photons::{all_flux, all_positions};
use super::trajectories::SegmentTrajectories;
use super::walk::{MapsFrom, Walk};
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
            let trajectories =
                SegmentTrajectories::with_tracks(fitted, (&photons.from, &photons.to), &photons.tracks);
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
