//! Turbulence: swirls on top of the field.

use egui::Ui;
use lightloom_core::flow::TurbulenceSettings;

use super::setting::{Choice, Setting};
use super::{add_button, pictures, remove_button};

const ON: Setting = Setting::choice(
    "Turbulence",
    "flow.turbulence",
    &[Choice::new("", "Off", ""), Choice::new("", "On", "")],
)
.help("Swirls of random noise, added to the flow; they fade before the light arrives.");
const STRENGTH: Setting = Setting::real("Strength", "flow.turbulence.strength", [0.0, 1000.0], &[20.0])
    .unit("%")
    .slider(0.0, 100.0)
    .help("Speed of the swirls, in per cent of the plane from key frame to key frame.")
    .pictures(&pictures::TURBULENCE);
const GRIDS: Setting = Setting::part("Swirl grids", "flow.turbulence.grids")
    .help("Each grid adds swirls of its own size: the more cells along the plane, the finer. A swirl is about two cells wide. Up to 8 different grids of 4 to 512 cells, default 30.");
const CELLS: Setting = Setting::whole("Cells", "flow.turbulence.grids[]", [4.0, 512.0], &[30.0])
    .slider(4.0, 512.0)
    .logarithmic()
    .help("Cells of this grid along the longer side of the plane.");
const SHARES: Setting = Setting::choice(
    "Shares",
    "flow.turbulence.weights",
    &[
        Choice::new("", "By slope", "the finer the swirls, the weaker, by a law"),
        Choice::new("", "By hand", "a weight for each grid"),
    ],
)
.help("How the strength is shared among the grids.");
const WEIGHT: Setting = Setting::real("Weight", "flow.turbulence.weights[]", [0.0, 1000.0], &[1.0])
    .slider(0.0, 10.0)
    .help("Share of this grid in the speed; only the ratios count.");
const SLOPE: Setting =
    Setting::real("Slope", "flow.turbulence.slope", [-10.0, 10.0], &[-5.0 / 3.0]).slider(-4.0, 2.0).help(
        "Slope of the energy over the grids. -1.67 is Kolmogorov's law; higher ones give fine swirls more.",
    );
const RATE: Setting = Setting::real("Rate", "flow.turbulence.rate", [0.0, 100.0], &[1.0])
    .slider(0.0, 20.0)
    .help("How often the swirls are replaced from key frame to key frame. Low rates wind light up like ink in water, high ones scatter it.");
const SEED: Setting =
    Setting::whole("Swirl seed", "flow.turbulence.seed", [0.0, 9_007_199_254_740_991.0], &[1.0])
        .slider(0.0, 100.0)
        .help("Another number gives other swirls of the same kind.");

/// The settings of this part.
pub(super) const SETTINGS: &[Setting] = &[ON, STRENGTH, GRIDS, CELLS, SHARES, WEIGHT, SLOPE, RATE, SEED];

/// Most grids.
const MOST: usize = 8;

/// Off, or on with its values.
pub(super) fn show(ui: &mut Ui, turbulence: &mut Option<TurbulenceSettings>) {
    if let Some(on) = ON.pick(ui, usize::from(turbulence.is_some())) {
        *turbulence = (on == 1).then(TurbulenceSettings::default);
    }
    let Some(settings) = turbulence else { return };
    STRENGTH.number(ui, &mut settings.strength);
    grids(ui, settings);
    if let Some(shares) = SHARES.pick(ui, usize::from(settings.weights.is_some())) {
        settings.weights = (shares == 1).then(|| vec![1.0; settings.grids.len()]);
    }
    match &mut settings.weights {
        Some(weights) => by_hand(ui, weights),
        None => {
            SLOPE.number(ui, &mut settings.slope);
        }
    }
    RATE.number(ui, &mut settings.rate);
    SEED.number(ui, &mut settings.seed);
}

fn grids(ui: &mut Ui, settings: &mut TurbulenceSettings) {
    let before = settings.grids.clone();
    let mut gone = None;
    for i in 0..before.len() {
        GRIDS.line(ui, i == 0, |ui| {
            let width = ui.available_width() - 52.0;
            CELLS.field(ui, &mut settings.grids[i], width, &format!("Cells of swirl grid {}", i + 1));
            if before.len() > 1 && remove_button(ui, &format!("Remove swirl grid {}", i + 1)) {
                gone = Some(i);
            }
            if i == 0 && before.len() < MOST && add_button(ui, "Add a swirl grid") {
                let twice = before.iter().max().map_or(30, |cells| cells * 2);
                // Beyond the finest grid: the coarsest that is not there yet.
                let free = (4..=512).find(|cells| !before.contains(cells)).unwrap_or(4);
                settings.grids.push(if twice <= 512 { twice } else { free });
                if let Some(weights) = &mut settings.weights {
                    weights.push(1.0);
                }
            }
        });
        // Two grids of the same size would be one: pass over the other.
        if settings.grids[i] != before[i] && before.contains(&settings.grids[i]) {
            settings.grids[i] = before[i];
        }
    }
    if let Some(gone) = gone {
        settings.grids.remove(gone);
        if let Some(weights) = &mut settings.weights {
            weights.remove(gone);
            no_nothing(weights);
        }
    }
}

fn by_hand(ui: &mut Ui, weights: &mut [f32]) {
    let before = weights.to_vec();
    for (i, weight) in weights.iter_mut().enumerate() {
        WEIGHT.line(ui, i == 0, |ui| {
            let width = ui.available_width();
            WEIGHT.field(ui, weight, width, &format!("Weight of swirl grid {}", i + 1));
        });
    }
    if weights.iter().all(|weight| *weight == 0.0) {
        weights.copy_from_slice(&before);
    }
}

/// Weights that are all 0 share nothing out: then all are alike.
fn no_nothing(weights: &mut [f32]) {
    if weights.iter().all(|weight| *weight == 0.0) {
        weights.fill(1.0);
    }
}
