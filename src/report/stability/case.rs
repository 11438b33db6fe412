//! One row before it is run, what it must hold, and what was measured.

use serde::Serialize;

use lightloom_core::{Error, Progress, Result};

/// One extreme input with the bound it must hold, stated before it is run.
pub(super) struct Case {
    /// What is extreme about it.
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

/// What a row must hold. All numbers that it gives must be finite besides.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// It must come through, within these limits.
    Holds(Limits),
    /// It must be refused by an error whose message has these words in it.
    Refused {
        /// Part of the message: the place of the value, or what is wrong.
        words: &'static str,
        /// Why it cannot be computed.
        why: &'static str,
    },
}

/// Limits of a row that must come through. A number without limit is only shown.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Limits {
    /// Largest distance of a photon from its target at the end, plane units.
    pub endpoint_error: Option<f64>,
    /// Largest relative residual of the solver.
    pub solver_residual: Option<f64>,
    /// Most iterations of a solve.
    pub iterations: Option<usize>,
    /// Largest [`Measured::energy`].
    pub energy: Option<f64>,
    /// Most photons through a wall that a way leads around.
    pub crossings: Option<usize>,
    /// Least and most photons that no way reaches.
    pub unreachable: Option<[usize; 2]>,
    /// Why these limits.
    pub why: &'static str,
}

impl Limits {
    /// None but that all numbers are finite.
    pub(super) const FINITE: Self = Self {
        endpoint_error: None,
        solver_residual: None,
        iterations: None,
        energy: None,
        crossings: None,
        unreachable: None,
        why: "",
    };
}

/// What a row gave.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Measured {
    /// Whether every position, speed and pixel was finite.
    pub finite: bool,
    /// max |c(1) - b|, plane units.
    pub endpoint_error: Option<f64>,
    /// Relative residual of the solver, the worst.
    pub solver_residual: Option<f64>,
    /// Iterations of the solver, the most in a fit.
    pub iterations: Option<usize>,
    /// Condition number of the preconditioned matrix as the solver saw it.
    pub condition: Option<f64>,
    /// How well energy is kept; [`Self::energy_of`] says which.
    pub energy: Option<f64>,
    /// What [`Self::energy`] is.
    pub energy_of: EnergyOf,
    /// Photons that crossed a wall though a way leads around it.
    pub crossings: Option<usize>,
    /// Photons that no way around the walls reaches.
    pub unreachable: Option<usize>,
}

/// Which energy is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EnergyOf {
    /// None.
    #[default]
    None,
    /// |u - v| over |v| at the photons: what the fitted field leaves of the energy that it minimises.
    Misfit,
    /// Relative error of the flux: of the traced light over all its ends, of the photons over time, in the texture.
    Flux,
    /// Relative difference of the flux that lands from that of the same scene in metres.
    Scale,
}

impl EnergyOf {
    /// A word for it.
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
    /// Whether each number that is there is one.
    fn is_finite(&self) -> bool {
        let numbers = [self.endpoint_error, self.solver_residual, self.condition, self.energy];
        self.finite && numbers.into_iter().flatten().all(f64::is_finite)
    }
}

impl Bound {
    /// What of the bound does not hold, in words; nothing when all does.
    ///
    /// # Errors
    /// `Cancelled`, which is no result.
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

    /// In words, with its reason.
    pub(super) fn to_text(&self) -> String {
        match self {
            Self::Refused { words, why } => format!("refused, naming '{words}': {why}"),
            Self::Holds(limits) => limits.to_text(),
        }
    }
}

impl Limits {
    fn missed(&self, measured: &Measured) -> Vec<String> {
        let mut missed = Vec::new();
        if !measured.is_finite() {
            missed.push("not all is finite".to_owned());
        }
        let mut most = |name: &str, value: Option<f64>, limit: Option<f64>| {
            if let (Some(value), Some(limit)) = (value, limit)
                && (value > limit || value.is_nan())
            {
                missed.push(format!("{name} {value:.3e} > {limit:e}"));
            }
        };
        let count = |count: Option<usize>| count.map(|n| n as f64);
        most("endpoint error", measured.endpoint_error, self.endpoint_error);
        most("residual", measured.solver_residual, self.solver_residual);
        most("iterations", count(measured.iterations), count(self.iterations));
        most("energy", measured.energy, self.energy);
        most("crossings", count(measured.crossings), count(self.crossings));
        if let (Some(shut_off), Some([least, most])) = (measured.unreachable, self.unreachable)
            && !(least..=most).contains(&shut_off)
        {
            missed.push(format!("{shut_off} photons without a way, not {least} to {most}"));
        }
        missed
    }

    fn to_text(&self) -> String {
        let number = |name: &str, limit: Option<f64>| limit.map(|limit| format!("{name} <= {limit:e}"));
        let whole = |name: &str, limit: Option<usize>| limit.map(|limit| format!("{name} <= {limit}"));
        let limits = [
            Some("finite".to_owned()),
            number("endpoint error", self.endpoint_error),
            number("residual", self.solver_residual),
            whole("iterations", self.iterations),
            number("energy", self.energy),
            whole("crossings", self.crossings),
            self.unreachable.map(|[least, most]| format!("without a way {least} to {most}")),
        ];
        let limits = limits.into_iter().flatten().collect::<Vec<_>>().join(", ");
        if self.why.is_empty() { limits } else { format!("{limits}: {}", self.why) }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn what_is_not_a_number_misses_and_so_does_what_is_not_refused() {
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
