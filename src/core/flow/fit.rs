//! The fit of Eqs. (3)-(7): the field that follows the guidance of the photons and bends as little as it can.
//!
//! The unknowns are psi' = sqrt(1-gamma) psi and phi' = sqrt(gamma) phi. Then u = sqrt(1-gamma) J grad psi' +
//! sqrt(gamma) grad phi', both bend at the price alpha, and the system stays well posed up to gamma = 0 and 1, where
//! one of the two drops out. Its null space (u does not see constants, nor a linear psi whose velocity a linear phi
//! cancels) is left to conjugate gradients, which never go there, and taken out of the result.

use glam::Vec2;

use super::assembly::{Assembly, Rows, WallRows};
use super::bending::bending;
use super::field::{Field, Grid};
use super::local;
use crate::math::cg::{ConjugateGradients, LinearSystem, Solved};
use crate::math::multigrid::Multigrid;
use crate::math::null_space::NullSpace;
use crate::math::operator::{Operator, Weights};
use crate::math::vector::{GridVector, HALO, Layout};
use crate::{Error, Progress, Result};

/// How psi and phi share the velocity.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Blend {
    /// One fit of both, Eq. (7).
    Joint,
    /// Each fitted alone, then u = (1-gamma) u_psi + gamma u_phi: gamma acts evenly over its whole range.
    Separate,
}

/// What is fitted, and how well.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct FitSettings {
    /// The grid of the potentials; 4..=2048 cells along each axis.
    pub grid: Grid,
    /// Share of the irrotational part, 0..=1.
    pub gamma: f64,
    /// Weight of the bending energy, > 0. Features shorter than sqrt(alpha / density) of the plane are smoothed.
    pub alpha: f64,
    /// Joint or separate.
    pub blend: Blend,
    /// Relative residual to stop at.
    pub tolerance: f64,
    /// Iterations after which it stops in any case.
    pub max_iterations: usize,
}

/// How a fit went.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct FitReport {
    /// Iterations of conjugate gradients, of the longer solve where there are two.
    pub iterations: usize,
    /// Relative residual reached, |b - A x| / |b|.
    pub residual: f64,
    /// Unknowns solved for.
    pub unknowns: usize,
    /// Condition number of the preconditioned matrix as far as the iterations saw it, from below; 0 where there was none.
    pub condition: f64,
}

/// A solver for many steps: keeps its storage, and starts from its last solution.
pub struct Fitter {
    settings: FitSettings,
    assembly: Assembly,
    operator: Operator<f64>,
    multigrid: Multigrid,
    solver: ConjugateGradients,
    right: GridVector<f64>,
    systems: Vec<System>,
    walls: Walls,
    /// Whether directed lines had a say in the last fit.
    steered: bool,
}

/// What directed lines ask of a fit, Term (6).
#[derive(Clone, Copy)]
pub struct Steering<'a> {
    /// Velocities that each line asks for.
    pub rows: &'a [Rows<'a>],
    /// How much the lines count at each node, 0 to 1, (N+3) rows of M+3 from y = 0 upwards: where it is 0, the field is as
    /// without them.
    pub mask: &'a [f64],
}

/// Points on walls.
#[derive(Default)]
struct Walls {
    positions: Vec<Vec2>,
    weight: f64,
}

/// One solve: psi' and phi' coupled, or one of the two alone.
struct System {
    unknown: Unknown,
    weights: Weights,
    null: NullSpace,
    null_vectors: Vec<GridVector<f64>>,
    solution: GridVector<f64>,
    /// With directed lines, and both blended.
    steered: Option<[GridVector<f64>; 2]>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Unknown {
    Both,
    Psi,
    Phi,
}

impl Fitter {
    /// Checks the settings and takes the storage.
    ///
    /// # Errors
    /// `Value` for a setting out of range.
    pub fn new(settings: FitSettings) -> Result<Self> {
        check(&settings)?;
        let unknowns: &[Unknown] = match (settings.blend, settings.gamma) {
            (_, 0.0) => &[Unknown::Psi],
            (_, 1.0) => &[Unknown::Phi],
            (Blend::Joint, _) => &[Unknown::Both],
            (Blend::Separate, _) => &[Unknown::Psi, Unknown::Phi],
        };
        let systems: Vec<_> = unknowns.iter().map(|&unknown| System::new(&settings, unknown)).collect();
        let zero = systems[0].solution.clone();
        Ok(Self {
            settings,
            assembly: Assembly::new(settings.grid, zero.components == 2),
            operator: Operator::zero(zero.layout, zero.components),
            multigrid: Multigrid::new(zero.layout, settings.grid.cell_size(), &systems[0].null),
            solver: ConjugateGradients::new(&zero),
            right: zero,
            systems,
            walls: Walls::default(),
            steered: false,
        })
    }

