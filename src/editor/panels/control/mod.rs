//! Settings: one description for each value an artist decides on, and the widgets that show it.
//!
//! The description says all that the window knows of a value: what it is called, where it stands in the project, its unit,
//! its range, its default, and what it does to the picture. Ranges and defaults are those of the core
//! (`tests/panels.rs` holds them together).

mod choice;
mod colour;
mod format;
mod number;
mod row;
mod text;

pub use choice::Choice;
pub(super) use choice::presets;
pub use format::number as format_number;
pub(super) use number::ends;
pub(super) use row::NAMES;
pub(super) use text::field as words_field;

use super::pictures::Trio;

/// What kind of value it is, and so by which widget it is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Real,
    /// A whole number.
    Whole,
    /// Several numbers, such as a place.
    Vector,
    /// Linear Rec.709.
    Colour,
    /// Yes or no.
    Switch,
    /// One of a few.
    Choice,
    /// Words.
    Text,
    /// Several values in a list, or a part with settings of its own; its panel has the widgets.
    Part,
}

/// A value that an artist decides on.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// What the window calls it.
    pub name: &'static str,
    /// Where it stands in a project, such as `flow.gamma`; `[]` for any element of a list, `[spot]` for one of this type.
    pub place: &'static str,
    /// Its unit; empty for a plain number.
    pub unit: &'static str,
    /// What it does to the picture, and when to touch it.
    pub help: &'static str,
    /// Pictures of a low, a middle and a high value.
    pub pictures: Option<&'static Trio>,
    /// What kind of value it is.
    pub kind: Kind,
    /// Smallest and largest value.
    pub range: [f64; 2],
    /// Whether the smallest value itself is left out.
    pub above: bool,
    /// Ends of the slider, where most of the range is of no use.
    pub slider: [f64; 2],
    /// Whether the slider goes by factors.
    pub logarithmic: bool,
    /// The default: a number, one for each component, 1 or 0 for yes or no; empty for none.
    pub default: &'static [f64],
    /// What can be chosen, the default first.
    pub options: &'static [Choice],
}

impl Setting {
    const fn new(kind: Kind, name: &'static str, place: &'static str) -> Self {
        Self {
            name,
            place,
            unit: "",
            help: "",
            pictures: None,
            kind,
            range: [0.0; 2],
            above: false,
            slider: [0.0; 2],
            logarithmic: false,
            default: &[],
            options: &[],
        }
    }

    const fn within(mut self, range: [f64; 2], default: &'static [f64]) -> Self {
        self.range = range;
        self.slider = range;
        self.default = default;
        self
    }

    /// A number; an empty default is none.
    pub const fn real(
        name: &'static str,
        place: &'static str,
        range: [f64; 2],
        default: &'static [f64],
    ) -> Self {
        Self::new(Kind::Real, name, place).within(range, default)
    }

    /// A whole number.
    pub const fn whole(
        name: &'static str,
        place: &'static str,
        range: [f64; 2],
        default: &'static [f64],
    ) -> Self {
        Self::new(Kind::Whole, name, place).within(range, default)
    }

    /// Several numbers of one range.
    pub const fn vector(
        name: &'static str,
        place: &'static str,
        range: [f64; 2],
        default: &'static [f64],
    ) -> Self {
        Self::new(Kind::Vector, name, place).within(range, default)
    }

    /// A colour, linear Rec.709.
    pub const fn colour(
        name: &'static str,
        place: &'static str,
        range: [f64; 2],
        default: &'static [f64],
    ) -> Self {
        Self::new(Kind::Colour, name, place).within(range, default)
    }

    /// Yes or no.
    pub const fn switch(name: &'static str, place: &'static str, default: bool) -> Self {
        Self::new(Kind::Switch, name, place).within([0.0, 1.0], if default { &[1.0] } else { &[0.0] })
    }

    /// One of a few, the default first.
    pub const fn choice(name: &'static str, place: &'static str, options: &'static [Choice]) -> Self {
        let mut setting = Self::new(Kind::Choice, name, place);
        setting.options = options;
        setting
    }

    /// Words.
    pub const fn text(name: &'static str, place: &'static str) -> Self {
        Self::new(Kind::Text, name, place)
    }

    /// A list, or a part with settings of its own.
    pub const fn part(name: &'static str, place: &'static str) -> Self {
        Self::new(Kind::Part, name, place)
    }

    /// With this unit.
    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    /// With a slider over a part of the range.
    pub const fn slider(mut self, low: f64, high: f64) -> Self {
        self.slider = [low, high];
        self
    }

    /// With a slider that goes by factors.
    pub const fn logarithmic(mut self) -> Self {
        self.logarithmic = true;
        self
    }

    /// Without the smallest value of the range itself.
    pub const fn above(mut self) -> Self {
        self.above = true;
        self
    }

    /// With these words on what it does to the picture.
    pub const fn help(mut self, help: &'static str) -> Self {
        self.help = help;
        self
    }

    /// With pictures of a low, a middle and a high value.
    pub const fn pictures(mut self, pictures: &'static Trio) -> Self {
        self.pictures = Some(pictures);
        self
    }

    /// The value nearest to `value` that the core takes.
    pub fn clamp(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        let low = if self.above { low.max(f64::from(f32::MIN_POSITIVE)) } else { low };
        if value.is_nan() { low } else { value.clamp(low, high) }
    }

    /// "0 to 1, default 0.5", with its unit.
    pub fn in_words(&self) -> String {
        let number = |value: f64| format::number(value, self.kind == Kind::Whole);
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let default = match self.kind {
            Kind::Switch => if self.default == [1.0] { "on" } else { "off" }.to_owned(),
            Kind::Choice => {
                self.options.first().map_or_else(String::new, |choice| choice.name.to_lowercase())
            }
            _ => self.default.iter().map(|&value| number(value)).collect::<Vec<_>>().join(", "),
        };
        let default = if default.is_empty() { "none".to_owned() } else { default };
        match self.kind {
            Kind::Text | Kind::Part => String::new(),
            Kind::Switch | Kind::Choice => format!("Default {default}"),
            _ => {
                let from = if self.above { "Above " } else { "" };
                let [low, high] = self.range.map(number);
                format!("{from}{low} to {high}{unit}, default {default}")
            }
        }
    }
}
