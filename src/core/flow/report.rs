//! The numbers of a flow.

use serde::Serialize;

/// Quality and cost of the flow between two key frames, over the guide photons and the whole run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FlowReport {
    /// Guide photons.
    pub guides: usize,
    /// Fits made; fewer than steps where the fade ends early.
    pub fits: usize,
    /// Unknowns of one fit.
    pub unknowns: usize,
    /// Most solver iterations of a fit.
    pub solver_iterations: usize,
    /// Mean solver iterations of a fit.
    pub solver_iterations_mean: f64,
    /// Largest error of the velocities that the solver leaves, over the root mean square of those wanted.
    pub solver_error: f64,
    /// Largest condition number of the preconditioned matrix; a lower bound.
    pub solver_condition: f64,
    /// |u(c) - v| / |v| in root mean square, averaged over the fits.
    pub fit_residual: f64,
    /// Divergence of the fields and the turbulence where the photons are, root mean square, per unit of t.
    pub divergence_rms: f64,
    /// Curl of the same.
    pub curl_rms: f64,
    /// Speed of the turbulence over the plane, root mean square, in plane units per unit of t; 0 where there is none.
    pub turbulence_rms: f64,
    /// Mean straight distance |b - a| in plane units.
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
    /// Largest root mean square distance of the photons from their straight paths, over that of |b - a|.
    pub wander: f64,
    /// Root mean square gap between the two ends of a photon where the key frames meet, plane units; 0 where they do not.
    pub gap: f64,
    /// Share of the photons whose way to their partner at the meeting is blocked: they leave the flow for the shortest path
    /// around the walls.
    pub detours: f64,
    /// max |c(1) - b| in plane units.
    pub endpoint_error: f64,
    /// Wall crossings of photons that have a path around, over all steps.
    pub wall_crossings: usize,
    /// Photons whose target no path around the walls reaches: they go straight, through the walls.
    pub unreachable: usize,
}

impl FlowReport {
    /// The worse of two flows in each number.
    pub fn worst(&self, other: &Self) -> Self {
        let (a, b) = (self, other);
        Self {
            guides: a.guides.max(b.guides),
            fits: a.fits + b.fits,
            unknowns: a.unknowns.max(b.unknowns),
            solver_iterations: a.solver_iterations.max(b.solver_iterations),
            solver_iterations_mean: a.solver_iterations_mean.max(b.solver_iterations_mean),
            solver_error: a.solver_error.max(b.solver_error),
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
            gap: a.gap.max(b.gap),
            detours: a.detours.max(b.detours),
            endpoint_error: a.endpoint_error.max(b.endpoint_error),
            wall_crossings: a.wall_crossings + b.wall_crossings,
            unreachable: a.unreachable.max(b.unreachable),
        }
    }
}
