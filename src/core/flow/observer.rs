//! Measurements of a flow while it is made.

use glam::Vec2;

use super::field::Field;
use super::fit::FitReport;
use super::guidance::mean_straight;
use super::metric::{self, NeighbourVariance};
use super::report::FlowReport;
use super::turbulence::Turbulence;
use super::walls::WallViolations;

/// Positions and velocities of photons within the current step.
pub(super) trait Kinematics {
    /// Positions at `t`, which lies in the current step.
    fn positions(&self, t: f64, out: &mut [Vec2]);
    /// Velocities at `t`, which lies in the current step.
    fn velocities(&self, t: f64, out: &mut [Vec2]);
}

/// The velocities of photons with their guidance and field weights, row by row.
pub(super) struct Steering {
    /// Velocities c'.
    pub velocities: Vec<Vec2>,
    /// Guidance v.
    pub guidance: Vec<Vec2>,
    /// Weights of the field, 1 - s.
    pub field_shares: Vec<f32>,
}

/// Collects the figures of the fits.
#[derive(Default)]
pub(super) struct FitStatistics {
    report: FlowReport,
    squares: [f64; 2],
}

impl FitStatistics {
    /// Records a fitted field and the turbulence that is added to it.
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
        report.solver_error = report.solver_error.max(fit.error);
        report.solver_condition = report.solver_condition.max(fit.condition);
        report.fit_residual += metric::fit_residual(field, positions, guidance);
        let all: Vec<&Field> = [field].into_iter().chain(turbulence).collect();
        let some: Vec<Vec2> = positions.iter().step_by(DERIVATIVE_STRIDE).copied().collect();
        for (sum, rms) in self.squares.iter_mut().zip(metric::divergence_and_curl_rms(&all, &some)) {
            *sum += rms * rms;
        }
    }

    /// The figures of all fits, in a report that has no others.
    pub(super) fn report(mut self) -> FlowReport {
        let fits = self.report.fits.max(1) as f64;
        let report = &mut self.report;
        report.solver_iterations_mean /= fits;
        report.fit_residual /= fits;
        [report.divergence_rms, report.curl_rms] = self.squares.map(|sum| (sum / fits).sqrt());
        self.report
    }
}

/// Collects the report while the photons move.
pub(super) struct Observer<'a> {
    source: &'a [Vec2],
    target: &'a [Vec2],
    extent: Vec2,
    report: FlowReport,
    fastest: Vec<f32>,
    dispersion_sum: f64,
    dispersions: usize,
    by_field: f64,
    by_guidance: f64,
    positions: Vec<Vec2>,
    velocities: Vec<Vec2>,
}

/// Times at which the crossing index is taken.
const CROSSING_TIMES: [f64; 3] = [0.25, 0.5, 0.75];
/// Stride of the photons at which derivatives of the field are evaluated.
const DERIVATIVE_STRIDE: usize = 16;

impl<'a> Observer<'a> {
    /// Photons from `source` to `target`, row by row.
    pub(super) fn new(source: &'a [Vec2], target: &'a [Vec2], extent: Vec2) -> Self {
        let n = source.len();
        let report = FlowReport {
            guides: n,
            mean_straight: mean_straight(source, target).into(),
            ..FlowReport::default()
        };
        Self {
            source,
            target,
            extent,
            report,
            fastest: vec![0.0; n],
            dispersion_sum: 0.0,
            dispersions: 0,
            by_field: 0.0,
            by_guidance: 0.0,
            positions: vec![Vec2::ZERO; n],
            velocities: vec![Vec2::ZERO; n],
        }
    }

    /// Whether a number is recorded at a time within this step.
    pub(super) fn awaits(start: f64, length: f64) -> bool {
        let end = start + length;
        end >= 1.0 || CROSSING_TIMES.iter().any(|t| (start..end).contains(t))
    }

    /// Records a step of the photons.
    pub(super) fn stepped(&mut self, photons: &impl Kinematics, start: f64, length: f64) {
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

    /// The report of the whole run. `positions` are those at t = 1.
    pub(super) fn finish(
        mut self,
        positions: &[Vec2],
        turbulence: Option<&Turbulence>,
        violations: WallViolations,
        fits: FlowReport,
    ) -> FlowReport {
        let FlowReport { guides, mean_straight, crossing_index, dispersion_max, wander, .. } = self.report;
        self.report = FlowReport { guides, mean_straight, crossing_index, dispersion_max, wander, ..fits };
        let report = &mut self.report;
        report.turbulence_rms = turbulence.map_or(0.0, |turbulence| turbulence.speed().into());
        report.peak_speed_ratio = metric::peak_speed_ratio(&self.fastest, report.mean_straight as f32);
        let distances: Vec<f32> = self.source.iter().zip(self.target).map(|(a, b)| a.distance(*b)).collect();
        report.straight_peak_ratio = metric::peak_speed_ratio(&distances, report.mean_straight as f32);
        report.dispersion = self.dispersion_sum / self.dispersions.max(1) as f64;
        let motion = self.by_field + self.by_guidance;
        report.field_share = if motion > 0.0 { self.by_field / motion } else { 0.0 };
        report.endpoint_error = metric::endpoint_error(positions, self.target);
        (report.wall_crossings, report.unreachable) = (violations.crossings, violations.unreachable);
        self.report
    }

    /// Records speeds, dispersion and distance from the straight paths at `t`.
    fn at(&mut self, photons: &impl Kinematics, t: f64) {
        self.speeds(photons, t);
        let dispersion = self.variance(photons, t).dispersion();
        self.dispersion_sum += dispersion;
        self.dispersions += 1;
        self.report.dispersion_max = self.report.dispersion_max.max(dispersion);
        let pairs = || self.source.iter().zip(self.target);
        let straight = pairs().map(|(a, &b)| a.lerp(b, t as f32));
        let wander = metric::relative_distance(&self.positions, straight, pairs().map(|(&a, &b)| b - a));
        self.report.wander = self.report.wander.max(wander);
    }

    fn speeds(&mut self, photons: &impl Kinematics, t: f64) {
        photons.velocities(t, &mut self.velocities);
        for (fastest, v) in self.fastest.iter_mut().zip(&self.velocities) {
            *fastest = fastest.max(v.length());
        }
    }

    fn variance(&mut self, photons: &impl Kinematics, t: f64) -> NeighbourVariance {
        photons.positions(t, &mut self.positions);
        photons.velocities(t, &mut self.velocities);
        NeighbourVariance::new(&self.positions, &self.velocities, self.extent)
    }

    /// Adds the parts of the velocities that field and guidance contribute: c' - s v = (1-s) u.
    pub(super) fn steered(&mut self, steering: &Steering) {
        let Steering { velocities, guidance, field_shares } = steering;
        for ((velocity, &v), share) in velocities.iter().zip(guidance).zip(field_shares) {
            let straight = (1.0 - share) * v;
            self.by_field += f64::from((*velocity - straight).length());
            self.by_guidance += f64::from(straight.length());
        }
    }
}
