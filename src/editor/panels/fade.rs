//! The fade: how the photons leave the field to arrive.

use egui::Ui;
use lightloom_core::flow::Fade;

use super::setting::{Choice, Setting};

const KIND: Setting = Setting::choice(
    "Fade",
    "flow.fade",
    &[
        Choice::new("smooth", "Smooth", "early and even: no photon has to hurry at the end"),
        Choice::new("paper", "Paper", "the field alone until tau; the last photons snap into place"),
    ],
)
.help("How the light leaves the field to arrive at its target.");
const START: Setting = Setting::real("Fade from", "flow.fade.start", [0.0, 0.99], &[0.3]).help(
    "Until this share of the time the field steers alone. Later keeps the flow longer and arrives faster.",
);
const END: Setting = Setting::real("Fade to", "flow.fade.end", [0.01, 1.0], &[0.9])
    .help("From this share of the time on light goes straight to its target. It comes after the start.");
const LIMIT: Setting = Setting::real("Speed limit", "flow.fade.limit", [1.0, 1000.0], &[3.0])
    .slider(1.0, 20.0)
    .logarithmic()
    .help("Speed at which a photon leaves the field early, in mean straight speeds. Lower it where light darts.");
const TAU: Setting = Setting::real("Tau", "flow.fade.tau", [0.0, 0.99], &[0.85])
    .help("Share of the time after which light is drawn to its target.");

/// The settings of this part.
pub(super) const SETTINGS: &[Setting] = &[KIND, START, END, LIMIT, TAU];

/// Least distance of the two ends of the fade.
const APART: f32 = 0.01;

/// How the photons leave the field.
pub(super) fn show(ui: &mut Ui, fade: &mut Fade) {
    let kinds = [Fade::default(), Fade::Paper { tau: 0.85 }];
    let now = usize::from(matches!(fade, Fade::Paper { .. }));
    if let Some(new) = KIND.pick(ui, now).and_then(|index| kinds.get(index)) {
        *fade = *new;
    }
    match fade {
        Fade::Smooth { start, end, limit } => {
            if START.number(ui, start) {
                *end = end.max(*start + 1.01 * APART).min(1.0);
            }
            if END.number(ui, end) {
                // A hair more than the core asks for, so that rounding does no harm.
                *end = end.max(1.01 * APART);
                *start = start.min(*end - 1.01 * APART).max(0.0);
            }
            LIMIT.number(ui, limit);
        }
        Fade::Paper { tau } => {
            TAU.number(ui, tau);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_kinds_pass_the_core() {
        assert!(Fade::default().check("").is_ok());
        assert!(Fade::Smooth { start: 0.99, end: 1.0, limit: 3.0 }.check("").is_ok());
    }
}
