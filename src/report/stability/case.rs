//! A case: an extreme input, its bound, and what was measured.

use serde::Serialize;

use lightloom_core::{Error, Progress, Result};

/// An input that can be run.
pub(super) trait Input {
    /// The limits that any input of this kind must hold.
    fn limits(&self) -> Limits;

    /// The check of the project format, where there are settings to check.
    ///
    /// # Errors
    /// The first value that is out of range.
    fn check(&self) -> Result<()> {
        Ok(())
    }

    /// Runs it.
    ///
    /// # Errors
    /// Anything that cannot be computed; cancelled.
    fn run(&self, progress: &Progress) -> Result<Measured>;
}

/// An extreme input with its bound, which is stated before the run.
pub(super) struct Case {
    pub(super) name: String,
    pub(super) bound: Bound,
    pub(super) run: Run,
}

/// Runs a case.
pub(super) type Run = Box<dyn Fn(&Progress) -> Result<Measured>>;

impl Case {
    pub(super) fn new(
        name: impl Into<String>,
        bound: Bound,
        run: impl Fn(&Progress) -> Result<Measured> + 'static,
    ) -> Self {
        Self { name: name.into(), bound, run: Box::new(run) }
    }
}

/// The bound of a row. All its numbers must be finite besides.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// The row must come through, within these limits.
    Holds(Limits),
    /// The row must be refused by an error whose message contains these words.
    Refused {
        /// Part of the message: the place of the value, or what is wrong.
        words: &'static str,
        /// The reason why it cannot be computed.
        why: &'static str,
    },
}

/// Limits of a row that must come through; a number without a limit is only shown.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Limits {
    /// Largest distance of a photon from its target at the end, plane units.
    pub endpoint_error: Option<f64>,
    /// Largest error of the velocities that the solver leaves, relative.
    pub solver_error: Option<f64>,
    /// Most iterations of a solve.
    pub iterations: Option<usize>,
    /// Largest [`Measured::energy`].
    pub energy: Option<f64>,
    /// Most photons through a wall that a path leads around.
    pub crossings: Option<usize>,
    /// Least and most photons whose target no path reaches.
    pub unreachable: Option<[usize; 2]>,
    /// Largest share of the light that the plan misplaces.
    pub misplaced: Option<f64>,
    /// Largest gap at the meeting, plane units.
    pub gap: Option<f64>,
    /// The reason for these limits.
    pub why: &'static str,
}

impl Limits {
    /// No limit; all numbers must be finite.
    pub(super) const FINITE: Self = Self {
        endpoint_error: None,
        solver_error: None,
        iterations: None,
        energy: None,
        crossings: None,
        unreachable: None,
        misplaced: None,
        gap: None,
        why: "",
    };
}

/// Numbers measured in one row.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Measured {
    /// Whether every position, speed and pixel was finite.
    pub finite: bool,
    /// max |c(1) - b|, plane units.
    pub endpoint_error: Option<f64>,
    /// Error of the velocities that the solver leaves, relative; the worst.
    pub solver_error: Option<f64>,
    /// Iterations of the solver, the most in a fit.
    pub iterations: Option<usize>,
    /// Condition number of the preconditioned matrix as the solver saw it.
    pub condition: Option<f64>,
    /// Misfit or relative error of the energy; [`Self::energy_of`] says which.
    pub energy: Option<f64>,
    /// The quantity that [`Self::energy`] is.
    pub energy_of: EnergyOf,
    /// Photons that crossed a wall though a path leads around it.
    pub crossings: Option<usize>,
    /// Photons whose target no path around the walls reaches.
    pub unreachable: Option<usize>,
    /// Share of the light that the plan misplaces.
    pub misplaced: Option<f64>,
    /// Root mean square distance at which photons of both keys miss each other where they meet, plane units.
    pub gap: Option<f64>,
}

/// The quantity measured as energy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EnergyOf {
    /// None.
    #[default]
    None,
    /// |u - v| / |v| at the photons: the share of the fitted energy that the field leaves.
    Misfit,
    /// Relative error of the flux: of the traced light over all its ends, of the photons over time, in the texture.
    Flux,
    /// Relative difference of the flux that lands from that of the same scene in metres.
    Scale,
}

impl EnergyOf {
    /// Its name in the table.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Misfit => "misfit",
            Self::Flux => "flux",
            Self::Scale => "against 1 m",
        }
    }
}

