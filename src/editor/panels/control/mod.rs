//! Controls: the widgets that show a setting, and what they need beyond its description in the core.

pub(super) mod choice;
mod colour;
pub(super) mod number;
pub(super) mod row;
pub(super) mod text;

use lightloom_core::setting::{Kind, Setting};

use super::pictures::Trio;

/// A setting in a panel.
#[derive(Clone, Copy, Debug)]
pub struct Control {
    /// Its name in the panel.
    pub label: &'static str,
    /// Place, range, default, unit and help.
    pub setting: Setting,
    /// Names of the choices, in the order of the setting's.
    pub labels: &'static [&'static str],
    /// Pictures of a low, a middle and a high value.
    pub pictures: Option<&'static Trio>,
    /// Ends of the slider, where most of the range is of no use.
    pub slider: [f64; 2],
    /// Whether the slider is logarithmic.
    pub logarithmic: bool,
    /// Whether the unit stands behind the number.
    pub suffix: bool,
}

impl Control {
    /// A control with a linear slider over the whole range.
    pub const fn new(label: &'static str, setting: Setting) -> Self {
        let (slider, suffix) = (setting.range, matches!(setting.kind, Kind::Real | Kind::Whole));
        Self { label, setting, labels: &[], pictures: None, slider, logarithmic: false, suffix }
    }

    /// With these names of the choices.
    pub const fn labels(mut self, labels: &'static [&'static str]) -> Self {
        self.labels = labels;
        self
    }

    /// With a slider over a part of the range.
    pub const fn slider(mut self, low: f64, high: f64) -> Self {
        self.slider = [low, high];
        self
    }

    /// With a logarithmic slider over a part of the range.
    pub const fn log_slider(mut self, low: f64, high: f64) -> Self {
        self.logarithmic = true;
        self.slider(low, high)
    }

    /// Without the unit behind the number.
    pub const fn without_suffix(mut self) -> Self {
        self.suffix = false;
        self
    }

    /// With pictures of a low, a middle and a high value.
    pub const fn pictures(mut self, pictures: &'static Trio) -> Self {
        self.pictures = Some(pictures);
        self
    }

    /// The value nearest to `value` that the core accepts.
    pub fn clamp(&self, value: f64) -> f64 {
        let [low, high] = self.setting.range;
        let low = if self.setting.above { low.max(f64::from(f32::MIN_POSITIVE)) } else { low };
        if value.is_nan() { low } else { value.clamp(low, high) }
    }
}
