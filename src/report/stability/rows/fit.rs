//! gamma from 0 to 1 over alpha from rough to stiff, both potentials at once: the condition of the system.

use super::row::Expected::Holds;
use super::row::Row;
use crate::effort::Effort;
use crate::stability::fit_case::FitCase;

const GAMMAS: [f64; 7] = [0.0, 1e-12, 1e-6, 0.5, 1.0 - 1e-6, 1.0 - 1e-12, 1.0];
const ALPHAS: [f64; 5] = [1e-12, 1e-6, 1e-3, 1.0, 1e6];
const WHY: &str = "scaled unknowns keep the system well posed at every gamma, and multigrid its condition at every alpha; \
                   the fit starts from nothing";

pub(super) fn gamma_and_alpha(_: Effort) -> Vec<Row> {
    let row = |gamma: f64, alpha: f64| {
        let name = format!("gamma {}, alpha {alpha:e}", near_one(gamma));
        Row::new(name, Holds(WHY), move |effort| FitCase::new(gamma, alpha, effort))
    };
    GAMMAS.into_iter().flat_map(|gamma| ALPHAS.map(|alpha| row(gamma, alpha))).collect()
}

fn near_one(gamma: f64) -> String {
    if gamma > 0.5 && gamma < 1.0 { format!("1 - {:.0e}", 1.0 - gamma) } else { format!("{gamma:e}") }
}
