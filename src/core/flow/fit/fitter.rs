//! The solver of Eq. (7), step by step.

use glam::Vec2;

use super::assembly::Assembly;
use super::rows::{NoPenetrationRows, Rows};
use super::settings::{Blend, FitSettings};
use super::system::{System, Unknown};
use crate::flow::field::Field;
use crate::math::cg::{ConjugateGradients, LinearSystem, Solved};
use crate::math::multigrid::Multigrid;
use crate::math::operator::Operator;
use crate::math::vector::{GridVector, HALO};
use crate::{Error, Progress, Result};

/// Statistics of a fit.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct FitReport {
    /// Iterations of conjugate gradients, of the longer solve where there are two.
    pub iterations: usize,
    /// Error of the velocities that the solver leaves, over the root mean square of those wanted of the photons.
    pub error: f64,
    /// Unknowns solved for.
    pub unknowns: usize,
    /// A lower bound of the preconditioned matrix's condition number; 0 without iterations.
    pub condition: f64,
}

/// The solver of Eq. (7) for consecutive steps: keeps its storage, and starts from its last solution.
pub struct Fitter {
    settings: FitSettings,
    assembly: Assembly,
    operator: Operator<f64>,
    multigrid: Multigrid,
    solver: ConjugateGradients,
    right: GridVector<f64>,
    systems: Vec<System>,
    walls: WallPoints,
    /// Whether the last fit had directed lines.
    with_lines: bool,
    /// Whether stiff nodes are solved exactly, without lines and with them: once a solve took long without.
    exact: [bool; 2],
}

/// Iterations after which stiff nodes are solved exactly from then on. Where there are none, 3 to 10 bring four digits.
const PATIENCE: usize = 16;

/// Directed lines in a fit, Term (6).
#[derive(Clone, Copy)]
pub struct LineTerm<'a> {
    /// The rows of D: velocities that each line asks for.
    pub rows: &'a [Rows<'a>],
    /// Weight of the solution with lines at each node, 0 to 1, (N+3) rows of M+3 from y = 0 upwards: where it is 0, the
    /// field is as without them.
    pub mask: &'a [f64],
}

/// The points on walls of the isotropic half of N^T N.
#[derive(Default)]
struct WallPoints {
    positions: Vec<Vec2>,
    weight: f64,
}

