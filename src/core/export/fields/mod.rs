//! `fields.npz`: the fitted fields of an animation, for other programs and to be read back.
//!
//! | array | shape | content |
//! |---|---|---|
//! | `psi_S`, `phi_S` | fits, N + 3, M + 3 | coefficients for M x N cells: u = J grad psi + grad phi |
//! | `times_S` | fits | when each was fitted, 0 to 1 |
//! | `grid`, `extent` | 2 | M and N; size of the plane |
//! | `noise_S_C` | fits, rows, columns | psi of the turbulence at these times, C square cells along the longer side; the last may reach beyond the plane |
//! | `steps_S` | 2 | time steps of the photons; of these for each fit |
//! | `mean_straight_S` | 1 | mean length of the photons' ways, the unit of the speed limit |
//! | `fade_smooth_S` | 3 | start, end and limit of the smooth fade |
//! | `fade_paper_S` | 1 | tau of the paper's fade, in its place |
//! | `meeting_S` | 2 | in place of the four above where both key frames flow to a meeting at t = 1/2: time steps, mean way |
//! | `turbulence_S` | 3 | key noises per unit of t, number of the segment, root mean square speed |
//! | `noise_keys_S_C` | keys, rows, columns | psi of the key noises, the first being the last before the segment begins |
//!
//! S is the segment's number from 0, for a caustic with a flow of its own followed by `_` and the caustic's number in the
//! project: `psi_0_2`.
//!
//! Walls are not in the file. Fields that were fitted between walls are read back without them: they carry photons along
//! the fields and straight to their targets, not around the walls.

mod read;

use std::io::{self, Write};
use std::path::Path;

pub use self::read::load_fields;
use crate::Result;
use crate::files::npz::NpzWriter;
use crate::files::write_atomic;
use crate::flow::field::Field;
use crate::flow::meeting::MeetingFields;
use crate::flow::{Fade, Fields, SegmentFlow};

/// The fields of one segment of the animation, owned or borrowed.
pub struct SegmentFields<F = SegmentFlow> {
    /// The segment, from 0.
    pub segment: usize,
    /// The caustic whose own flow this is, by its number in the project; none for the flow that the others share.
    pub caustic: Option<usize>,
    /// The flow; one of closed-form paths has no fields.
    pub flow: F,
}

impl<F> SegmentFields<F> {
    /// The end of the names of its arrays.
    fn suffix(&self) -> String {
        let segment = self.segment;
        self.caustic.map_or_else(|| segment.to_string(), |caustic| format!("{segment}_{caustic}"))
    }
}

/// Writes `fields.npz`, whole or not at all. Flows without a fit are left out.
///
/// # Errors
/// `Io`.
pub fn write_fields(path: &Path, segments: &[SegmentFields<&SegmentFlow>]) -> Result<()> {
    let fitted = || segments.iter().filter(|segment| !nodes(segment.flow).is_empty());
    write_atomic(path, |file| {
        let mut npz = NpzWriter::new(file);
        for (i, segment) in fitted().enumerate() {
            let nodes = nodes(segment.flow);
            write_potentials(&mut npz, &segment.suffix(), &nodes, segment.flow)?;
            if i == 0 {
                let grid = nodes[0].1.grid();
                npz.array("grid", &[2], grid.cells.map(|n| n as f32))?;
                npz.array("extent", &[2], grid.extent.to_array())?;
            }
        }
        for segment in fitted() {
            write_motion(&mut npz, &segment.suffix(), segment.flow)?;
        }
        npz.finish()
    })
}

/// The fields of a flow with their times.
fn nodes(flow: &SegmentFlow) -> Vec<(f64, &Field)> {
    match flow {
        SegmentFlow::Fields(fields) => {
            fields.nodes().iter().enumerate().map(|(n, field)| (fields.node_time(n), field)).collect()
        }
        SegmentFlow::Meeting(fields) => fields.nodes().collect(),
        SegmentFlow::Paths => Vec::new(),
    }
}

