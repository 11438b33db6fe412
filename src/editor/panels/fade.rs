//! The fade: the transition from the field to the targets.

use egui::Ui;
use lightloom_core::flow::Fade;

use super::control::Control;
use super::pictures;

const KIND: Control = Control::new("Fade", Fade::KIND).labels(&["Smooth", "Paper"]);
const START: Control = Control::new("Fade from", Fade::START);
const END: Control = Control::new("Fade to", Fade::END);
const LIMIT: Control = Control::new("Speed limit", Fade::LIMIT).log_slider(1.0, 20.0);
const TAU: Control = Control::new("Tau", Fade::TAU).pictures(&pictures::TAU);

/// The settings of this part.
pub(super) const CONTROLS: &[Control] = &[KIND, START, END, LIMIT, TAU];

/// Slightly more than the core requires, so that rounding does no harm.
const APART: f32 = 1.01 * Fade::APART;

/// Kind and values of the fade.
pub(super) fn show(ui: &mut Ui, fade: &mut Fade) {
    let kinds = [Fade::default(), Fade::paper()];
    let now = usize::from(matches!(fade, Fade::Paper { .. }));
    if let Some(new) = KIND.pick(ui, now).and_then(|index| kinds.get(index)) {
        *fade = *new;
    }
    match fade {
        Fade::Smooth { start, end, limit } => {
            if START.number(ui, start) {
                *end = end.max(*start + APART).min(1.0);
            }
            if END.number(ui, end) {
                *end = end.max(APART);
                *start = start.min(*end - APART).max(0.0);
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
