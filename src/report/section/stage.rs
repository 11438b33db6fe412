//! Single stages with the photons of a first move, timed: for the sections that ask how fast they are.

use glam::{Vec2, Vec3};

use super::super::workbench::fastest;
use lightloom_core::engine::MovingSegment;
use lightloom_core::flow::field::Grid;
use lightloom_core::flow::fit::{Blend, FitSettings};
use lightloom_core::flow::{FieldTrajectories, Fields, FlowSettings, Segment, fit_segment};
use lightloom_core::render::splat::Splatter;
use lightloom_core::render::{ReceiverTexture, TextureLayout};
use lightloom_core::{Progress, Result};

/// Runs of which the fastest counts end once so many seconds are spent.
pub(super) const ENOUGH: f64 = 1.0;
/// A solve that needs this many iterations has failed.
const MOST_ITERATIONS: usize = 500;

/// A fit of both potentials on so many cells along both sides.
pub(super) fn coupled(cells: usize, photons: &MovingSegment, alpha: f32, tolerance: f64) -> FitSettings {
    FitSettings {
        grid: Grid { cells: [cells; 2], extent: photons.extent },
        gamma: 0.5,
        alpha: alpha.into(),
        blend: Blend::Joint,
        tolerance,
        max_iterations: MOST_ITERATIONS,
    }
}

/// Where each of the first photons starts, and its straight way.
pub(super) fn ways(photons: &MovingSegment, most: usize) -> (&[Vec2], Vec<Vec2>) {
    let count = most.min(photons.source.len());
    let (source, target) = (&photons.source[..count], &photons.target[..count]);
    (source, source.iter().zip(target).map(|(from, to)| *to - *from).collect())
}

/// The first move where no wall stands: walls are measured by themselves.
pub(super) fn without_walls<'a>(photons: &'a MovingSegment, settings: &'a FlowSettings) -> Segment<'a> {
    Segment { walls: &[], ..photons.segment(settings) }
}

/// Seconds of a fit.
pub(super) fn fit_seconds(runs: usize, course: &Segment, progress: &Progress) -> Result<f64> {
    fastest(runs, ENOUGH, || fit_segment(course, &progress.inner())).map(|(_, seconds)| seconds)
}

/// Seconds in which all photons are carried to the end.
pub(super) fn carry_seconds(fields: &Fields, photons: &MovingSegment, progress: &Progress) -> Result<f64> {
    let carry = || {
        FieldTrajectories::new(fields, &photons.source, &photons.target)
            .advance_to(fields.steps() - 1, progress)
    };
    fastest(3, ENOUGH, carry).map(|(_, seconds)| seconds)
}

/// Seconds in which all photons are counted into a texture.
pub(super) fn splat_seconds(
    layout: TextureLayout,
    photons: &MovingSegment,
    progress: &Progress,
) -> Result<f64> {
    let flux = vec![Vec3::ONE; photons.source.len()];
    let (mut texture, mut splatter) = (ReceiverTexture::new(layout), Splatter::default());
    let splat = || {
        progress.check()?;
        Ok(splatter.splat(&photons.source, &flux, &mut texture))
    };
    fastest(5, ENOUGH, splat).map(|(_, seconds)| seconds)
}
