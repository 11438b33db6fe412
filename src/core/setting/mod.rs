//! Settings: place, range, default, unit and help of each value that an artist decides on, in one constant.
//!
//! Checks, defaults, the JSON schema, the editor's controls and the README's table are all made from these constants.
//! They stand with the types that hold the values (see `settings!`); [`crate::project::settings`] lists all of them.

pub mod format;
pub mod schema;
pub mod value;

use value::{Number, Value};

use crate::{Error, Result};

/// The type of a setting's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Real,
    /// A whole number, or several.
    Whole,
    /// Several real numbers, such as a position.
    Vector,
    /// Linear Rec.709.
    Colour,
    /// On or off.
    Switch,
    /// One of a few.
    Choice,
    /// Text.
    Text,
    /// A list, a file, or a part with settings of its own.
    Part,
}

/// One of the values of a [`Kind::Choice`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Its name in project files; empty where it stands for a part that is absent or present.
    pub value: &'static str,
    /// What it does.
    pub help: &'static str,
}

/// The description of one value of a project.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Path in a project, such as `flow.gamma`. `[]` stands for any element of a list, `[spot]` for one of that type,
    /// `NAME` for any name.
    pub place: &'static str,
    /// What it does to the picture, and when to change it.
    pub help: &'static str,
    /// Unit; empty for a plain number.
    pub unit: &'static str,
    /// The type of its value.
    pub kind: Kind,
    /// Smallest and largest value, of each component.
    pub range: [f64; 2],
    /// Whether the range excludes its smallest value.
    pub above: bool,
    /// Default: one number for each component, 1 or 0 for on or off, 0 for the first choice; empty for none.
    pub default: &'static [f64],
    /// All choices; the first is the default, where there is one.
    pub choices: &'static [Choice],
}

/// The range of a value that may be any finite number.
pub const ANY: [f64; 2] = [f32::MIN as f64, f32::MAX as f64];

impl Setting {
    const fn new(kind: Kind, place: &'static str, range: [f64; 2], default: &'static [f64]) -> Self {
        Self { place, help: "", unit: "", kind, range, above: false, default, choices: &[] }
    }

    /// A number.
    pub const fn real(place: &'static str, range: [f64; 2], default: &'static [f64]) -> Self {
        Self::new(Kind::Real, place, range, default)
    }

    /// A whole number.
    pub const fn whole(place: &'static str, range: [f64; 2], default: &'static [f64]) -> Self {
        Self::new(Kind::Whole, place, range, default)
    }

    /// Several numbers of one range.
    pub const fn vector(place: &'static str, range: [f64; 2], default: &'static [f64]) -> Self {
        Self::new(Kind::Vector, place, range, default)
    }

    /// A colour, linear Rec.709.
    pub const fn colour(place: &'static str, range: [f64; 2], default: &'static [f64]) -> Self {
        Self::new(Kind::Colour, place, range, default)
    }

    /// On or off.
    pub const fn switch(place: &'static str, default: bool) -> Self {
        Self::new(Kind::Switch, place, [0.0, 1.0], if default { &[1.0] } else { &[0.0] })
    }

    /// One of a few, the default first.
    pub const fn choice(place: &'static str, choices: &'static [Choice]) -> Self {
        Self { choices, ..Self::new(Kind::Choice, place, [0.0; 2], &[0.0]) }
    }

    /// Without a default: a project has to give it.
    pub const fn required(mut self) -> Self {
        self.default = &[];
        self
    }

    /// Text.
    pub const fn text(place: &'static str) -> Self {
        Self::new(Kind::Text, place, [0.0; 2], &[])
    }

    /// A list, a file, or a part with settings of its own.
    pub const fn part(place: &'static str) -> Self {
        Self::new(Kind::Part, place, [0.0; 2], &[])
    }

    /// With this unit.
    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    /// Without the smallest value of the range itself.
    pub const fn above(mut self) -> Self {
        self.above = true;
        self
    }

    /// With this help.
    pub const fn help(mut self, help: &'static str) -> Self {
        self.help = help.trim_ascii();
        self
    }

