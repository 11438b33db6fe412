//! What a flow is watched for while it is made.

use glam::Vec2;
use serde::Serialize;

use super::advect::Swarm;
use super::fade::Fade;
use super::field::Field;
use super::fit::FitReport;
use super::metric::{self, NeighbourVariance};
use super::trajectory::Astray;
use super::turbulence::Turbulence;

/// How the flow between two key frames turned out, over the guide photons and the whole run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FlowReport {
    /// Photons fitted to.
    pub guides: usize,
    /// Fits made; fewer than steps where the fade ends early.
    pub fits: usize,
    /// Unknowns of one fit.
    pub unknowns: usize,
    /// Iterations of the solver in a fit, the most.
    pub solver_iterations: usize,
    /// Iterations of the solver in a fit, on average.
    pub solver_iterations_mean: f64,
    /// Relative residual of the solver, the worst.
    pub solver_residual: f64,
    /// Condition number of the preconditioned matrix, the largest that the solver saw; a bound from below.
    pub solver_condition: f64,
    /// |u(c) - v| / |v| in root mean square, averaged over the fits.
    pub fit_residual: f64,
    /// Divergence of the fields and the turbulence where the photons are, root mean square, per unit of t.
    pub divergence_rms: f64,
    /// Curl of the same.
    pub curl_rms: f64,
    /// Speed of the turbulence over the plane, root mean square, in plane units per unit of t; 0 where there is none.
    pub turbulence_rms: f64,
    /// Mean straight way |b - a| in plane units.
    pub mean_straight: f64,
    /// 99.9 % fastest photon over the mean straight speed.
    pub peak_speed_ratio: f64,
    /// The same of straight lines at constant speed: no flow that arrives can have a lower one.
    pub straight_peak_ratio: f64,
    /// Neighbour-velocity variance over the mean square velocity, averaged over the run.
    pub dispersion: f64,
    /// The same where it is largest.
    pub dispersion_max: f64,
    /// Unexplained share of the velocity variance at t = 0.25, 0.5, 0.75.
    pub crossing_index: [f64; 3],
    /// Share of the motion that the field steers: (1-s)|u| over (1-s)|u| + s|v|.
    pub field_share: f64,
    /// Distance of the photons from their straight ways, root mean square over that of the ways, where it is largest.
    pub wander: f64,
    /// max |c(1) - b| in plane units.
    pub endpoint_error: f64,
    /// Photons that crossed a wall though a way leads around it, over all steps.
    pub wall_crossings: usize,
    /// Photons whose target no way around the walls reaches: they go straight, through the walls.
    pub unreachable: usize,
}

impl FlowReport {
    /// The worse of two flows in every number.
    pub fn worst(&self, other: &Self) -> Self {
        let (a, b) = (self, other);
        Self {
            guides: a.guides.max(b.guides),
            fits: a.fits + b.fits,
            unknowns: a.unknowns.max(b.unknowns),
            solver_iterations: a.solver_iterations.max(b.solver_iterations),
            solver_iterations_mean: a.solver_iterations_mean.max(b.solver_iterations_mean),
            solver_residual: a.solver_residual.max(b.solver_residual),
            solver_condition: a.solver_condition.max(b.solver_condition),
            fit_residual: a.fit_residual.max(b.fit_residual),
            divergence_rms: a.divergence_rms.max(b.divergence_rms),
            curl_rms: a.curl_rms.max(b.curl_rms),
            turbulence_rms: a.turbulence_rms.max(b.turbulence_rms),
            mean_straight: a.mean_straight.max(b.mean_straight),
            peak_speed_ratio: a.peak_speed_ratio.max(b.peak_speed_ratio),
            straight_peak_ratio: a.straight_peak_ratio.max(b.straight_peak_ratio),
            dispersion: a.dispersion.max(b.dispersion),
            dispersion_max: a.dispersion_max.max(b.dispersion_max),
            crossing_index: [0, 1, 2].map(|i| a.crossing_index[i].max(b.crossing_index[i])),
            field_share: a.field_share.min(b.field_share),
            wander: a.wander.max(b.wander),
            endpoint_error: a.endpoint_error.max(b.endpoint_error),
            wall_crossings: a.wall_crossings + b.wall_crossings,
            unreachable: a.unreachable.max(b.unreachable),
        }
    }
}

/// Photons on their way, as the observer sees them.
pub(super) trait Moving {
    /// Positions at `t`, which lies in the current step.
    fn positions(&self, t: f64, out: &mut [Vec2]);
    /// Velocities at `t`, which lies in the current step.
    fn velocities(&self, t: f64, out: &mut [Vec2]);
}

/// Gathers the report while the photons move.
pub(super) struct Observer<'a> {
    source: &'a [Vec2],
    target: &'a [Vec2],
    extent: Vec2,
    report: FlowReport,
    squares: [f64; 2],
    fastest: Vec<f32>,
    dispersion_sum: f64,
    dispersions: usize,
    by_field: f64,
    by_guidance: f64,
    positions: Vec<Vec2>,
    velocities: Vec<Vec2>,
    guidance: Vec<Vec2>,
}

/// Times at which the crossing index is taken.
const CROSSING_TIMES: [f64; 3] = [0.25, 0.5, 0.75];
/// Every so many photons the derivatives of the field are looked at.
const DERIVATIVE_STRIDE: usize = 16;

