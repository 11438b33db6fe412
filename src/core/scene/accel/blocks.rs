//! A binary tree of boxes by obvhs, block by block: boxes that are near each other in Morton order make trees of their own,
//! and the roots of these are the boxes of the next level.
//!
//! PLOC takes as many rounds as there are boxes where each box wants only the one before it, such as in a fan; in blocks the
//! time stays in proportion to the number of boxes. Blocks are built in parallel, cut the same way on any number of threads.

use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::morton::morton_encode_u64_unorm;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use rayon::prelude::*;

use crate::{Progress, Result};

/// Boxes of a block.
const BLOCK: usize = 256;

/// The tree over at least one box; its leaves hold one each.
///
/// # Errors
/// `Cancelled`.
pub(super) fn tree(boxes: &[Aabb], progress: &Progress) -> Result<Bvh2> {
    if boxes.len() <= BLOCK {
        return Ok(block(boxes, (0..boxes.len() as u32).collect()));
    }
    let order = morton_order(boxes);
    let build = |block_of: &[u32]| {
        progress.check()?;
        let own: Vec<Aabb> = block_of.iter().map(|i| boxes[*i as usize]).collect();
        let mut tree = block(&own, (0..own.len() as u32).collect());
        tree.primitive_indices.iter_mut().for_each(|i| *i = block_of[*i as usize]);
        Ok(tree)
    };
    let blocks: Vec<Bvh2> = order.par_chunks(BLOCK).map(build).collect::<Result<_>>()?;
    let roots: Vec<Aabb> = blocks.iter().map(|block| *block.nodes[0].aabb()).collect();
    Ok(join(tree(&roots, progress)?, &blocks))
}

fn block(boxes: &[Aabb], indices: Vec<u32>) -> Bvh2 {
    PlocBuilder::new().build(PlocSearchDistance::High, boxes, indices, SortPrecision::U64, 0)
}

/// The boxes along a space-filling curve through their centres.
fn morton_order(boxes: &[Aabb]) -> Vec<u32> {
    let (lower, upper) = boxes
        .par_iter()
        .map(|b| (b.min, b.max))
        .reduce(|| (Vec3A::INFINITY, Vec3A::NEG_INFINITY), |a, b| (a.0.min(b.0), a.1.max(b.1)));
    let (lower, upper) = (lower.as_dvec3(), upper.as_dvec3());
    let scale = 1.0 / (upper - lower).max(DVec3::splat(f64::MIN_POSITIVE));
    let code = |(i, b): (usize, &Aabb)| {
        let centre = (b.min.as_dvec3() + b.max.as_dvec3()) * 0.5;
        (
            morton_encode_u64_unorm(((centre - lower) * scale).clamp(DVec3::ZERO, DVec3::splat(1.0 - 1e-9))),
            i as u32,
        )
    };
    let mut codes: Vec<(u64, u32)> = boxes.par_iter().enumerate().map(code).collect();
    codes.par_sort_unstable();
    codes.into_iter().map(|(_, i)| i).collect()
}

/// The tree `top` with a block in place of each leaf.
fn join(mut top: Bvh2, blocks: &[Bvh2]) -> Bvh2 {
    let leaves: Vec<usize> = (0..top.nodes.len()).filter(|i| top.nodes[*i].is_leaf()).collect();
    let numbers = std::mem::take(&mut top.primitive_indices);
    for leaf in leaves {
        let block = &blocks[numbers[top.nodes[leaf].first_index as usize] as usize];
        // Pairs of children stand at odd numbers, also after the root of the block has gone to the leaf's place.
        let (nodes, boxes) = (top.nodes.len() as u32 - 1, top.primitive_indices.len() as u32);
        let moved = block.nodes.iter().map(|node| {
            let mut node = *node;
            node.first_index += if node.is_leaf() { boxes } else { nodes };
            node
        });
        let mut moved = moved;
        if let Some(root) = moved.next() {
            top.nodes[leaf] = root;
        }
        top.nodes.extend(moved);
        top.primitive_indices.extend(&block.primitive_indices);
    }
    top
}
