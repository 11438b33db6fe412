//! The flow: kind, smoothness, lines, turbulence, fade; the rest under Advanced.

use egui::Ui;
use lightloom_core::flow::{FitKind, FlowSettings, GridSize, MotionMethod};
use lightloom_core::matching::MatchingMethod;
use lightloom_core::setting::format::number;

use super::control::Control;
use super::control::number::end_labels;
use super::widgets::{aside, fold};
use super::{fade, pictures, presets, turbulence};
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;

const GAMMA: Control = Control::new("Gamma", FlowSettings::GAMMA).pictures(&pictures::GAMMA);
const ALPHA: Control =
    Control::new("Alpha", FlowSettings::ALPHA).log_slider(1e-6, 1.0).pictures(&pictures::ALPHA);
const BETA: Control =
    Control::new("Beta", FlowSettings::BETA).log_slider(0.0, 100.0).pictures(&pictures::BETA);
const RHO: Control = Control::new("Rho", FlowSettings::RHO).log_slider(0.01, 100.0).pictures(&pictures::RHO);
const METHOD: Control =
    Control::new("Method", MotionMethod::METHOD).labels(&["Flow", "Guided", "2016", "Linear"]);
const HOLD: Control = Control::new("Hold", FlowSettings::HOLD).slider(0.04, 0.2);
const DENSITY: Control = Control::new("Density", FlowSettings::DENSITY).log_slider(1.0, 10.0);
const FIT: Control = Control::new("Fit", FlowSettings::FIT).labels(&["Separate", "Joint"]);
const GRID: Control = Control::new("Grid", FlowSettings::GRID).log_slider(16.0, 512.0);
const STEPS: Control = Control::new("Steps", FlowSettings::STEPS).log_slider(5.0, 200.0);
const GUIDES: Control = Control::new("Guides", FlowSettings::GUIDES).log_slider(1000.0, 1e6);
const TOLERANCE: Control = Control::new("Tolerance", FlowSettings::TOLERANCE).log_slider(1e-8, 0.1);
const MATCHING: Control = Control::new("Matching", MatchingMethod::MATCHING).labels(&["Transport", "Given"]);

/// The settings of this panel.
pub(super) const CONTROLS: &[Control] =
    &[GAMMA, ALPHA, BETA, HOLD, DENSITY, RHO, METHOD, FIT, GRID, STEPS, GUIDES, TOLERANCE, MATCHING];

/// The flow panel.
pub(super) fn show(ui: &mut Ui, editor: &mut EditorContext) {
    let project = editor.document.project();
    let mut flow = project.flow.clone();
    presets::show(ui, &mut flow);
    ui.add_space(4.0);
    GAMMA.number(ui, &mut flow.gamma);
    end_labels(ui, "liquid", "gradient");
    ALPHA.number(ui, &mut flow.alpha);
    smoothing(ui, editor, &flow);
    BETA.number(ui, &mut flow.beta);
    if project.method == MotionMethod::Flow {
        HOLD.number(ui, &mut flow.hold);
        DENSITY.number(ui, &mut flow.density);
    }
    turbulence::show(ui, &mut flow.turbulence);
    if project.method == MotionMethod::Guided {
        fade::show(ui, &mut flow.fade);
    }
    let (mut method, mut matching) = (project.method, project.matching);
    fold(ui, "Advanced", |ui| {
        METHOD.choose(ui, &mut method, &MotionMethod::ALL);
        MATCHING.choose(ui, &mut matching, &[MatchingMethod::Transport, MatchingMethod::Given]);
        if method == MotionMethod::Guided {
            FIT.choose(ui, &mut flow.fit, &[FitKind::Separate, FitKind::Joint]);
        }
        grid(ui, &mut flow);
        STEPS.number(ui, &mut flow.steps);
        GUIDES.number(ui, &mut flow.guides);
        RHO.number(ui, &mut flow.rho);
        TOLERANCE.number(ui, &mut flow.tolerance);
    });
    if flow != project.flow {
        editor.ask(Edit::Flow(flow));
    }
    if method != project.method {
        editor.ask(Edit::Method(method));
    }
    if matching != project.matching {
        editor.ask(Edit::Matching(matching));
    }
}

fn grid(ui: &mut Ui, flow: &mut FlowSettings) {
    let mut control = GRID;
    control.setting.range[1] = flow.finest_grid().into();
    match &mut flow.grid {
        GridSize::Longer(cells) => control.number(ui, cells),
        GridSize::Both(cells) => control.numbers(ui, cells, ["along x", "along y"]),
    };
}

/// The length over which alpha smooths the field on this plane.
fn smoothing(ui: &mut Ui, editor: &EditorContext, flow: &FlowSettings) {
    let share = flow.alpha.sqrt();
    let cells = flow.grid.cells(editor.document.project().extent()).into_iter().max().unwrap_or(0);
    let percent = number(round(f64::from(share) * 100.0), false);
    let in_cells = number(round(f64::from(share) * f64::from(cells)), false);
    aside(ui, &format!("smooth over {percent} %, {in_cells} cells"));
}

/// Rounded to two significant digits.
fn round(value: f64) -> f64 {
    let unit = 10_f64.powf(value.abs().max(1e-12).log10().floor() - 1.0);
    (value / unit).round() * unit
}