impl Measured {
    /// Whether all numbers that are present are finite.
    fn is_finite(&self) -> bool {
        let numbers =
            [self.endpoint_error, self.solver_error, self.condition, self.energy, self.misplaced, self.gap];
        self.finite && numbers.into_iter().flatten().all(f64::is_finite)
    }
}

impl Bound {
    /// The parts of the bound that do not hold, in words; empty when all do.
    ///
    /// # Errors
    /// `Cancelled`, which is no outcome.
    pub(super) fn missed(&self, outcome: &Result<Measured>) -> Result<Vec<String>> {
        Ok(match (self, outcome) {
            (_, Err(Error::Cancelled)) => return Err(Error::Cancelled),
            (Self::Refused { words, .. }, Err(error)) if error.to_string().contains(words) => Vec::new(),
            (Self::Refused { words, .. }, Err(error)) => vec![format!("'{error}' does not name {words}")],
            (Self::Refused { .. }, Ok(_)) => vec!["it was not refused".to_owned()],
            (Self::Holds(_), Err(error)) => vec![error.to_string()],
            (Self::Holds(limits), Ok(measured)) => limits.missed(measured),
        })
    }

    /// The bound in words, with its reason.
    pub(super) fn to_text(&self) -> String {
        match self {
            Self::Refused { words, why } => format!("refused, naming '{words}': {why}"),
            Self::Holds(limits) => limits.to_text(),
        }
    }
}

impl Limits {
    /// The upper limits with their names, each beside the number that it bounds.
    fn upper(&self, measured: &Measured) -> [(&'static str, Option<f64>, Option<f64>); 7] {
        let count = |count: Option<usize>| count.map(|n| n as f64);
        [
            ("endpoint error", self.endpoint_error, measured.endpoint_error),
            ("solver error", self.solver_error, measured.solver_error),
            ("iterations", count(self.iterations), count(measured.iterations)),
            ("energy", self.energy, measured.energy),
            ("crossings", count(self.crossings), count(measured.crossings)),
            ("misplaced", self.misplaced, measured.misplaced),
            ("gap", self.gap, measured.gap),
        ]
    }

    fn missed(&self, measured: &Measured) -> Vec<String> {
        let mut missed = Vec::new();
        if !measured.is_finite() {
            missed.push("not all is finite".to_owned());
        }
        for (name, limit, value) in self.upper(measured) {
            if let (Some(value), Some(limit)) = (value, limit)
                && (value > limit || value.is_nan())
            {
                missed.push(format!("{name} {value:.3e} > {limit:e}"));
            }
        }
        if let (Some(count), Some([least, most])) = (measured.unreachable, self.unreachable)
            && !(least..=most).contains(&count)
        {
            missed.push(format!("{count} photons unreachable, not {least} to {most}"));
        }
        missed
    }

    fn to_text(&self) -> String {
        let mut limits = vec!["finite".to_owned()];
        for (name, limit, _) in self.upper(&Measured::default()) {
            limits.extend(limit.map(|limit| match name {
                "iterations" | "crossings" => format!("{name} <= {limit}"),
                _ => format!("{name} <= {limit:e}"),
            }));
        }
        limits.extend(self.unreachable.map(|[least, most]| format!("unreachable {least} to {most}")));
        let limits = limits.join(", ");
        if self.why.is_empty() { limits } else { format!("{limits}: {}", self.why) }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn nan_misses_the_bound_and_so_does_an_input_that_is_not_refused() {
        let limits = Limits { energy: Some(1.0), ..Limits::FINITE };
        let holds = Bound::Holds(limits);
        let given = |energy| Ok(Measured { finite: true, energy: Some(energy), ..Measured::default() });
        assert!(holds.missed(&given(1.0)).unwrap().is_empty());
        assert_eq!(holds.missed(&given(1.5)).unwrap().len(), 1);
        assert_eq!(holds.missed(&given(f64::NAN)).unwrap().len(), 2);
        let refused = Bound::Refused { words: "flow.alpha", why: "" };
        assert_eq!(refused.missed(&given(1.0)).unwrap().len(), 1);
        assert!(refused.missed(&Err(Error::value("flow.alpha", "is 0"))).unwrap().is_empty());
        assert_eq!(refused.missed(&Err(Error::value("flow.beta", "is 0"))).unwrap().len(), 1);
        assert!(matches!(refused.missed(&Err(Error::Cancelled)), Err(Error::Cancelled)));
    }
}
