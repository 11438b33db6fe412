//! The flow: its kind, its smoothness, its lines; what is seldom touched is folded.

use egui::Ui;
use lightloom_core::flow::{FitKind, FlowSettings, GridSize, Movement};
use lightloom_core::matching::Method;

use super::setting::{Choice, Setting, ends, format_number};
use super::{fade, fold, pictures, presets, turbulence};
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;

/// Largest grid at the default number of steps: finer ones need more memory than the fit may take.
const FINEST: f64 = 1901.0;

const GAMMA: Setting = Setting::real("Gamma", "flow.gamma", [0.0, 1.0], &[0.5])
    .help("Kind of flow. At 0 light swirls like a liquid and cannot pile up on its way, at 1 it spreads and gathers like a gradient, without swirls. Touch it first.")
    .pictures(&pictures::GAMMA);
const ALPHA: Setting = Setting::real("Alpha", "flow.alpha", [1e-12, 1e6], &[1e-3])
    .slider(1e-6, 1.0)
    .logarithmic()
    .help("Smoothness of the field: it is smooth over about the root of alpha, told below in per cent of the plane's longer side. Low values follow each photon and look busy, high ones carry all light along in wide folds.")
    .pictures(&pictures::ALPHA);
const BETA: Setting = Setting::real("Beta", "flow.beta", [0.0, 1e6], &[1.0])
    .slider(0.0, 100.0)
    .logarithmic()
    .help("How strongly directed lines pull, beside all photons together, which pull by 1. Raise it where light ignores a line.")
    .pictures(&pictures::BETA);
const RHO: Setting = Setting::real("Rho", "flow.rho", [f32::MIN_POSITIVE as f64, 1000.0], &[1.0])
    .slider(0.01, 100.0)
    .logarithmic()
    .help("Light of the target over that of the source. 1 keeps the energy; more brightens the picture on the way, less dims it.");
const METHOD: Setting = Setting::choice(
    "Method",
    "method",
    &[
        Choice::new("flow", "Flow", "along a fitted field; the only one that heeds lines and walls"),
        Choice::new("stylized", "2016", "the method before, to compare with: landmarks and a warp"),
        Choice::new("linear", "Linear", "straight lines, to compare with"),
    ],
)
.help("How the light gets from key frame to key frame.");
const FIT: Setting = Setting::choice(
    "Fit",
    "flow.fit",
    &[
        Choice::new("separate", "Separate", "gamma acts evenly over its whole travel"),
        Choice::new("joint", "Joint", "as in the paper: gamma acts mostly below 0.2"),
    ],
)
.help("How liquid and gradient are put together.");
const GRID: Setting = Setting::whole("Grid", "flow.grid", [8.0, FINEST], &[128.0])
    .slider(16.0, 512.0)
    .logarithmic()
    .help("Cells of the field along the longer side of the plane. Finer ones follow finer lines and take longer.");
const STEPS: Setting = Setting::whole("Steps", "flow.steps", [1.0, 10_000.0], &[40.0])
    .slider(5.0, 200.0)
    .logarithmic()
    .help("Time steps from key frame to key frame; the field is fitted in each. More follow tight bends more closely and take longer.");
const GUIDES: Setting = Setting::whole("Guides", "flow.guides", [1.0, 5e7], &[100_000.0])
    .slider(1000.0, 1e6)
    .logarithmic()
    .help("Photons to which the field is fitted. More hold the field steadier where light is thin.");
const TOLERANCE: Setting = Setting::real("Tolerance", "flow.tolerance", [1e-12, 0.1], &[1e-4])
    .slider(1e-8, 0.1)
    .logarithmic()
    .help("Residual at which the solver stops. Lower it only if the flow trembles from frame to frame.");
const MATCHING: Setting = Setting::choice(
    "Matching",
    "matching",
    &[
        Choice::new("transport", "Transport", "the shortest ways altogether: neighbours stay neighbours"),
        Choice::new("given", "Given", "row by row, where all keys are files of points"),
    ],
)
.help("Which photon goes to which place of the target.");
/// Cells along x and along y, where they are given apart.
const BOTH: Setting = Setting { place: "flow.grid", ..GRID };

/// The settings of this panel.
pub(super) const SETTINGS: &[Setting] =
    &[GAMMA, ALPHA, BETA, RHO, METHOD, FIT, GRID, STEPS, GUIDES, TOLERANCE, MATCHING];

/// The flow panel.
pub(super) fn show(ui: &mut Ui, editor: &mut EditorContext) {
    let project = editor.document.project();
    let mut flow = project.flow.clone();
    presets::show(ui, &mut flow);
    ui.add_space(4.0);
    GAMMA.number(ui, &mut flow.gamma);
    ends(ui, "liquid", "gradient");
    ALPHA.number(ui, &mut flow.alpha);
    smoothing(ui, editor, &flow);
    BETA.number(ui, &mut flow.beta);
    turbulence::show(ui, &mut flow.turbulence);
    fade::show(ui, &mut flow.fade);
    let (mut method, mut matching) = (project.method, project.matching);
    fold(ui, "Advanced", |ui| {
        METHOD.choose(ui, &mut method, &Movement::ALL);
        MATCHING.choose(ui, &mut matching, &[Method::Transport, Method::Given]);
        FIT.choose(ui, &mut flow.fit, &[FitKind::Separate, FitKind::Joint]);
        grid(ui, &mut flow.grid);
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

fn grid(ui: &mut Ui, size: &mut GridSize) {
    match size {
        GridSize::Longer(cells) => {
            GRID.number(ui, cells);
        }
        GridSize::Both(cells) => {
            BOTH.numbers(ui, cells, ["along x", "along y"]);
        }
    }
}

/// What alpha means on this plane: the length over which the field is smooth.
fn smoothing(ui: &mut Ui, editor: &EditorContext, flow: &FlowSettings) {
    let share = flow.alpha.sqrt();
    let cells = flow.grid.cells(editor.document.project().extent()).into_iter().max().unwrap_or(0);
    let percent = format_number(round(f64::from(share) * 100.0), false);
    let in_cells = format_number(round(f64::from(share) * f64::from(cells)), false);
    super::aside(ui, &format!("smooth over {percent} %, {in_cells} cells"));
}

/// To two digits that count.
fn round(value: f64) -> f64 {
    let unit = 10_f64.powf(value.abs().max(1e-12).log10().floor() - 1.0);
    (value / unit).round() * unit
}
