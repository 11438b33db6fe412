//! What is varied: the settings that buy accuracy of a flow.

use glam::Vec2;

use crate::flow::{FlowSettings, GridSize};

/// The settings that decide how exactly a flow is worked out; all others decide which flow it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Setting {
    /// Time steps of the segment.
    pub(super) steps: u32,
    /// Cells of the field along x and y.
    pub(super) cells: [u32; 2],
    /// Photons fitted to.
    pub(super) guides: u32,
    /// Relative residual at which the solver stops.
    pub(super) tolerance: f32,
}

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Knob {
    Steps,
    Grid,
    Guides,
    Tolerance,
}

/// Residual that the reference is solved to.
const EXACT: f32 = 1e-10;
/// How much finer the reference is than the project.
const FINER_STEPS: u32 = 4;
const FINER_CELLS: u32 = 2;
/// Fewest cells along a side that a field can have.
const FEWEST_CELLS: u32 = 8;

impl Setting {
    /// As a project has it, on a plane of this extent and with so many photons to fit to.
    pub(super) fn of(settings: &FlowSettings, extent: Vec2, photons: usize) -> Self {
        let guides = settings.guides.min(u32::try_from(photons).unwrap_or(u32::MAX));
        let cells = settings.grid.cells(extent);
        Self { steps: settings.steps, cells, guides, tolerance: settings.tolerance }
    }

    /// Finer than all that is measured.
    pub(super) fn reference(self, photons: usize) -> Self {
        Self {
            steps: FINER_STEPS * self.steps,
            cells: self.cells.map(|cells| FINER_CELLS * cells),
            guides: u32::try_from(photons).unwrap_or(u32::MAX),
            tolerance: EXACT.min(self.tolerance),
        }
    }

    /// Half as fine in all but the photons: what a reference is compared with to learn its own error.
    pub(super) fn half(self) -> Self {
        let cells = self.cells.map(|cells| (cells / 2).max(FEWEST_CELLS));
        Self { steps: (self.steps / 2).max(1), cells, tolerance: 100.0 * self.tolerance, ..self }
    }

    /// With one knob as another setting has it.
    pub(super) fn with(self, knob: Knob, other: &Self) -> Self {
        match knob {
            Knob::Steps => Self { steps: other.steps, ..self },
            Knob::Grid => Self { cells: other.cells, ..self },
            Knob::Guides => Self { guides: other.guides, ..self },
            Knob::Tolerance => Self { tolerance: other.tolerance, ..self },
        }
    }

    /// A project's settings with these in place of its own.
    pub(super) fn apply(self, settings: &FlowSettings) -> FlowSettings {
        let Self { steps, cells, guides, tolerance } = self;
        FlowSettings { steps, grid: GridSize::Both(cells), guides, tolerance, ..settings.clone() }
    }

    /// About how long it takes, in any unit.
    pub(super) fn work(&self) -> u64 {
        let [x, y] = self.cells.map(u64::from);
        u64::from(self.steps) * (x * y + u64::from(self.guides))
    }

    /// For people.
    pub(super) fn describe(&self) -> String {
        let Self { steps, cells: [x, y], guides, tolerance } = self;
        format!("{steps} steps, {x} x {y} cells, {guides} guide photons, tolerance {tolerance:.0e}")
    }
}

impl Knob {
    pub(super) const ALL: [Self; 4] = [Self::Steps, Self::Grid, Self::Guides, Self::Tolerance];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Steps => "steps",
            Self::Grid => "grid",
            Self::Guides => "guides",
            Self::Tolerance => "tolerance",
        }
    }

    /// Where a setting has it; of the grid the cells along the longer side.
    pub(super) fn of(self, setting: &Setting) -> f64 {
        match self {
            Self::Steps => setting.steps.into(),
            Self::Grid => setting.cells[0].max(setting.cells[1]).into(),
            Self::Guides => setting.guides.into(),
            Self::Tolerance => setting.tolerance.into(),
        }
    }

    /// The project's `own` setting with this knob turned from coarse to as fine as `reference` has it.
    pub(super) fn sweep(self, own: Setting, reference: &Setting) -> Vec<Setting> {
        let scaled = |value: u32, factor: f64, least: u32| ((f64::from(value) * factor) as u32).max(least);
        let mut sweep: Vec<Setting> = match self {
            Self::Steps => [0.125, 0.25, 0.5, 1.0, 2.0]
                .map(|factor| Setting { steps: scaled(own.steps, factor, 1), ..own })
                .to_vec(),
            Self::Grid => [0.125, 0.25, 0.5, 1.0]
                .map(|factor| own.cells.map(|cells| scaled(cells, factor, FEWEST_CELLS)))
                .map(|cells| Setting { cells, ..own })
                .to_vec(),
            Self::Guides => [1.0 / 64.0, 1.0 / 16.0, 0.25, 1.0]
                .map(|factor| Setting { guides: scaled(own.guides, factor, 1), ..own })
                .to_vec(),
            Self::Tolerance => [1e3, 1e2, 10.0, 1.0, 1e-2]
                .map(|factor| (own.tolerance * factor).clamp(reference.tolerance, 0.1))
                .map(|tolerance| Setting { tolerance, ..own })
                .to_vec(),
        };
        sweep.push(own.with(self, reference));
        sweep.dedup();
        sweep
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_gets_finer_holds_the_own_setting_and_ends_at_the_reference() {
        let settings = FlowSettings::default();
        let small = FlowSettings { steps: 1, grid: GridSize::Longer(8), guides: 3, ..settings.clone() };
        for (settings, photons) in [(settings, 1_000_000), (small, 2)] {
            let own = Setting::of(&settings, Vec2::new(1.0, 0.8), photons);
            let reference = own.reference(photons);
            for knob in Knob::ALL {
                let sweep = knob.sweep(own, &reference);
                let finer = |pair: &[Setting]| match knob {
                    Knob::Tolerance => pair[0].tolerance > pair[1].tolerance,
                    _ => knob.of(&pair[0]) < knob.of(&pair[1]),
                };
                assert!(sweep.windows(2).all(finer), "{sweep:?}");
                assert!(sweep.contains(&own));
                assert_eq!(sweep.last(), Some(&own.with(knob, &reference)));
                // Nothing else is turned.
                assert!(sweep.iter().all(|setting| setting.with(knob, &own) == own));
            }
        }
    }
}
