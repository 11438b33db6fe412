//! gamma from 0 to 1 over alpha from rough to stiff, both potentials at once: the condition of the system.
//!
//! The fitter takes gamma in double precision, of which 1e-12 beside 1 would be lost in the project's single precision.

use glam::Vec2;

use super::super::Size;
use super::super::case::{Bound, Case, Measured};
use super::super::walk::{Walk, limits};
use super::Group;
use lightloom_core::flow::field::Grid;
use lightloom_core::flow::fit::{Blend, FitSettings, Fitter};
use lightloom_core::{Progress, Result};

pub(super) const GROUP: Group = Group { name: "gamma and alpha", cases };

const GAMMAS: [f64; 7] = [0.0, 1e-12, 1e-6, 0.5, 1.0 - 1e-6, 1.0 - 1e-12, 1.0];
const ALPHAS: [f64; 5] = [1e-12, 1e-6, 1e-3, 1.0, 1e6];
/// To which the prototypes of the solver were measured; a thousand times closer than a project asks for.
const TOLERANCE: f64 = 1e-8;
const WHY: &str = "scaled unknowns keep the system well posed at every gamma, and multigrid its condition at every alpha; \
                   the fit starts from nothing";

fn cases(size: Size) -> Vec<Case> {
    let pairs = GAMMAS.into_iter().flat_map(|gamma| ALPHAS.map(|alpha| (gamma, alpha)));
    pairs.map(|(gamma, alpha)| case(size, gamma, alpha)).collect()
}

fn case(size: Size, gamma: f64, alpha: f64) -> Case {
    let mut walk = Walk::new(size);
    walk.settings.gamma = gamma as f32;
    walk.settings.alpha = alpha as f32;
    walk.settings.steps = size.pick(2, 4);
    let mut limits = limits(&walk.settings, WHY);
    limits.solver_residual = Some(TOLERANCE);
    limits.energy = Some(1.0 + TOLERANCE);
    let name = format!("gamma {}, alpha {alpha:e}", near_one(gamma));
    Case::new(name, Bound::Holds(limits), move |progress| run(&walk, gamma, alpha, progress))
}

fn near_one(gamma: f64) -> String {
    if gamma > 0.5 && gamma < 1.0 { format!("1 - {:.0e}", 1.0 - gamma) } else { format!("{gamma:e}") }
}

/// The numbers of the solver are those of one fit in double precision; where the photons end, those of a few steps.
fn run(walk: &Walk, gamma: f64, alpha: f64, progress: &Progress) -> Result<Measured> {
    let walked = walk.run(progress)?;
    let settings = FitSettings {
        grid: Grid { cells: walk.settings.grid.cells(walk.extent).map(|n| n as usize), extent: walk.extent },
        gamma,
        alpha,
        blend: Blend::Joint,
        tolerance: TOLERANCE,
        max_iterations: 500,
    };
    let straight: Vec<Vec2> = walk.source.iter().zip(&walk.target).map(|(a, b)| *b - *a).collect();
    let (field, fit) = Fitter::new(settings)?.fit(&walk.source, &straight, progress)?;
    Ok(Measured {
        solver_residual: Some(fit.residual),
        iterations: Some(fit.iterations),
        condition: Some(fit.condition),
        energy: Some(lightloom_core::flow::metric::fit_residual(&field, &walk.source, &straight)),
        ..walked
    })
}