    /// From now on the field shall not cross walls at these points: the term weight/2 sum (n.u)^2.
    pub fn set_walls(&mut self, walls: Option<WallRows>) {
        self.assembly.set_tilt(walls);
        self.walls = walls.map_or_else(Walls::default, |walls| Walls {
            positions: walls.positions.to_vec(),
            weight: walls.weight,
        });
    }

    /// Fits to the velocity wanted at each position, both in plane units.
    ///
    /// # Errors
    /// `Value` when the columns differ in length, `Numeric` for a number that is not finite or a failing solver,
    /// `Cancelled`.
    pub fn fit(
        &mut self,
        positions: &[Vec2],
        velocities: &[Vec2],
        progress: &Progress,
    ) -> Result<(Field, FitReport)> {
        self.fit_with(positions, velocities, None, progress)
    }

    /// As [`Self::fit`], with what directed lines ask for besides.
    ///
    /// # Errors
    /// As [`Self::fit`].
    ///
    /// # Panics
    /// When the mask has not one value for each node.
    pub fn fit_with(
        &mut self,
        positions: &[Vec2],
        velocities: &[Vec2],
        lines: Option<Steering>,
        progress: &Progress,
    ) -> Result<(Field, FitReport)> {
        check_columns(positions, velocities)?;
        for rows in lines.iter().flat_map(|lines| lines.rows) {
            check_columns(rows.positions, rows.velocities)?;
        }
        let photons = Rows { positions, velocities, weight: 1.0 / positions.len().max(1) as f64 };
        // Inside the thread pool the many small parallel loops need not wake it up each time.
        rayon::scope(|_| self.fit_rows(photons, lines, progress))
    }

    fn fit_rows(
        &mut self,
        photons: Rows,
        lines: Option<Steering>,
        progress: &Progress,
    ) -> Result<(Field, FitReport)> {
        self.assembly.clear();
        self.assembly.add(photons);
        self.add_walls();
        self.steered = lines.is_some();
        let mut report = self.solve(|system| &mut system.solution, progress)?;
        if let Some(lines) = lines {
            let [nx, ny] = self.settings.grid.nodes();
            assert_eq!(lines.mask.len(), nx * ny, "one value for each node");
            lines.rows.iter().for_each(|&rows| self.assembly.add(rows));
            report = report.worst(self.solve(System::steered, progress)?);
            self.systems.iter_mut().for_each(|system| system.blend(lines.mask));
        }
        Ok((self.field(), report))
    }

    /// Solves all systems for the sums of the assembly, from what `unknowns` shows and into it.
    fn solve(
        &mut self,
        unknowns: impl Fn(&mut System) -> &mut GridVector<f64>,
        progress: &Progress,
    ) -> Result<FitReport> {
        let mut report = FitReport { iterations: 0, residual: 0.0, unknowns: 0, condition: 0.0 };
        for (i, system) in self.systems.iter_mut().enumerate() {
            progress.check()?;
            // Where psi and phi are fitted apart, both have the same matrix but for walls.
            if i == 0 || self.assembly.parts.tilt.is_some() {
                self.operator.set(&self.assembly.parts, system.weights);
                self.multigrid.set(&self.assembly.parts, system.weights);
            }
            system.set_right(&self.settings, &self.assembly.right, &mut self.right);
            let limits = (self.settings.tolerance, self.settings.max_iterations);
            let null = std::mem::take(&mut system.null_vectors);
            let linear = LinearSystem {
                operator: &self.operator,
                preconditioner: &mut self.multigrid,
                null: &null,
                right: &self.right,
            };
            let solution = unknowns(system);
            let solved = self.solver.solve(linear, solution, limits, progress);
            let finished = solved.and_then(|solved| finish(solution, &null, solved));
            system.null_vectors = null;
            let solved = finished?;
            let [nx, ny] = self.settings.grid.nodes();
            let unknowns = report.unknowns + system.solution.components * nx * ny;
            let condition = self.solver.condition().unwrap_or_default();
            let Solved { iterations, residual } = solved;
            report = report.worst(FitReport { iterations, residual, unknowns, condition });
        }
        Ok(report)
    }

