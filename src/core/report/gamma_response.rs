//! What gamma does, for the joint fit and for the separate blend: does the slider act over its whole travel?

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::plot::{Line, Panel, Tone, draw};
use crate::files::write_atomic;
use crate::flow::{Course, FitKind, FlowSettings, Movement, fit_segment, metric};
use crate::pipeline::{FirstMove, Pipeline, Quality};
use crate::project::Project;
use crate::{Progress, Result};

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
pub fn gamma_response(
    pipeline: &mut Pipeline,
    project: &Project,
    progress: &Progress,
) -> Result<GammaResponse> {
    let mut project = Quality::Preview.apply(project);
    project.method = Movement::Flow;
    progress.set_road(vec![("trace", 1.0), ("match", 1.0), ("gamma", 15.0)]);
    let photons = pipeline.first_move(&project, progress)?;
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

fn respond(photons: &FirstMove, settings: &FlowSettings, progress: &Progress) -> Result<Response> {
    let FirstMove { source, target, extent, lines, walls, number } = photons;
    let course = Course { source, target, extent: *extent, settings, lines, walls, number: *number };
    let (fields, report) = fit_segment(&course, progress, None)?;
    let first = fields.nodes().first().map(|field| metric::divergence_and_curl_rms(&[field], source));
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

impl GammaResponse {
    /// Writes `gamma.svg` and `gamma.csv` into the folder `out`, and returns their paths.
    ///
    /// # Errors
    /// `Io` when a file cannot be written.
    pub fn write(&self, out: &Path) -> Result<[PathBuf; 2]> {
        let files = ["gamma.svg", "gamma.csv"].map(|name| out.join(name));
        for (path, text) in files.iter().zip([self.to_svg()?, self.to_csv()]) {
            write_atomic(path, |file| file.write_all(text.as_bytes()))?;
        }
        Ok(files)
    }

    /// Four panels over gamma: divergence and curl, of the first field and of the whole run; blue joint, red separate.
    ///
    /// # Errors
    /// `Numeric` when there is nothing finite to draw.
    pub fn to_svg(&self) -> Result<String> {
        let panel = |title: &'static str, value: fn(&Response) -> f64| {
            let line = |(fit, label, tone)| Line {
                label,
                tone,
                points: self.of(fit).map(|row| (row.gamma.into(), value(row))).collect(),
            };
            let lines = [(FitKind::Joint, "joint", Tone::Blue), (FitKind::Separate, "separate", Tone::Red)];
            Panel { title, lines: lines.map(line).to_vec() }
        };
        let panels = [
            panel("divergence, first field", |row| row.divergence_first),
            panel("curl, first field", |row| row.curl_first),
            panel("divergence, whole run", |row| row.divergence_rms),
            panel("curl, whole run", |row| row.curl_rms),
        ];
        draw(&format!("{}, alpha {}", self.project, self.alpha), "gamma", &panels)
    }

    /// A row of comma separated numbers for each fit and gamma, under their names.
    pub fn to_csv(&self) -> String {
        let mut text = String::from("fit");
        COLUMNS.iter().for_each(|(name, _)| text.extend([",", name]));
        for row in &self.rows {
            text.push_str(if row.fit == FitKind::Joint { "\njoint" } else { "\nseparate" });
            for (_, value) in COLUMNS {
                let _ = write!(text, ",{:.6}", value(row));
            }
        }
        text + "\n"
    }

    /// As indented JSON.
    pub fn to_json(&self) -> String {
        // Plain numbers and strings: serialisation has nothing to fail on.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// Divergence and curl over the whole run as lines for people.
    pub fn to_text(&self) -> String {
        let mut text = format!(
            "{}, alpha {}: divergence and curl over the run\n  gamma       joint           separate\n",
            self.project, self.alpha
        );
        for (joint, separate) in self.of(FitKind::Joint).zip(self.of(FitKind::Separate)) {
            let _ = writeln!(
                text,
                "  {:<6}{:8.3}{:8.3}  {:8.3}{:8.3}",
                joint.gamma, joint.divergence_rms, joint.curl_rms, separate.divergence_rms, separate.curl_rms
            );
        }
        text
    }

    fn of(&self, fit: FitKind) -> impl Iterator<Item = &Response> {
        self.rows.iter().filter(move |row| row.fit == fit)
    }
}
