//! Turbulence: swirls added to the field.

use egui::Ui;
use lightloom_core::flow::{FlowSettings, TurbulenceSettings};

use super::control::Control;
use super::pictures;
use super::widgets::{add_button, remove_button};

const ON: Control = Control::new("Turbulence", FlowSettings::TURBULENCE).labels(&["Off", "On"]);
const STRENGTH: Control =
    Control::new("Strength", TurbulenceSettings::STRENGTH).slider(0.0, 100.0).pictures(&pictures::TURBULENCE);
const GRIDS: Control = Control::new("Swirl grids", TurbulenceSettings::GRIDS);
const CELLS: Control =
    Control::new("Cells", TurbulenceSettings::CELLS).log_slider(4.0, 512.0).without_suffix();
const SHARES: Control = Control::new("Shares", TurbulenceSettings::WEIGHTS).labels(&["By slope", "By hand"]);
const WEIGHT: Control = Control::new("Weight", TurbulenceSettings::WEIGHT).slider(0.0, 10.0);
const SLOPE: Control = Control::new("Slope", TurbulenceSettings::SLOPE).slider(-4.0, 2.0);
const RATE: Control = Control::new("Rate", TurbulenceSettings::RATE).slider(0.0, 20.0);
const SEED: Control = Control::new("Swirl seed", TurbulenceSettings::SEED).slider(0.0, 100.0);

/// The settings of this part.
pub(super) const CONTROLS: &[Control] = &[ON, STRENGTH, GRIDS, CELLS, SHARES, WEIGHT, SLOPE, RATE, SEED];

/// The switch, and the values where it is on.
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
            if i == 0 && before.len() < TurbulenceSettings::MOST_GRIDS && add_button(ui, "Add a swirl grid") {
                let [coarsest, finest] = CELLS.setting.range.map(|cells| cells as u32);
                let twice = before.iter().max().map_or(CELLS.setting.value(), |cells| cells * 2);
                // Beyond the finest grid: the coarsest that is not there yet.
                let free = (coarsest..=finest).find(|cells| !before.contains(cells)).unwrap_or(coarsest);
                settings.grids.push(if twice <= finest { twice } else { free });
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

/// Equal weights in place of weights that are all 0, which the core refuses.
fn no_nothing(weights: &mut [f32]) {
    if weights.iter().all(|weight| *weight == 0.0) {
        weights.fill(1.0);
    }
}