    /// The half of the walls' term that has no direction.
    fn add_walls(&mut self) {
        let Walls { positions, weight, .. } = &self.walls;
        if !positions.is_empty() {
            let still = vec![Vec2::ZERO; positions.len()];
            self.assembly.add(Rows { positions, velocities: &still, weight: 0.5 * weight });
        }
    }

    /// Forgets the last solution: the next fit starts from zero.
    pub fn reset(&mut self) {
        for system in &mut self.systems {
            system.solution.clear();
            system.steered = None;
        }
    }

    /// The field of the solutions, in single precision.
    fn field(&self) -> Field {
        let single = |potential: Vec<f64>| potential.into_iter().map(|c| c as f32).collect::<Vec<_>>();
        let (psi, phi) = self.potentials();
        Field::from_potentials(self.settings.grid, &single(psi), &single(phi))
    }

    /// The coefficients of psi and phi of the last fit, times their weights in u = J grad psi + grad phi, each (N+3)
    /// rows of M+3. A [`Field`] holds them rounded to single precision.
    pub fn potentials(&self) -> (Vec<f64>, Vec<f64>) {
        let FitSettings { grid, gamma, blend, .. } = self.settings;
        let [nx, ny] = grid.nodes();
        let (psi_weight, phi_weight) = match blend {
            Blend::Joint => ((1.0 - gamma).sqrt(), gamma.sqrt()),
            Blend::Separate => (1.0 - gamma, gamma),
        };
        let (mut psi, mut phi) = (vec![0.0; nx * ny], vec![0.0; nx * ny]);
        let copy = |out: &mut [f64], weight: f64, solution: &GridVector<f64>, component: usize| {
            for (y, out) in out.chunks_exact_mut(nx).enumerate() {
                for (out, value) in out.iter_mut().zip(&solution.padded(y + HALO, component)[HALO..]) {
                    *out = weight * value;
                }
            }
        };
        for system in &self.systems {
            let shown = match &system.steered {
                Some([_, blended]) if self.steered => blended,
                _ => &system.solution,
            };
            if system.unknown != Unknown::Phi {
                copy(&mut psi, psi_weight, shown, 0);
            }
            if system.unknown != Unknown::Psi {
                copy(&mut phi, phi_weight, shown, shown.components - 1);
            }
        }
        (psi, phi)
    }
}

impl System {
    fn new(settings: &FitSettings, unknown: Unknown) -> Self {
        let FitSettings { grid, gamma, alpha, .. } = *settings;
        let layout = Layout::new(grid.nodes());
        let (a, b) = ((1.0 - gamma).sqrt(), gamma.sqrt());
        let (weights, null) = if unknown == Unknown::Both {
            // u = a J grad psi' + b grad phi': psi' = b y has the velocity (-a b, 0), phi' = a x has (a b, 0).
            let linear = vec![[[0.0, 0.0, b], [0.0, a, 0.0]], [[0.0, b, 0.0], [0.0, 0.0, -a]]];
            let weights = Weights { psi: 1.0 - gamma, phi: gamma, cross: a * b, smooth: alpha, tilt: -1.0 };
            (weights, NullSpace::new(2, linear))
        } else {
            let tilt = if unknown == Unknown::Psi { -1.0 } else { 1.0 };
            let weights = Weights { psi: 1.0, phi: 0.0, cross: 0.0, smooth: alpha, tilt };
            (weights, NullSpace::new(1, Vec::new()))
        };
        let null_vectors = null.vectors(layout, grid.cell_size());
        let solution = GridVector::zero(layout, null.components());
        Self { unknown, weights, solution, steered: None, null, null_vectors }
    }

    /// The right side, from the sums over the points.
    fn set_right(&self, settings: &FitSettings, sums: &GridVector<f64>, right: &mut GridVector<f64>) {
        let weights = [(1.0 - settings.gamma).sqrt(), settings.gamma.sqrt()];
        let picked: &[(usize, f64)] = match self.unknown {
            Unknown::Both => &[(0, weights[0]), (1, weights[1])],
            Unknown::Psi => &[(0, 1.0)],
            Unknown::Phi => &[(1, 1.0)],
        };
        for (component, &(from, weight)) in picked.iter().enumerate() {
            right.set_component(component, weight, sums, from);
        }
    }

