//! Fits in double precision. The fitter takes gamma as f64; 1e-12 beside 1 would be lost in the f32 of a project.

use glam::Vec2;

use super::case::{Input, Limits, Measured};
use super::flow_case::FlowCase;
use crate::effort::Effort;
use lightloom_core::flow::field::Grid;
use lightloom_core::flow::fit::{Blend, FitSettings, Fitter};
use lightloom_core::flow::metric::fit_residual;
use lightloom_core::{Progress, Result};

/// Error of the velocities at which the solver stops; ten thousand times less than a project asks for.
const TOLERANCE: f64 = 1e-8;

/// The plain flow in a few steps, and one fit of its straight velocities at a gamma and an alpha in double precision.
pub(super) struct FitCase {
    flow: FlowCase,
    gamma: f64,
    alpha: f64,
}

impl FitCase {
    pub(super) fn new(gamma: f64, alpha: f64, effort: Effort) -> Self {
        let mut flow = FlowCase::new(effort);
        flow.settings.gamma = gamma as f32;
        flow.settings.alpha = alpha as f32;
        flow.settings.steps = effort.pick(2, 4);
        Self { flow, gamma, alpha }
    }
}

impl Input for FitCase {
    fn limits(&self) -> Limits {
        Limits { solver_error: Some(TOLERANCE), energy: Some(1.0 + TOLERANCE), ..self.flow.limits() }
    }

    /// The numbers of the solver are those of the fit; where the photons end, those of the flow.
    fn run(&self, progress: &Progress) -> Result<Measured> {
        let Self { flow: FlowCase { source, target, extent, settings, .. }, gamma, alpha } = self;
        let flow = self.flow.run(progress)?;
        let settings = FitSettings {
            grid: Grid { cells: settings.grid.cells(*extent).map(|n| n as usize), extent: *extent },
            gamma: *gamma,
            alpha: *alpha,
            blend: Blend::Joint,
            tolerance: TOLERANCE,
            max_iterations: 500,
        };
        let straight: Vec<Vec2> = source.iter().zip(target).map(|(a, b)| *b - *a).collect();
        let (field, fit) = Fitter::new(settings)?.fit(source, &straight, progress)?;
        Ok(Measured {
            solver_error: Some(fit.error),
            iterations: Some(fit.iterations),
            condition: Some(fit.condition),
            energy: Some(fit_residual(&field, source, &straight)),
            ..flow
        })
    }
}
