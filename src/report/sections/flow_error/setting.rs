//! The parameters that decide the accuracy of a flow.

use glam::Vec2;

use lightloom_core::flow::{FlowSettings, GridSize};

/// The parameters that decide the accuracy of a flow; all others decide which flow it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Setting {
    /// Time steps of the segment.
    pub(super) steps: u32,
    /// Cells of the field along x and y.
    pub(super) cells: [u32; 2],
    /// Guide photons.
    pub(super) guides: u32,
    /// Error of the velocities at which the solver stops.
    pub(super) tolerance: f32,
}

/// The factors by which the reference of a project is finer than the project.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Refinement {
    pub(super) steps: u32,
    /// Along each side.
    pub(super) cells: u32,
    /// Limited by the number of photons.
    pub(super) guides: u32,
    /// Largest number of guides of the project.
    pub(super) most_guides: usize,
}

/// One of the parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Parameter {
    Steps,
    Grid,
    Guides,
    Tolerance,
}

/// Residual of the reference: a thousandth of the default, whose error is hardly visible.
const EXACT: f32 = 1e-7;
/// Factors on the project's steps and cells, and on its guides.
const FACTORS: [f64; 5] = [0.125, 0.25, 0.5, 1.0, 2.0];
const FEWER: [f64; 4] = [1.0 / 64.0, 1.0 / 16.0, 0.25, 1.0];
/// Tolerances coarser than the default.
const TOLERANCES: [f32; 3] = [1e-1, 1e-2, 1e-3];
/// Fewest cells along a side of a field.
const FEWEST_CELLS: u32 = 8;

impl Setting {
    /// The setting of a project on a plane of this extent, with at most `most_guides` guides.
    pub(super) fn of(settings: &FlowSettings, extent: Vec2, most_guides: usize) -> Self {
        let guides = settings.guides.min(u32::try_from(most_guides).unwrap_or(u32::MAX));
        let cells = settings.grid.cells(extent);
        Self { steps: settings.steps, cells, guides, tolerance: settings.tolerance }
    }

    /// The setting of the reference; `photons` is the number of photons.
    pub(super) fn reference(self, finer: Refinement, photons: usize) -> Self {
        let photons = u32::try_from(photons).unwrap_or(u32::MAX);
        Self {
            steps: self.steps.saturating_mul(finer.steps),
            cells: self.cells.map(|cells| cells.saturating_mul(finer.cells)),
            guides: self.guides.saturating_mul(finer.guides).min(photons),
            tolerance: EXACT.min(self.tolerance),
        }
    }

    /// The setting with half the steps and cells, which gives an estimate of the error of a reference.
    pub(super) fn half(self) -> Self {
        let cells = self.cells.map(|cells| (cells / 2).max(FEWEST_CELLS));
        Self { steps: (self.steps / 2).max(1), cells, tolerance: 100.0 * self.tolerance, ..self }
    }

    /// The setting with one parameter of another.
    pub(super) fn with(self, parameter: Parameter, other: &Self) -> Self {
        match parameter {
            Parameter::Steps => Self { steps: other.steps, ..self },
            Parameter::Grid => Self { cells: other.cells, ..self },
            Parameter::Guides => Self { guides: other.guides, ..self },
            Parameter::Tolerance => Self { tolerance: other.tolerance, ..self },
        }
    }

    /// The settings of a project with these parameters.
    pub(super) fn apply(self, settings: &FlowSettings) -> FlowSettings {
        let Self { steps, cells, guides, tolerance } = self;
        FlowSettings { steps, grid: GridSize::Both(cells), guides, tolerance, ..settings.clone() }
    }

    /// Estimated work, in arbitrary units.
    pub(super) fn work(&self) -> u64 {
        let [x, y] = self.cells.map(u64::from);
        u64::from(self.steps) * (x * y + u64::from(self.guides))
    }

    /// The setting in words.
    pub(super) fn describe(&self) -> String {
        let Self { steps, cells: [x, y], guides, tolerance } = self;
        format!("{steps} steps, {x} x {y} cells, {guides} guide photons, tolerance {tolerance:e}")
    }
}

impl Parameter {
    pub(super) const ALL: [Self; 4] = [Self::Steps, Self::Grid, Self::Guides, Self::Tolerance];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Steps => "steps",
            Self::Grid => "grid",
            Self::Guides => "guides",
            Self::Tolerance => "tolerance",
        }
    }

    /// The value in a setting; of the grid the cells along the longer side.
    pub(super) fn of(self, setting: &Setting) -> f64 {
        match self {
            Self::Steps => setting.steps.into(),
            Self::Grid => setting.cells[0].max(setting.cells[1]).into(),
            Self::Guides => setting.guides.into(),
            Self::Tolerance => setting.tolerance.into(),
        }
    }

    /// Whether it is finer in `a` than in `b`.
    fn is_finer(self, a: &Setting, b: &Setting) -> bool {
        match self {
            Self::Tolerance => a.tolerance < b.tolerance,
            _ => self.of(a) > self.of(b),
        }
    }

    /// The project's `own` setting with this parameter from coarse to the value of `reference`.
    pub(super) fn sweep(self, own: Setting, reference: &Setting) -> Vec<Setting> {
        let scaled = |value: u32, factor: f64, least: u32| {
            // Saturates; what is too large is finer than the reference and goes again.
            ((f64::from(value) * factor).round() as u32).max(least)
        };
        let mut sweep: Vec<Setting> = match self {
            Self::Steps => {
                FACTORS.map(|factor| Setting { steps: scaled(own.steps, factor, 1), ..own }).to_vec()
            }
            Self::Grid => FACTORS
                .map(|factor| own.cells.map(|cells| scaled(cells, factor, FEWEST_CELLS)))
                .map(|cells| Setting { cells, ..own })
                .to_vec(),
            Self::Guides => {
                FEWER.map(|factor| Setting { guides: scaled(own.guides, factor, 1), ..own }).to_vec()
            }
            Self::Tolerance => (TOLERANCES.into_iter().filter(|tolerance| *tolerance > own.tolerance))
                .chain([own.tolerance])
                .map(|tolerance| Setting { tolerance, ..own })
                .collect(),
        };
        sweep.retain(|setting| self.is_finer(reference, setting) || *setting == own);
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
            let reference =
                own.reference(Refinement { steps: 3, cells: 2, guides: 4, most_guides: usize::MAX }, photons);
            for parameter in Parameter::ALL {
                let sweep = parameter.sweep(own, &reference);
                assert!(sweep.windows(2).all(|pair| parameter.is_finer(&pair[1], &pair[0])), "{sweep:?}");
                assert!(sweep.contains(&own));
                assert_eq!(sweep.last(), Some(&own.with(parameter, &reference)));
                // Nothing else is turned.
                assert!(sweep.iter().all(|setting| setting.with(parameter, &own) == own));
            }
        }
    }
}