    /// The unknowns with directed lines; at first those without.
    fn steered(&mut self) -> &mut GridVector<f64> {
        let [solution, _] =
            self.steered.get_or_insert_with(|| [self.solution.clone(), self.solution.clone()]);
        solution
    }

    fn blend(&mut self, mask: &[f64]) {
        if let Some([steered, blended]) = &mut self.steered {
            local::blend(&self.solution, steered, mask, &self.null_vectors, blended);
        }
    }
}

impl FitReport {
    /// The worse of two solves; the unknowns of the larger.
    fn worst(self, other: Self) -> Self {
        Self {
            iterations: self.iterations.max(other.iterations),
            residual: self.residual.max(other.residual),
            unknowns: self.unknowns.max(other.unknowns),
            condition: self.condition.max(other.condition),
        }
    }
}

/// Takes the null space out of the solution, and refuses one that is not finite.
fn finish(solution: &mut GridVector<f64>, null: &[GridVector<f64>], solved: Solved) -> Result<Solved> {
    solution.remove(null);
    if solved.residual.is_finite() && solution.dot(solution).is_finite() {
        return Ok(solved);
    }
    solution.clear();
    let what = format!("no solution after {} iterations; choose a larger alpha", solved.iterations);
    Err(Error::Numeric { stage: "fit", what })
}

/// The energy E of a field, Terms (3) to (5): `alpha` and `gamma` of the settings, points and velocities as in a fit.
/// A potential that the settings leave out must be zero; its bending is not counted.
pub fn energy(field: &Field, settings: &FitSettings, positions: &[Vec2], velocities: &[Vec2]) -> f64 {
    let misfit: f64 = (positions.iter().zip(velocities))
        .map(|(&p, &v)| {
            let [ux, uy] = field.velocity_f64([f64::from(p.x), f64::from(p.y)]);
            (ux - f64::from(v.x)).powi(2) + (uy - f64::from(v.y)).powi(2)
        })
        .sum();
    let (psi, phi) = field.potentials();
    let bends = bending(field.grid());
    let layout = Layout::new(field.grid().nodes());
    let bend = |coefficients: &[f32], weight: f64| {
        if weight == 0.0 {
            return 0.0;
        }
        let mut vector = GridVector::<f64>::zero(layout, 1);
        for (i, &value) in coefficients.iter().enumerate() {
            vector.set(0, i % layout.nodes[0], i / layout.nodes[0], f64::from(value));
        }
        // The potentials carry their weight w in u, so w times the bending of psi is 1/w times that of w psi.
        bends.quadratic_form(&vector, 0) / weight
    };
    let bent = bend(&psi, 1.0 - settings.gamma) + bend(&phi, settings.gamma);
    0.5 * misfit / positions.len().max(1) as f64 + 0.5 * settings.alpha * bent
}

fn check(settings: &FitSettings) -> Result<()> {
    let FitSettings { grid, gamma, alpha, tolerance, .. } = *settings;
    if !grid.cells.iter().all(|cells| (4..=2048).contains(cells)) {
        return Err(Error::value("flow.grid", format!("{:?} cells; 4 to 2048 along each axis", grid.cells)));
    }
    let sides = [grid.extent.x, grid.extent.y];
    if !sides.iter().all(|side| side.is_finite() && *side > 0.0) {
        return Err(Error::value("receiver", format!("a rectangle of {sides:?}; both sides must be > 0")));
    }
    if !(0.0..=1.0).contains(&gamma) {
        return Err(Error::value("flow.gamma", format!("{gamma} is not within 0 and 1")));
    }
    if !(alpha.is_finite() && alpha > 0.0) {
        return Err(Error::value("flow.alpha", format!("{alpha} is not a number > 0")));
    }
    if !(tolerance.is_finite() && tolerance > 0.0) {
        return Err(Error::value("flow.tolerance", format!("{tolerance} is not a number > 0")));
    }
    Ok(())
}

fn check_columns(positions: &[Vec2], velocities: &[Vec2]) -> Result<()> {
    if positions.len() != velocities.len() {
        let what = format!("{} velocities for {} positions", velocities.len(), positions.len());
        return Err(Error::value("fit", what));
    }
    for (name, column) in [("position", positions), ("velocity", velocities)] {
        if let Some(i) = column.iter().position(|v| !v.is_finite()) {
            return Err(Error::Numeric {
                stage: "fit",
                what: format!("{name} {i} is {}, not finite", column[i]),
            });
        }
    }
    Ok(())
}