    /// The name in project files: the last part of its place.
    pub fn name(&self) -> &'static str {
        self.place.rsplit('.').next().unwrap_or(self.place)
    }

    /// The default, as the type that holds it: all zero or absent where there is none.
    pub fn value<V: Value>(&self) -> V {
        V::from_numbers(self.default)
    }

    /// The default of a switch.
    pub fn is_on(&self) -> bool {
        self.default == [1.0]
    }

    /// The nearest value that is allowed; NaN becomes the lowest.
    pub fn clamped(&self, value: f32) -> f32 {
        let [low, high] = self.range.map(|end| end as f32);
        if value.is_nan() { low } else { value.clamp(low, high) }
    }

    /// Refuses a value out of range; `parent` is the path of what holds it, such as `flow`.
    ///
    /// # Errors
    /// `Value` names the place, the value and the range.
    pub fn check(&self, value: impl Value, parent: &str) -> Result<()> {
        self.check_at(value, || format!("{parent}.{}", self.name()))
    }

    /// As [`Self::check`], with the complete path of the value.
    ///
    /// # Errors
    /// `Value` names the place, the value and the range.
    pub fn check_at<V: Value>(&self, value: V, place: impl FnOnce() -> String) -> Result<()> {
        // The ends as the value's own type has them: 0.1 is another number in 32 bits than in 64.
        let [low, high] = self.range.map(V::Number::from_f64);
        let is_in = |number: f64| {
            let (low, high) = (low.to_f64(), high.to_f64());
            low <= number && number <= high && !(self.above && number == low)
        };
        let Some(wrong) = value.numbers().iter().find(|number| !is_in(number.to_f64())) else {
            return Ok(());
        };
        let range =
            if self.above { format!("above {low}, at most {high}") } else { format!("{low} to {high}") };
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        Err(Error::value(place(), format!("is {wrong}, must be {range}{unit}")))
    }

    /// "0 to 10", without unit; the values of a choice; empty where there is no range.
    pub fn range_in_words(&self) -> String {
        let number = |value| format::number(value, self.kind == Kind::Whole);
        match self.kind {
            Kind::Real | Kind::Whole | Kind::Vector | Kind::Colour if self.range == ANY => "any".to_owned(),
            Kind::Real | Kind::Whole | Kind::Vector | Kind::Colour => {
                let [low, high] = self.range.map(number);
                format!("{}{low} to {high}", if self.above { "above " } else { "" })
            }
            Kind::Switch => "true, false".to_owned(),
            Kind::Choice => {
                let values = self.choices.iter().map(|choice| choice.value);
                values.filter(|value| !value.is_empty()).collect::<Vec<_>>().join(", ")
            }
            Kind::Text | Kind::Part => String::new(),
        }
    }

    /// "0.5", "0, 1, 0", "true", "smooth"; empty for none.
    pub fn default_in_words(&self) -> String {
        match self.kind {
            Kind::Switch => self.is_on().to_string(),
            Kind::Choice => {
                let default = self.choices.first().filter(|_| !self.default.is_empty());
                default.map_or("", |choice| choice.value).to_owned()
            }
            _ => {
                let number = |&value: &f64| format::number(value, self.kind == Kind::Whole);
                self.default.iter().map(number).collect::<Vec<_>>().join(", ")
            }
        }
    }

    /// "0 to 10 m, default 1."; empty where there is neither range nor default.
    pub fn in_words(&self) -> String {
        let (range, default) = (self.range_in_words(), self.default_in_words());
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let range = if matches!(self.kind, Kind::Switch | Kind::Choice) { String::new() } else { range };
        match (range.is_empty(), default.is_empty()) {
            (true, true) => String::new(),
            (true, false) => format!("Default {default}."),
            (false, true) => format!("{range}{unit}."),
            (false, false) => format!("{range}{unit}, default {default}."),
        }
    }
}

/// Settings as associated constants of the type that holds their values, and the list `SETTINGS` of them. The docstring
/// of each constant is its help.
macro_rules! settings {
    ($type:ty { $($(#[doc = $help:literal])+ $name:ident = $setting:expr;)+ }) => {
        impl $type {
            $($(#[doc = $help])+ pub const $name: $crate::setting::Setting =
                $setting.help(concat!($($help),+));)+

            /// The settings of this type.
            pub const SETTINGS: &'static [$crate::setting::Setting] = &[$(Self::$name),+];
        }
    };
}
pub(crate) use settings;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_names_place_value_range_and_unit() {
        let width = Setting::real("a.width", [0.0, 0.1], &[0.05]).above().unit("m");
        assert!(width.check(0.1_f32, "a").is_ok() && width.check(Some(0.1_f32), "a").is_ok());
        assert!(width.check(None::<f32>, "a").is_ok() && width.check(f32::NAN, "a").is_err());
        let refused = width.check([0.05_f32, 0.0], "b").map_err(|error| error.to_string());
        assert_eq!(refused, Err("b.width: is 0, must be above 0, at most 0.1 m".to_owned()));
    }

    #[test]
    fn words_leave_out_what_a_setting_has_not() {
        assert_eq!(Setting::real("a", [0.0, 1.0], &[]).unit("m").in_words(), "0 to 1 m.");
        assert_eq!(Setting::switch("a", true).in_words(), "Default true.");
        assert_eq!(Setting::text("a").in_words(), "");
    }
}
