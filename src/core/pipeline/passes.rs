//! Progressive rendering: each pass carries its own photons through all frames (Sec. 4).
//!
//! All frames refine together, so a run that is stopped has every frame at the quality reached so far. Nothing of a
//! pass outlives it but its sum in the [`ProgressiveRender`].

use glam::{Vec2, Vec3};

use super::batch::Batch;
use super::motion::Segment;
use super::ride::Ride;
use super::slots::Slots;
use crate::flow::{WallViolations, flux};
use crate::render::splat::Outside;
use crate::render::{ProgressiveRender, Workspace};
use crate::{Progress, Result};

/// Where the photons of the passes land.
pub(super) struct Exposer<'a> {
    render: &'a ProgressiveRender,
    /// Two, in turn: one is filled while the other is kept.
    works: [Workspace; 2],
    /// The frame whose light stands in the second, not yet kept.
    pending: Option<usize>,
    positions: Vec<Vec2>,
    flux: Vec<Vec3>,
    /// Over all frames and passes.
    pub(super) account: Account,
}

/// How well the light was kept, over all frames and passes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Account {
    /// Most photons of one frame that flowed beyond the texture.
    pub(super) outside: usize,
    /// Flux of the photons over that of the source, as bright as its caustics are asked to be; the frame farthest from 1.
    pub(super) flux_ratio: Option<f64>,
    /// Flux in the texture over flux of the photons on it, the frame farthest from 1.
    pub(super) texture_ratio: Option<f64>,
    /// Photons of all passes that crossed a wall though a way leads around it.
    pub(super) crossings: usize,
    /// Most photons of one pass and segment whose target no way reaches.
    pub(super) unreachable: usize,
}

impl<'a> Exposer<'a> {
    pub(super) fn new(render: &'a ProgressiveRender) -> Self {
        Self {
            render,
            works: [(); 2].map(|()| Workspace::new(*render.layout())),
            pending: None,
            positions: Vec::new(),
            flux: Vec::new(),
            account: Account::default(),
        }
    }

    /// Carries the photons of `pass` through all moments.
    pub(super) fn run(
        &mut self,
        mut batch: Batch,
        segments: &[Segment],
        slots: &Slots,
        pass: usize,
        progress: &Progress,
    ) -> Result<()> {
        if segments.is_empty() {
            let at = || batch.at.iter();
            self.positions = at().flat_map(|group| &group.positions).copied().collect();
            self.flux = at().flat_map(|group| &group.flux).copied().collect();
            self.expose(0, pass, batch.asked(), |_, _| Ok(()))?;
            progress.advance(1);
        }
        for (i, segment) in segments.iter().enumerate() {
            let next = batch.next(&segment.maps, &progress.inner())?;
            let ride = Ride::new(segment, &batch.at, &next);
            let asked = [batch.asked(), batch.asked_next()];
            self.carry(ride, asked, pass, slots.of_segment(i), progress)?;
            batch.arrive(next);
        }
        self.pending.take().map_or(Ok(()), |slot| self.render.keep(slot, &self.works[1]))
    }

    /// Carries the photons through the moments of one segment; `asked` is the flux they should have at its ends.
    fn carry(
        &mut self,
        mut ride: Ride,
        asked: [f64; 2],
        pass: usize,
        moments: impl Iterator<Item = (usize, f64)>,
        progress: &Progress,
    ) -> Result<()> {
        self.positions.resize(ride.len(), Vec2::ZERO);
        self.flux.resize(ride.len(), Vec3::ZERO);
        for (slot, time) in moments {
            self.expose(slot, pass, between(asked, time), |positions, flux| {
                ride.flux_at(time, flux);
                ride.positions_at(time, positions, &progress.inner())
            })?;
            progress.advance(1);
            progress.check()?;
        }
        self.account.keep_astray(ride.astray());
        Ok(())
    }

    /// Lets `place` say where the photons stand and what they carry, and adds them to the frame of `slot`; `asked` is the flux
    /// they should have, watts. Meanwhile the frame before goes to the store.
    fn expose(
        &mut self,
        slot: usize,
        pass: usize,
        asked: f64,
        place: impl FnOnce(&mut [Vec2], &mut [Vec3]) -> Result<()> + Send,
    ) -> Result<()> {
        let Self { render, works: [work, before], pending, positions, flux, account } = self;
        let keep = || pending.take().map_or(Ok(()), |slot| render.keep(slot, before));
        let expose = || {
            place(positions, flux)?;
            let outside = render.expose(pass, positions, flux, work);
            account.keep(outside, total(flux), asked, work.texture().total().element_sum());
            Ok(())
        };
        let (exposed, kept) = rayon::join(expose, keep);
        kept.and(exposed)?;
        self.works.swap(0, 1);
        self.pending = Some(slot);
        Ok(())
    }
}

impl Account {
    /// Notes the photons of one segment that walls did not keep.
    pub(super) fn keep_astray(&mut self, astray: WallViolations) {
        self.crossings += astray.crossings;
        self.unreachable = self.unreachable.max(astray.unreachable);
    }

    /// Notes one frame: what lies beyond the texture, the flux of its photons, that asked for, and that in the texture, watts.
    fn keep(&mut self, outside: Outside, flux: f64, asked: f64, lit: f64) {
        self.outside = self.outside.max(outside.photons);
        self.keep_flux_ratio(flux, asked);
        farther(&mut self.texture_ratio, lit, flux - outside.flux.element_sum());
    }

    /// Notes the flux of one frame's photons against what is asked for, both in watts.
    pub(super) fn keep_flux_ratio(&mut self, flux: f64, asked: f64) {
        farther(&mut self.flux_ratio, flux, asked);
    }
}

/// Keeps the ratio that is farther from 1; there is none where there is no light.
fn farther(kept: &mut Option<f64>, part: f64, whole: f64) {
    let ratio = part / whole;
    if whole > 0.0 && kept.is_none_or(|k| (ratio - 1.0).abs() > (k - 1.0).abs()) {
        *kept = Some(ratio);
    }
}

/// Between the values at the ends of a segment at time `t`, as the flux goes.
pub(super) fn between([from, to]: [f64; 2], t: f64) -> f64 {
    from * (1.0 - t) + to * t
}

/// Sum over photons and colours, in watts.
pub(super) fn total(flux: &[Vec3]) -> f64 {
    flux::total(flux).element_sum()
}
