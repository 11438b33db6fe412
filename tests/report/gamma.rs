//! The report: what gamma does, measured through the whole road.

use std::path::Path;
use std::sync::OnceLock;

use lightloom_core::engine::Engine;
use lightloom_core::flow::FitKind;
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::{Error, Progress};
use lightloom_report::{GammaResponse, Response, gamma_response};

use crate::letters::project;

fn report(path: &Path, progress: &Progress) -> Result<GammaResponse, Error> {
    let engine = Engine::new(AssetFolder::new(path, false).unwrap());
    gamma_response(&engine, &Project::load(path).unwrap(), progress)
}

/// The letters as measured, once for all tests.
fn measured() -> &'static GammaResponse {
    static MEASURED: OnceLock<GammaResponse> = OnceLock::new();
    MEASURED.get_or_init(|| {
        let (_folder, path) = project(&["c", "s"]);
        report(&path, &Progress::new()).unwrap()
    })
}

fn rows(response: &GammaResponse, fit: FitKind) -> Vec<&Response> {
    response.rows.iter().filter(|row| row.fit == fit).collect()
}

#[test]
fn gamma_acts_evenly_in_the_separate_blend_and_early_in_the_joint_fit() {
    let response = measured();
    let (joint, separate) = (rows(response, FitKind::Joint), rows(response, FitKind::Separate));
    let (liquid, gradient) = (separate[0], separate[separate.len() - 1]);
    // A liquid has no divergence and a gradient no curl; the turbulence of the project is left out of both.
    assert!(
        liquid.divergence_rms < 1e-5 * liquid.curl_rms && gradient.curl_rms < 1e-5 * gradient.divergence_rms
    );
    for row in &separate {
        let gamma = f64::from(row.gamma);
        // Of the first field it is a plain product; rounding of f32 coefficients, over cells of 1/24.
        let error = (row.divergence_first - gamma * gradient.divergence_first) / gradient.divergence_first;
        assert!(error.abs() < 1e-3, "divergence at {gamma}");
        let error = (row.curl_first - (1.0 - gamma) * liquid.curl_first) / liquid.curl_first;
        assert!(error.abs() < 1e-3, "curl at {gamma}");
    }
    let at = |rows: &[&Response], gamma: f32| {
        let row = rows.iter().find(|row| row.gamma == gamma).unwrap();
        row.divergence_rms / gradient.divergence_rms
    };
    // The trap that the separate blend avoids: at this alpha most of the divergence is there at a tenth of the slider.
    assert!(at(&joint, 0.1) > 0.6 && at(&separate, 0.1) < 0.3);
    assert!((0.35..0.75).contains(&at(&separate, 0.5)));
    // The two have their ends in common, up to the tolerance of the solver.
    for (a, b) in [(joint[0], separate[0]), (joint[joint.len() - 1], gradient)] {
        assert!((a.divergence_rms - b.divergence_rms).abs() + (a.curl_rms - b.curl_rms).abs() < 1e-3);
    }
}

#[test]
fn the_plot_and_the_table_hold_every_row() {
    let (_folder, path) = project(&["c", "s"]);
    let response = measured();
    assert!(report(&path, &Progress::new()).unwrap() == *response, "the same seed, the same numbers");
    let chapter = response.section();
    let csv = String::from_utf8(chapter.tables().next().unwrap().to_csv().unwrap()).unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines.len(), 1 + response.rows.len());
    assert!(lines[1].starts_with("joint,0,") && lines[26].starts_with("separate,1,"), "{csv}");
    let svg = chapter.plots().next().unwrap().to_svg().unwrap();
    // Four panels of two lines; the name is text, not markup.
    assert!(svg.matches("<polyline").count() >= 8);
    assert!(svg.trim_end().ends_with("</svg>") && !svg.contains("<letters>"), "{svg}");
}

#[test]
fn keys_at_rest_are_passed_over() {
    let (_folder, path) = project(&["points", "points"]);
    let error = report(&path, &Progress::new()).unwrap_err().to_string();
    assert!(error.contains("no photon moves"), "{error}");
    let (_folder, path) = project(&["c"]);
    assert!(report(&path, &Progress::new()).unwrap_err().to_string().contains("no photon moves"));
}

#[test]
fn a_cancelled_report_says_so() {
    let (_folder, path) = project(&["c", "s"]);
    let progress = Progress::new();
    progress.cancel();
    assert!(matches!(report(&path, &progress), Err(Error::Cancelled)));
}
