//! Progressive rendering: each pass carries its own photons through all frames (Sec. 4).
//!
//! All frames refine together, so a run that is stopped has every frame at the quality reached so far. Nothing of a
//! pass outlives it but its sum in the [`ProgressiveRender`].

use glam::{Vec2, Vec3};

use super::batch::Batch;
use super::motion::Segment;
use super::slots::Slots;
use super::supply::KeyPhotons;
use crate::flow::flux;
use crate::render::{ProgressiveRender, Workspace};
use crate::{Progress, Result};

/// Where the photons of the passes land.
pub(super) struct Exposer<'a> {
    render: &'a ProgressiveRender,
    work: Workspace,
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
    /// Flux of the photons over that of the source, the frame farthest from 1.
    pub(super) flux_ratio: Option<f64>,
    /// Flux in the texture over flux of the photons on it, the frame farthest from 1.
    pub(super) texture_ratio: Option<f64>,
}

/// What one segment of a pass is carried from and to.
struct Leg<'a> {
    from: &'a KeyPhotons,
    to: &'a KeyPhotons,
    segment: &'a Segment,
    /// Flux of the photons at the first key, in watts.
    source: f64,
    pass: usize,
}

impl<'a> Exposer<'a> {
    pub(super) fn new(render: &'a ProgressiveRender) -> Self {
        Self {
            render,
            work: Workspace::new(*render.layout()),
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
        let source = total(&batch.at.flux);
        if segments.is_empty() {
            self.positions.clone_from(&batch.at.positions);
            self.flux.clone_from(&batch.at.flux);
            self.expose(0, pass, source)?;
            progress.advance(1);
        }
        for (i, segment) in segments.iter().enumerate() {
            let next = batch.pair(batch.next_points(), segment.map.as_ref(), &progress.inner())?;
            let leg = Leg { from: &batch.at, to: &next, segment, source, pass };
            self.carry(&leg, slots.of_segment(i), progress)?;
            batch.arrive(next);
        }
        Ok(())
    }

    /// Carries the photons through the moments of one segment.
    fn carry(
        &mut self,
        leg: &Leg,
        moments: impl Iterator<Item = (usize, f64)>,
        progress: &Progress,
    ) -> Result<()> {
        let mut carriage = leg.segment.course.carry(&leg.from.positions, &leg.to.positions, &leg.to.bows);
        self.positions.resize(leg.from.positions.len(), Vec2::ZERO);
        self.flux.resize(leg.from.flux.len(), Vec3::ZERO);
        for (slot, time) in moments {
            carriage.positions_at(time, &mut self.positions, &progress.inner())?;
            flux::blend(&leg.from.flux, &leg.to.flux, time as f32, &mut self.flux);
            self.expose(slot, leg.pass, leg.source)?;
            progress.advance(1);
            progress.check()?;
        }
        Ok(())
    }

    /// Adds the photons as they stand to the frame of `slot`.
    fn expose(&mut self, slot: usize, pass: usize, source: f64) -> Result<()> {
        let outside = self.render.add(slot, pass, &self.positions, &self.flux, &mut self.work)?;
        let flux = total(&self.flux);
        let account = &mut self.account;
        account.outside = account.outside.max(outside.photons);
        account.keep_flux_ratio(flux, source);
        let inside = flux - outside.flux.element_sum();
        farther(&mut account.texture_ratio, self.work.texture().total().element_sum(), inside);
        Ok(())
    }
}

impl Account {
    /// Notes the flux of one frame's photons against that of the source, both in watts.
    pub(super) fn keep_flux_ratio(&mut self, flux: f64, source: f64) {
        farther(&mut self.flux_ratio, flux, source);
    }
}

/// Keeps the ratio that is farther from 1; there is none where there is no light.
fn farther(kept: &mut Option<f64>, part: f64, whole: f64) {
    let ratio = part / whole;
    if whole > 0.0 && kept.is_none_or(|k| (ratio - 1.0).abs() > (k - 1.0).abs()) {
        *kept = Some(ratio);
    }
}

/// Sum over photons and colours, in watts.
pub(super) fn total(flux: &[Vec3]) -> f64 {
    flux::total(flux).element_sum()
}