impl Fitter {
    /// Checks the settings and allocates the storage.
    ///
    /// # Errors
    /// `Value` for a setting out of range.
    pub fn new(settings: FitSettings) -> Result<Self> {
        let settings = settings.checked()?;
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
            walls: WallPoints::default(),
            with_lines: false,
            exact: [false; 2],
        })
    }

    /// Sets the no-penetration term of all further fits, weight/2 sum (n.u)^2.
    pub fn set_no_penetration(&mut self, walls: Option<NoPenetrationRows>) {
        self.assembly.set_no_penetration(walls);
        self.walls = walls.map_or_else(WallPoints::default, |walls| WallPoints {
            positions: walls.positions.to_vec(),
            weight: walls.weight,
        });
    }

    /// Fits the field to a wanted velocity at each position, both in plane units.
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

    /// As [`Self::fit`], with directed lines.
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
        lines: Option<LineTerm>,
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
        lines: Option<LineTerm>,
        progress: &Progress,
    ) -> Result<(Field, FitReport)> {
        self.assembly.clear();
        self.assembly.add(photons);
        self.add_walls();
        self.with_lines = lines.is_some();
        let mut energy = mean_square(photons.velocities);
        let mut report = self.solve(0, energy, progress)?;
        if let Some(lines) = lines {
            let [nx, ny] = self.settings.grid.nodes();
            assert_eq!(lines.mask.len(), nx * ny, "one value for each node");
            lines.rows.iter().for_each(|&rows| self.assembly.add(rows));
            if energy == 0.0 {
                energy = lines.rows.iter().map(|rows| mean_square(rows.velocities)).fold(0.0, f64::max);
            }
            report = report.worst(self.solve(1, energy, progress)?);
            self.systems.iter_mut().for_each(|system| system.blend(lines.mask));
        }
        Ok((self.field(), report))
    }

    /// Solves all systems for the sums of the assembly, without lines (`which` is 0) or with them (1). `energy` is the mean
    /// square of the photons' velocities.
    fn solve(&mut self, which: usize, energy: f64, progress: &Progress) -> Result<FitReport> {
        let mut report = FitReport { iterations: 0, error: 0.0, unknowns: 0, condition: 0.0 };
        for i in 0..self.systems.len() {
            progress.check()?;
            // Where psi and phi are fitted apart, both have the same matrix but for walls.
            if i == 0 || self.assembly.blocks.no_penetration.is_some() {
                self.operator.set(&self.assembly.blocks, self.systems[i].weights);
                self.multigrid.set(&self.assembly.blocks, self.systems[i].weights, self.exact[which]);
            }
            let system = &mut self.systems[i];
            system.set_right(&self.settings, &self.assembly.right, &mut self.right);
            let null = std::mem::take(&mut system.null_vectors);
            let solved = self.improve((i, which), energy, &null, progress);
            let system = &mut self.systems[i];
            let solution = if which == 0 { &mut system.solution } else { system.with_lines() };
            let finished = solved.and_then(|solved| finish(solution, &null, solved));
            system.null_vectors = null;
            let Solved { iterations, error } = finished?;
            let [nx, ny] = self.settings.grid.nodes();
            let unknowns = report.unknowns + system.solution.components * nx * ny;
            let condition = self.solver.condition().unwrap_or_default();
            report = report.worst(FitReport { iterations, error, unknowns, condition });
        }
        Ok(report)
    }

    /// Solves system `i` from its last solution.
    fn improve(
        &mut self,
        (i, which): (usize, usize),
        energy: f64,
        null: &[GridVector<f64>],
        progress: &Progress,
    ) -> Result<Solved> {
        let FitSettings { tolerance, max_iterations, .. } = self.settings;
        let mut made = 0;
        loop {
            let exact = self.exact[which];
            let limit = if exact { max_iterations - made } else { max_iterations.min(PATIENCE) };
            let linear = LinearSystem {
                operator: &self.operator,
                preconditioner: &mut self.multigrid,
                null,
                right: &self.right,
                energy,
            };
            let system = &mut self.systems[i];
            let solution = if which == 0 { &mut system.solution } else { system.with_lines() };
            let solved = self.solver.solve(linear, solution, (tolerance, limit), progress)?;
            made += solved.iterations;
            if exact || solved.error <= tolerance || made >= max_iterations {
                return Ok(Solved { iterations: made, ..solved });
            }
            self.exact[which] = true;
            self.multigrid.set(&self.assembly.blocks, self.systems[i].weights, true);
        }
    }

    /// Adds the isotropic half of N^T N.
    fn add_walls(&mut self) {
        let WallPoints { positions, weight, .. } = &self.walls;
        if !positions.is_empty() {
            let still = vec![Vec2::ZERO; positions.len()];
            self.assembly.add(Rows { positions, velocities: &still, weight: 0.5 * weight });
        }
    }

    /// Forgets the last solution: the next fit starts from zero.
    pub fn reset(&mut self) {
        self.exact = [false; 2];
        for system in &mut self.systems {
            system.solution.clear();
            system.with_lines = None;
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
            let shown = match &system.with_lines {
                Some([_, blended]) if self.with_lines => blended,
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

impl FitReport {
    /// The worse of two solves; the unknowns of the larger.
    pub(in crate::flow) fn worst(self, other: Self) -> Self {
        Self {
            iterations: self.iterations.max(other.iterations),
            error: self.error.max(other.error),
            unknowns: self.unknowns.max(other.unknowns),
            condition: self.condition.max(other.condition),
        }
    }
}

/// Takes the null space out of the solution, and refuses one that is not finite.
fn finish(solution: &mut GridVector<f64>, null: &[GridVector<f64>], solved: Solved) -> Result<Solved> {
    solution.remove(null);
    if solved.error.is_finite() && solution.dot(solution).is_finite() {
        return Ok(solved);
    }
    solution.clear();
    let what = format!("no solution after {} iterations; choose a larger alpha", solved.iterations);
    Err(Error::Numeric { stage: "fit", what })
}

/// Mean of |v|^2.
fn mean_square(velocities: &[Vec2]) -> f64 {
    let sum: f64 = velocities.iter().map(|v| f64::from(v.x).powi(2) + f64::from(v.y).powi(2)).sum();
    sum / velocities.len().max(1) as f64
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