/// Writes the fields and the turbulence at the times of the fits.
fn write_potentials<W: Write>(
    npz: &mut NpzWriter<W>,
    suffix: &str,
    nodes: &[(f64, &Field)],
    flow: &SegmentFlow,
) -> io::Result<()> {
    let psi = nodes.iter().map(|(_, field)| field.potentials().0).collect();
    array_of_grids(npz, &format!("psi_{suffix}"), nodes[0].1, psi)?;
    let phi = nodes.iter().map(|(_, field)| field.potentials().1).collect();
    array_of_grids(npz, &format!("phi_{suffix}"), nodes[0].1, phi)?;
    let noise = |t: f64| flow.turbulence().map_or_else(Vec::new, |turbulence| turbulence.at(t));
    let noises: Vec<Vec<Field>> = nodes.iter().map(|&(t, _)| noise(t)).collect();
    write_noises(npz, &format!("noise_{suffix}"), &noises)?;
    let times = nodes.iter().map(|&(t, _)| t as f32);
    npz.array(&format!("times_{suffix}"), &[nodes.len() as u64], times)
}

/// Writes what else moves the photons.
fn write_motion<W: Write>(npz: &mut NpzWriter<W>, suffix: &str, flow: &SegmentFlow) -> io::Result<()> {
    match flow {
        SegmentFlow::Fields(fields) => write_guided(npz, suffix, fields)?,
        SegmentFlow::Meeting(fields) => write_meeting(npz, suffix, fields)?,
        SegmentFlow::Paths => {}
    }
    let Some(turbulence) = flow.turbulence() else { return Ok(()) };
    let numbers = [turbulence.rate(), turbulence.segment() as f32, turbulence.speed()];
    npz.array(&format!("turbulence_{suffix}"), &[3], numbers)?;
    write_noises(npz, &format!("noise_keys_{suffix}"), turbulence.keys())
}

fn write_guided<W: Write>(npz: &mut NpzWriter<W>, suffix: &str, fields: &Fields) -> io::Result<()> {
    let mut numbers = |name: &str, numbers: &[f32]| {
        npz.array(&format!("{name}_{suffix}"), &[numbers.len() as u64], numbers.iter().copied())
    };
    numbers("steps", &[fields.steps(), fields.substeps()].map(|n| n as f32))?;
    numbers("mean_straight", &[fields.mean_straight()])?;
    match fields.fade() {
        Fade::Smooth { start, end, limit } => numbers("fade_smooth", &[start, end, limit]),
        Fade::Paper { tau } => numbers("fade_paper", &[tau]),
    }
}

fn write_meeting<W: Write>(npz: &mut NpzWriter<W>, suffix: &str, fields: &MeetingFields) -> io::Result<()> {
    npz.array(&format!("meeting_{suffix}"), &[3], [fields.steps() as f32, fields.mean_way(), fields.hold()])
}

/// Writes noises of several times, one array for each grid.
fn write_noises<W: Write>(npz: &mut NpzWriter<W>, name: &str, noises: &[Vec<Field>]) -> io::Result<()> {
    for (k, noise) in noises.first().into_iter().flatten().enumerate() {
        let cells = noise.grid().cells.into_iter().max().unwrap_or_default();
        let psi = noises.iter().map(|noise| noise[k].potentials().0).collect();
        array_of_grids(npz, &format!("{name}_{cells}"), noise, psi)?;
    }
    Ok(())
}

/// Writes the coefficients of one potential at several times; all have the grid of `field`.
fn array_of_grids<W: Write>(
    npz: &mut NpzWriter<W>,
    name: &str,
    field: &Field,
    coefficients: Vec<Vec<f32>>,
) -> io::Result<()> {
    let [columns, rows] = field.grid().nodes().map(|n| n as u64);
    npz.array(name, &[coefficients.len() as u64, rows, columns], coefficients.into_iter().flatten())
}
