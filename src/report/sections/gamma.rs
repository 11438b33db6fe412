//! The response of the flow to gamma, for the joint and the separate fit: does the slider act over its whole range?

use serde::Serialize;

use super::section_def::{SectionDef, nothing_moves};
use crate::content::{Cell, Section, Table, Tone};
use crate::context::Context;
use crate::plot::{Axis, Line, Panel, Plot, Style};
use lightloom_core::engine::{Engine, MovingSegment, Quality};
use lightloom_core::flow::{FitKind, FlowSettings, MotionMethod, fit_segment, metric};
use lightloom_core::project::Project;
use lightloom_core::{Progress, Result};

/// The measured gammas: dense near 0, where the joint fit changes fastest.
const GAMMAS: [f32; 13] = [0.0, 0.01, 0.03, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
const KINDS: [FitKind; 2] = [FitKind::Joint, FitKind::Separate];

/// The flow at one gamma. Divergence and curl are root mean squares at the photons, per unit of t.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Response {
    /// How psi and phi are fitted.
    pub fit: FitKind,
    /// Share of the irrotational part.
    pub gamma: f32,
    /// Divergence of the first field.
    pub divergence_first: f64,
    /// Curl of the first field.
    pub curl_first: f64,
    /// Divergence over the whole run.
    pub divergence_rms: f64,
    /// Curl over the whole run.
    pub curl_rms: f64,
    /// |u(c) - v| / |v|, the residual of the fit.
    pub fit_residual: f64,
    /// Share of the velocity variance that the position does not explain, at half the time.
    pub crossing_index: f64,
    /// Neighbour-velocity variance over the mean square velocity.
    pub dispersion: f64,
    /// Largest distance from the straight paths over their length.
    pub wander: f64,
    /// 99.9 % fastest photon over the mean straight speed.
    pub peak_speed_ratio: f64,
}

/// The response over all gammas, the joint fit first.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GammaResponse {
    /// The project's name.
    pub project: String,
    /// Smoothness at which it was measured.
    pub alpha: f32,
    /// One row for each fit and gamma.
    pub rows: Vec<Response>,
}

/// Fits the first segment that moves at every gamma, jointly and separately, at preview size, whatever the project's
/// method, and without turbulence.
///
/// # Errors
/// Anything wrong with the project or its files; nothing that moves; a fit that fails; cancelled.
pub fn gamma_response(engine: &Engine, project: &Project, progress: &Progress) -> Result<GammaResponse> {
    let project = preview(project);
    progress.set_stages(vec![("trace", 1.0), ("match", 1.0), ("gamma", 15.0)]);
    let photons = engine.moving_segment(&project, None, progress)?;
    responses(&project, &photons, progress)
}

/// The project at preview size, with fields. The shape of the response does not depend on the grid.
fn preview(project: &Project) -> Project {
    Project { method: MotionMethod::Guided, ..Quality::Preview.apply(project) }
}

fn responses(project: &Project, photons: &MovingSegment, progress: &Progress) -> Result<GammaResponse> {
    progress.begin("gamma", (KINDS.len() * GAMMAS.len()) as u64);
    let mut rows = Vec::new();
    for (fit, gamma) in KINDS.into_iter().flat_map(|fit| GAMMAS.map(|gamma| (fit, gamma))) {
        let settings = FlowSettings { fit, gamma, turbulence: None, ..project.flow.clone() };
        rows.push(respond(photons, &settings, &progress.inner())?);
        progress.advance(1);
    }
    Ok(GammaResponse { project: project.name.clone(), alpha: project.flow.alpha, rows })
}

fn respond(photons: &MovingSegment, settings: &FlowSettings, progress: &Progress) -> Result<Response> {
    let (fields, report) = fit_segment(&photons.segment(settings), progress)?;
    let first =
        fields.nodes().first().map(|field| metric::divergence_and_curl_rms(&[field], &photons.source));
    let [divergence_first, curl_first] = first.unwrap_or_default();
    Ok(Response {
        fit: settings.fit,
        gamma: settings.gamma,
        divergence_first,
        curl_first,
        divergence_rms: report.divergence_rms,
        curl_rms: report.curl_rms,
        fit_residual: report.fit_residual,
        crossing_index: report.crossing_index[1],
        dispersion: report.dispersion,
        wander: report.wander,
        peak_speed_ratio: report.peak_speed_ratio,
    })
}

pub(super) const SECTION: SectionDef =
    SectionDef { name: "gamma", skip: nothing_moves, measure, seconds: [6.0, 8.0] };

fn measure(context: &mut Context, progress: &Progress) -> Result<Section> {
    let project = preview(&context.project);
    let photons = context.flow_photons(project.render.photons as usize, progress)?;
    Ok(responses(&project, &photons, progress)?.section())
}

impl GammaResponse {
    /// Four panels over gamma, divergence and curl of the first field and of the whole run, and the table.
    pub fn section(&self) -> Section {
        let panel = |title: &str, value: fn(&Response) -> f64| {
            let points = |fit| self.of(fit).map(|row| (row.gamma.into(), value(row))).collect();
            let lines = vec![
                Line::new("joint", Style::Line(0), points(FitKind::Joint)),
                Line::new("separate", Style::Line(1), points(FitKind::Separate)),
            ];
            Panel { title: title.to_owned(), x: Axis::linear("gamma"), y: Axis::linear(""), lines }
        };
        let panels = vec![
            panel("divergence, first field", |row| row.divergence_first),
            panel("curl, first field", |row| row.curl_first),
            panel("divergence, whole run", |row| row.divergence_rms),
            panel("curl, whole run", |row| row.curl_rms),
        ];
        let title = format!("{}, alpha {}", self.project, self.alpha);
        let mut section = Section::new("gamma", "What gamma does");
        section.text(
            "Root mean square of divergence and curl where the photons are, at preview size and without turbulence. \
             A slider that acts evenly has straight lines in the upper row.",
        );
        section.plot(Plot { name: "gamma".to_owned(), title, panels });
        section.table(self.table());
        section
    }

    fn table(&self) -> Table {
        let columns = ["fit"].into_iter().chain(COLUMNS.map(|(name, _)| name));
        let caption = "The flow from the first key at every gamma, fitted jointly and separately.";
        let mut table = Table::new("gamma", caption, &columns.collect::<Vec<_>>());
        for row in &self.rows {
            let fit = if row.fit == FitKind::Joint { "joint" } else { "separate" };
            let numbers = COLUMNS.iter().map(|(_, value)| Cell::from(value(row)));
            table.push(Tone::Plain, [fit.into()].into_iter().chain(numbers).collect());
        }
        table
    }

    fn of(&self, fit: FitKind) -> impl Iterator<Item = &Response> {
        self.rows.iter().filter(move |row| row.fit == fit)
    }
}

/// A column of the table: its name and its value.
type Column = (&'static str, fn(&Response) -> f64);
const COLUMNS: [Column; 10] = [
    ("gamma", |row| row.gamma.into()),
    ("divergence_first", |row| row.divergence_first),
    ("curl_first", |row| row.curl_first),
    ("divergence_rms", |row| row.divergence_rms),
    ("curl_rms", |row| row.curl_rms),
    ("fit_residual", |row| row.fit_residual),
    ("crossing_index", |row| row.crossing_index),
    ("dispersion", |row| row.dispersion),
    ("wander", |row| row.wander),
    ("peak_speed_ratio", |row| row.peak_speed_ratio),
];
