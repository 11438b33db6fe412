//! The nodes of a grid at which photons, lines and walls outweigh the bending by far.
//!
//! With both potentials such rows ask for du/dz* alone, whose kernel are all harmonic conjugates: fields of any shape that
//! only the bending tells apart, and that reach furthest at the rim of the stiff region. No smoother scaled by the stiff
//! diagonal sees them, so that these nodes are solved exactly, on each grid, before and after the smoothing.

use super::direct::Direct;
use super::dissection::Dissection;
use super::normal_blocks::{NormalBlocks, Weights};
use super::null_space::NullSpace;
use super::vector::Layout;

/// Stiffness from which a node is solved exactly.
const STIFF: f64 = 30.0;
/// Most numbers of a factor (128 MiB), and most nodes for which they are counted; beyond, only the stiffer nodes are taken.
const MOST_NUMBERS: usize = 1 << 24;
const MOST_NODES: usize = 1 << 15;

/// The exact solver of the stiff nodes of a grid; none where there are none.
pub(super) fn stiff_nodes(
    (layout, cell): (Layout, [f64; 2]),
    blocks: &NormalBlocks,
    weights: Weights,
    null: &NullSpace,
) -> Option<Direct> {
    let ([nx, ny], components) = (layout.nodes, null.components());
    let all = (0..ny).flat_map(|y| (0..nx).map(move |x| [x, y]));
    let mut nodes: Vec<([usize; 2], f64)> =
        all.map(|at| (at, blocks.stiffness(weights, components, at))).collect();
    let mut limit = STIFF;
    loop {
        nodes.retain(|(_, stiffness)| *stiffness > limit);
        limit *= 10.0;
        if nodes.is_empty() {
            return None;
        }
        if nodes.len() > MOST_NODES {
            continue;
        }
        let dissection = Dissection::new(nodes.iter().map(|(at, _)| *at).collect(), layout.nodes);
        if dissection.numbers(components) <= MOST_NUMBERS {
            let whole = nodes.len() == nx * ny;
            let null = if whole { null.vectors(layout, cell) } else { Vec::new() };
            return Some(Direct::new(dissection, components, (blocks, weights), &null));
        }
    }
}
