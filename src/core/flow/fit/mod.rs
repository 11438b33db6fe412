//! The fit of Eqs. (3)-(7): the field that follows the guidance of the photons with least bending.
//!
//! # The energy
//!
//! K photons at c_k with guidance v_k, P samples d_p of directed lines with wanted velocities w_p, and points q_m on walls
//! with unit normals n_m ask for the field u that minimizes
//!
//! ```text
//! E = 1/(2K) sum_k |u(c_k) - v_k|^2                                          Term (3)
//!   + alpha/(2|D|) int psi'_xx^2 + 2 psi'_xy^2 + psi'_yy^2                   Term (4)
//!   + alpha/(2|D|) int phi'_xx^2 + 2 phi'_xy^2 + phi'_yy^2                   Term (5)
//!   + beta/(2P) sum_p |u(d_p) - w_p|^2                                       Term (6)
//!   + omega/2 sum_m (n_m . u(q_m))^2                                         no penetration of walls
//!
//! u = p J grad psi' + q grad phi',   p = sqrt(1-gamma),   q = sqrt(gamma),   J(x, y) = (-y, x)
//! ```
//!
//! The unknowns are psi' = p psi and phi' = q phi. Both bend at the price alpha, and the system stays well posed up to
//! gamma = 0 and 1, where one of the two drops out. The last term is not in the paper.
//!
//! # Eq. (7)
//!
//! With the spline coefficients x = (psi', phi'), dE/dx = 0 are the normal equations
//!
//! ```text
//! (1/K A^T A + alpha B^T B + beta/P D^T D + omega N^T N) x = 1/K A^T a + beta/P D^T d
//! ```
//!
//! A and a have two rows for each photon, D and d two for each line sample, N one for each wall point; B^T B are the
//! bending integrals, exact, over |D| where the paper has finite differences over MN. With g = (g_x, g_y) the
//! gradients of the basis functions at a point, the rows of A and D are (p J g, q g), and
//!
//! ```text
//! A^T A = [ p^2 S,  pq C; -pq C,  q^2 S ]    S = sum g_x g_x^T + g_y g_y^T,   C = sum g_x g_y^T - g_y g_x^T
//! A^T a = ( p sum g_x v_y - g_y v_x,  q sum g_x v_x + g_y v_y )
//! B^T B = [ H, 0; 0, H ]                     H = 1/|D| int b_xx b_xx^T + 2 b_xy b_xy^T + b_yy b_yy^T
//! N^T N = [ p^2 (S/2 - E),  pq (C/2 + Y);  pq (-C/2 + Y),  q^2 (S/2 + E) ]
//!         E = 1/2 sum cos 2t F + sin 2t G,   F = g_x g_x^T - g_y g_y^T,   n = (cos t, sin t)
//!         Y = 1/2 sum sin 2t F - cos 2t G,   G = g_x g_y^T + g_y g_x^T
//! ```
//!
//! D^T D and D^T d are A^T A and A^T a over the line samples and their w. So one [`Assembly`] sums all of them, point by
//! point with the weights 1/K, beta/P and omega/2, into [`NormalBlocks`](crate::math::normal_blocks::NormalBlocks):
//! S is `ata`, C `ata_cross`, H `btb`, E and Y `no_penetration`. The factors p^2, q^2, pq and alpha are
//! [`Weights`](crate::math::normal_blocks::Weights), set in `system.rs` with the right side.
//! [`Operator`](crate::math::operator::Operator) is the sum.
//!
//! [`Blend::Separate`] solves for each potential alone, (S + alpha H) psi = sum g_x v_y - g_y v_x and likewise for phi;
//! then u = (1-gamma) J grad psi + gamma grad phi.
//!
//! The null space (u does not see constants, nor a linear psi whose velocity a linear phi cancels) is left to conjugate
//! gradients, which never enter it, and taken out of the result.
//!
//! # The solver
//!
//! Conjugate gradients stop where the photons' velocities are right, not where the residual is small: beside lines of great
//! weight that says nothing. Multigrid preconditions them. Where lines, walls or photons outweigh the bending by far, it
//! solves their nodes exactly on every grid ([`multigrid`](crate::math::multigrid)); that costs, and so begins once a
//! solve has taken long without. An error above the tolerance is reported, never hidden ([`FitReport::error`]).

mod assembly;
mod bending;
mod cells;
mod element;
mod energy;
mod fitter;
mod line_mask;
mod lines;
mod rows;
mod settings;
mod system;

pub use assembly::Assembly;
pub use bending::bending;
pub use energy::energy;
pub use fitter::{FitReport, Fitter, LineTerm};
pub(super) use lines::DirectedLines;
pub use rows::{NoPenetrationRows, Rows};
pub use settings::{Blend, FitSettings};