impl<'a> Observer<'a> {
    pub(super) fn new(source: &'a [Vec2], target: &'a [Vec2], extent: Vec2) -> Self {
        let n = source.len();
        let report = FlowReport {
            guides: n,
            mean_straight: super::guidance::mean_straight(source, target).into(),
            ..FlowReport::default()
        };
        Self {
            source,
            target,
            extent,
            report,
            squares: [0.0; 2],
            fastest: vec![0.0; n],
            dispersion_sum: 0.0,
            dispersions: 0,
            by_field: 0.0,
            by_guidance: 0.0,
            positions: vec![Vec2::ZERO; n],
            velocities: vec![Vec2::ZERO; n],
            guidance: vec![Vec2::ZERO; n],
        }
    }

    /// A field was fitted; the turbulence is added to it.
    pub(super) fn fitted(
        &mut self,
        (field, turbulence): (&Field, &[Field]),
        fit: &FitReport,
        positions: &[Vec2],
        guidance: &[Vec2],
    ) {
        let report = &mut self.report;
        report.fits += 1;
        report.unknowns = fit.unknowns;
        report.solver_iterations = report.solver_iterations.max(fit.iterations);
        report.solver_iterations_mean += fit.iterations as f64;
        report.solver_residual = report.solver_residual.max(fit.residual);
        report.solver_condition = report.solver_condition.max(fit.condition);
        report.fit_residual += metric::fit_residual(field, positions, guidance);
        let all: Vec<&Field> = [field].into_iter().chain(turbulence).collect();
        let some: Vec<Vec2> = positions.iter().step_by(DERIVATIVE_STRIDE).copied().collect();
        for (sum, rms) in self.squares.iter_mut().zip(metric::divergence_and_curl_rms(&all, &some)) {
            *sum += rms * rms;
        }
    }

    /// Whether a number is taken at a time within this step.
    pub(super) fn awaits(start: f64, length: f64) -> bool {
        let end = start + length;
        end >= 1.0 || CROSSING_TIMES.iter().any(|t| (start..end).contains(t))
    }

    /// The photons were carried through a step.
    pub(super) fn stepped(&mut self, photons: &impl Moving, start: f64, length: f64) {
        let end = start + length;
        for (index, &t) in CROSSING_TIMES.iter().enumerate() {
            if (start..end).contains(&t) {
                self.report.crossing_index[index] = self.variance(photons, t).crossing_index();
            }
        }
        self.speeds(photons, start + 0.5 * length);
        self.at(photons, start);
        if end >= 1.0 {
            self.at(photons, 1.0);
        }
    }

    /// Derives the numbers that need the whole run. `positions` are those at t = 1.
    pub(super) fn finish(
        mut self,
        positions: &[Vec2],
        turbulence: Option<&Turbulence>,
        astray: Astray,
    ) -> FlowReport {
        let fits = self.report.fits.max(1) as f64;
        let report = &mut self.report;
        report.solver_iterations_mean /= fits;
        report.fit_residual /= fits;
        report.turbulence_rms = turbulence.map_or(0.0, |turbulence| turbulence.speed().into());
        [report.divergence_rms, report.curl_rms] = self.squares.map(|sum| (sum / fits).sqrt());
        report.peak_speed_ratio = metric::peak_speed_ratio(&self.fastest, report.mean_straight as f32);
        let ways: Vec<f32> = self.source.iter().zip(self.target).map(|(a, b)| a.distance(*b)).collect();
        report.straight_peak_ratio = metric::peak_speed_ratio(&ways, report.mean_straight as f32);
        report.dispersion = self.dispersion_sum / self.dispersions.max(1) as f64;
        let motion = self.by_field + self.by_guidance;
        report.field_share = if motion > 0.0 { self.by_field / motion } else { 0.0 };
        report.endpoint_error = metric::endpoint_error(positions, self.target);
        (report.wall_crossings, report.unreachable) = (astray.crossings, astray.unreachable);
        self.report
    }

    /// Speeds, dispersion and distance from the straight ways at `t`.
    fn at(&mut self, photons: &impl Moving, t: f64) {
        self.speeds(photons, t);
        let dispersion = self.variance(photons, t).dispersion();
        self.dispersion_sum += dispersion;
        self.dispersions += 1;
        self.report.dispersion_max = self.report.dispersion_max.max(dispersion);
        let ways = || self.source.iter().zip(self.target);
        let straight = ways().map(|(a, &b)| a.lerp(b, t as f32));
        let wander = metric::relative_distance(&self.positions, straight, ways().map(|(&a, &b)| b - a));
        self.report.wander = self.report.wander.max(wander);
    }

    fn speeds(&mut self, photons: &impl Moving, t: f64) {
        photons.velocities(t, &mut self.velocities);
        for (fastest, v) in self.fastest.iter_mut().zip(&self.velocities) {
            *fastest = fastest.max(v.length());
        }
    }

    fn variance(&mut self, photons: &impl Moving, t: f64) -> NeighbourVariance {
        photons.positions(t, &mut self.positions);
        photons.velocities(t, &mut self.velocities);
        NeighbourVariance::new(&self.positions, &self.velocities, self.extent)
    }

    /// Which part of the motion at `t`, in the current step, is the field's: c' - s v = (1-s) u.
    pub(super) fn steered(&mut self, swarm: &Swarm, t: f64, fade: &Fade) {
        swarm.velocities(t, &mut self.velocities);
        swarm.guidance(t, &mut self.guidance);
        let shares = swarm.shares(fade.share(t) as f32, &self.guidance);
        for ((velocity, &v), share) in self.velocities.iter().zip(&self.guidance).zip(shares) {
            let straight = (1.0 - share) * v;
            self.by_field += f64::from((*velocity - straight).length());
            self.by_guidance += f64::from(straight.length());
        }
    }
}
