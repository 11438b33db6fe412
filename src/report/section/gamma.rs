//! What gamma does, for the joint fit and for the separate blend: does the slider act over its whole travel?

use serde::Serialize;

use super::super::chapter::{Cell, Chapter, Part, Table, Tone};
use super::super::plot::{Axis, Line, Panel, Plot, Style};
use super::super::workbench::Workbench;
use super::{Section, nothing_moves};
use lightloom_core::engine::{Engine, MovingSegment, Quality};
use lightloom_core::flow::{FitKind, FlowSettings, Movement, fit_segment, metric};
use lightloom_core::project::Project;
use lightloom_core::{Progress, Result};

/// The gammas looked at: close together near 0, where the joint fit changes fastest.
const GAMMAS: [f32; 13] = [0.0, 0.01, 0.03, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];
const KINDS: [FitKind; 2] = [FitKind::Joint, FitKind::Separate];

/// How the flow turns out at one gamma. Divergence and curl are root mean squares where the photons are, per unit of t.
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
    /// |u(c) - v| / |v|, what the field leaves undone.
    pub fit_residual: f64,
    /// Share of the velocity variance that the place does not explain, at half the time.
    pub crossing_index: f64,
    /// Neighbour-velocity variance over the mean square velocity.
    pub dispersion: f64,
    /// Distance from the straight ways over their length, where it is largest.
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
    let mut project = Quality::Preview.apply(project);
    project.method = Movement::Flow;
    progress.set_stages(vec![("trace", 1.0), ("match", 1.0), ("gamma", 15.0)]);
    let photons = engine.moving_segment(&project, None, progress)?;
    progress.begin("gamma", (KINDS.len() * GAMMAS.len()) as u64);
    let mut rows = Vec::new();
    for fit in KINDS {
        for gamma in GAMMAS {
            let settings = FlowSettings { fit, gamma, turbulence: None, ..project.flow.clone() };
            rows.push(respond(&photons, &settings, &progress.inner())?);
            progress.advance(1);
        }
    }
    Ok(GammaResponse { project: project.name, alpha: project.flow.alpha, rows })
}

fn respond(photons: &MovingSegment, settings: &FlowSettings, progress: &Progress) -> Result<Response> {
    let (fields, report) = fit_segment(&photons.course(settings), progress, None)?;
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

pub(crate) const SECTION: Section =
    Section { name: "gamma", needless: nothing_moves, measure, seconds: [6.0, 8.0] };

/// At preview size in any case: the shape of the response does not depend on the grid.
fn measure(bench: &mut Workbench, progress: &Progress) -> Result<Chapter> {
    progress.begin("gamma", 1);
    let response = gamma_response(bench.engine, &bench.project, &progress.inner())?;
    progress.advance(1);
    Ok(response.chapter())
}

impl GammaResponse {
    /// Four panels over gamma, divergence and curl of the first field and of the whole run, and the table.
    pub fn chapter(&self) -> Chapter {
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
        let mut chapter = Chapter::new("gamma", "What gamma does");
        chapter.say(
            "Root mean square of divergence and curl where the photons are, at preview size and without turbulence. \
             A slider that acts evenly has straight lines in the upper row.",
        );
        chapter.parts.push(Part::Plot(Plot { name: "gamma".to_owned(), title, panels }));
        chapter.parts.push(Part::Table(self.table()));
        chapter
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

/// What is written of each row, with its name.
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
