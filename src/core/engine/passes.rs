//! Progressive rendering: each pass carries its own photons through all frames (Sec. 4).
//!
//! All frames refine together, so a run that is stopped has every frame at the quality reached so far. Nothing of a
//! pass outlives it but its sum in the [`ProgressiveRender`].

use std::ops::Range;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::energy_balance::{EnergyBalance, between, total};
use super::fitted_segment::FittedSegment;
use super::frame_times::FrameTimes;
use super::job::Job;
use super::key_photons::{KeyPhotons, all_flux, all_positions, count};
use super::numeric_place::{at_frame, in_segment};
use super::trajectories::SegmentTrajectories;
use super::walk::{MapsFrom, Walk};
use crate::render::splat::OutsidePhotons;
use crate::render::{ProgressiveRender, Workspace};
use crate::{Error, Progress, Result};

/// Adds the photons of passes to all frames.
pub(super) struct Exposures<'a> {
    render: &'a ProgressiveRender,
    /// One is filled while the other is stored.
    works: [Workspace; 2],
    /// Textures of each frame: one for all photons, or one for each of their groups.
    textures: usize,
    /// The texture whose light is in the second, not yet stored.
    pending: Option<usize>,
    positions: Vec<Vec2>,
    flux: Vec<Vec3>,
    /// Over all frames and passes.
    pub(super) balance: EnergyBalance,
}

impl<'a> Exposures<'a> {
    /// `textures` are the number of groups of photons where their light is kept apart, 1 where it is not.
    pub(super) fn new(render: &'a ProgressiveRender, textures: usize) -> Self {
        Self {
            render,
            works: [(); 2].map(|()| Workspace::new(*render.layout())),
            textures,
            pending: None,
            positions: Vec::new(),
            flux: Vec::new(),
            balance: EnergyBalance::default(),
        }
    }

    /// Carries the photons of pass number `pass` of a job through all moments that lack it, which `progress` counts. `kernel`
    /// is the pass whose kernel is used.
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
            let rows = self.rows(walk.at());
            self.expose((0, &rows), (pass, kernel), walk.requested(), |_, _| Ok(0.0))?;
            progress.advance(1);
        }
        let lacking = |i: &usize| times.of_segment(*i).any(|(slot, _)| self.lacks(slot, pass));
        // Beyond the last moment that lacks the pass nothing is seen.
        let needed = (0..segments.len()).rev().find(lacking).map_or(0, |last| last + 1);
        for (i, fitted) in segments[..needed].iter().enumerate() {
            let maps = match pass {
                0 if job.remembers && !job.baked => MapsFrom::Own { bounded: true },
                _ => MapsFrom::Others(&fitted.maps),
            };
            let photons = walk.next(maps)?.ok_or(Error::Cancelled)?;
            let trajectories =
                SegmentTrajectories::with_tracks(fitted, (&photons.from, &photons.to), &photons.tracks);
            let rows = self.rows(&photons.from);
            let carried =
                self.carry((trajectories, &rows), photons.requested, (pass, kernel), (times, i), progress);
            in_segment(carried, job.project, i)?;
        }
        self.pending.take().map_or(Ok(()), |slot| self.render.accumulate(slot, &self.works[1]))
    }

    /// Whether a texture of the frame of `slot` is without a pass.
    fn lacks(&self, slot: usize, pass: usize) -> bool {
        let textures = slot * self.textures..(slot + 1) * self.textures;
        textures.into_iter().any(|texture| self.render.passes(texture) <= pass)
    }

    /// Carries the photons through the moments of one segment; `requested` is the flux they should have at its ends.
    fn carry(
        &mut self,
        (mut trajectories, rows): (SegmentTrajectories, &[Range<usize>]),
        requested: [f64; 2],
        passes: (usize, usize),
        (times, segment): (&FrameTimes, usize),
        progress: &Progress,
    ) -> Result<()> {
        self.positions.resize(trajectories.len(), Vec2::ZERO);
        self.flux.resize(trajectories.len(), Vec3::ZERO);
        for (slot, time) in times.of_segment(segment) {
            if self.lacks(slot, passes.0) {
                let exposed =
                    self.expose((slot, rows), passes, between(requested, time), |positions, flux| {
                        trajectories.flux_at(time, flux);
                        trajectories.light_at(time, positions, &progress.inner())
                    });
                at_frame(exposed, times.frame_of(slot))?;
            }
            progress.advance(1);
            progress.check()?;
        }
        self.balance.keep_violations(trajectories.wall_violations());
        Ok(())
    }

    /// The rows of the photons of each texture.
    fn rows(&self, groups: &[KeyPhotons]) -> Vec<Range<usize>> {
        if self.textures == 1 {
            return std::iter::once(0..count(groups)).collect();
        }
        let ends = groups.iter().scan(0, |end, group| {
            let start = *end;
            *end += group.positions.len();
            Some(start..*end)
        });
        ends.collect()
    }

    /// Adds the photons, whose positions and flux `place` fills in, to the frame of `slot`, a texture for each of `rows` that
    /// lacks the pass; `place` returns by which standard deviation the light is diffused. `requested` is the flux they should
    /// have, watts. Meanwhile the texture before goes to the store.
    fn expose(
        &mut self,
        (slot, rows): (usize, &[Range<usize>]),
        (pass, kernel): (usize, usize),
        requested: f64,
        place: impl FnOnce(&mut [Vec2], &mut [Vec3]) -> Result<f32> + Send,
    ) -> Result<()> {
        let mut place = Some(place);
        let (mut outside, mut lit, mut diffused) = (OutsidePhotons::default(), 0.0, 0.0);
        for (texture, rows) in rows.iter().enumerate() {
            let Self { render, works: [work, before], pending, positions, flux, .. } = self;
            let keep = || pending.take().map_or(Ok(()), |texture| render.accumulate(texture, before));
            let expose = || -> Result<_> {
                if let Some(place) = place.take() {
                    diffused = place(positions, flux)?;
                }
                let outside =
                    render.expose((kernel, diffused), &positions[rows.clone()], &flux[rows.clone()], work);
                Ok((outside, work.texture().total().element_sum()))
            };
            let (exposed, kept) = rayon::join(expose, keep);
            kept?;
            let (beyond, total) = exposed?;
            outside.photons += beyond.photons;
            outside.flux += beyond.flux;
            lit += total;
            self.works.swap(0, 1);
            let texture = slot * self.textures + texture;
            self.pending = Some(texture).filter(|texture| self.render.passes(*texture) <= pass);
        }
        self.balance.keep(outside, total(&self.flux), requested, lit);
        Ok(())
    }
}
