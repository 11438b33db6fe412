//! The construction of the hierarchy. obvhs makes a binary tree of the boxes (PLOC, Meister & Bittner 2018; see
//! [`blocks`](super::blocks)) and improves it (parallel reinsertion, by the same); [`collapse`](super::collapse) makes nodes of
//! eight of it.
//!
//! Equal boxes are one to the tree: it would chain them.

use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use rayon::prelude::*;

use super::blocks;
use super::collapse::{Hierarchy, collapse};
use super::triangle::Triangle;
use crate::{Progress, Result};

/// Passes of reinsertion. The first tries a share of all nodes, mostly those near the root, and each a smaller one; nodes
/// of large meshes are too many.
const PASSES: i32 = 8;
const FIRST_SHARE: f32 = 0.5;
const DECAY: f32 = 1.3;
const MOST_NODES: f32 = 200_000.0;
/// Depth of the binary tree beyond which nodes are not reinserted; that of common meshes is 25 to 50.
const DEEPEST: usize = 128;

/// The hierarchy over triangles with area. Deterministic.
///
/// # Errors
/// `Cancelled`.
pub(super) fn build(triangles: &[Triangle], progress: &Progress) -> Result<Hierarchy> {
    let boxes: Vec<Aabb> = triangles.par_iter().map(bounds).collect();
    let groups = Groups::new(&boxes);
    progress.check()?;
    let distinct: Vec<Aabb> = groups.first.iter().map(|triangle| boxes[*triangle as usize]).collect();
    let mut tree = blocks::tree(&distinct, progress)?;
    improve(&mut tree, progress)?;
    collapse(&tree, &groups, triangles, progress)
}

/// Reinserts nodes where that makes boxes smaller. A tree that is deep has boxes that nothing makes smaller, and a search
/// among them would go through all.
fn improve(tree: &mut Bvh2, progress: &Progress) -> Result<()> {
    let mut optimizer = ReinsertionOptimizer::default();
    let first = FIRST_SHARE.min(MOST_NODES / tree.nodes.len() as f32);
    for pass in 0..PASSES {
        progress.check()?;
        let depth = depth(tree);
        if depth > DEEPEST {
            return Ok(());
        }
        // obvhs bounds its stack by this depth.
        tree.max_depth = depth;
        optimizer.run(tree, first / DECAY.powi(pass), Some(vec![1.0]));
    }
    progress.check()
}

fn bounds(triangle: &Triangle) -> Aabb {
    Aabb::from_points(&triangle.corners.map(Into::into))
}

/// Levels of a binary tree.
fn depth(tree: &Bvh2) -> usize {
    let mut deepest = 0;
    let mut open = vec![(0_u32, 1)];
    while let Some((node, depth)) = open.pop() {
        deepest = deepest.max(depth);
        let node = &tree.nodes[node as usize];
        if !node.is_leaf() {
            open.extend([(node.first_index, depth + 1), (node.first_index + 1, depth + 1)]);
        }
    }
    deepest
}

/// Triangles grouped by equal boxes.
pub(super) struct Groups {
    /// The first triangle of each group, rising.
    first: Vec<u32>,
    /// The next triangle of the same group; itself at the last.
    next: Vec<u32>,
}

impl Groups {
    fn new(boxes: &[Aabb]) -> Self {
        let key = |b: &Aabb| [b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z].map(f32::to_bits);
        let hash = |b: &Aabb| {
            key(b)
                .into_iter()
                .fold(0_u64, |h, bits| (h ^ u64::from(bits)).wrapping_mul(0x9e37_79b9_7f4a_7c15))
        };
        let mut order: Vec<(u64, u32)> =
            boxes.par_iter().enumerate().map(|(i, b)| (hash(b), i as u32)).collect();
        order.par_sort_unstable();
        let mut next: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut is_first = vec![true; boxes.len()];
        for pair in order.windows(2) {
            let [(of_a, a), (of_b, b)] = [pair[0], pair[1]];
            if of_a == of_b && key(&boxes[a as usize]) == key(&boxes[b as usize]) {
                next[a as usize] = b;
                is_first[b as usize] = false;
            }
        }
        let first = (0..boxes.len() as u32).filter(|triangle| is_first[*triangle as usize]).collect();
        Self { first, next }
    }

    /// The triangles of a group.
    pub(super) fn members(&self, group: u32) -> impl Iterator<Item = u32> + '_ {
        let next = |triangle: &u32| Some(self.next[*triangle as usize]).filter(|next| next != triangle);
        std::iter::successors(Some(self.first[group as usize]), next)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::scene::accel::node::{MAX_DEPTH, Node};

    fn triangle(corners: [Vec3; 3]) -> Triangle {
        Triangle { corners, normals: [Vec3::Y; 3], mesh: 0 }
    }

    fn depth(nodes: &[Node], node: usize) -> usize {
        let inner = nodes[node].children.iter().filter_map(|child| child.as_node());
        1 + inner.map(|child| depth(nodes, child)).max().unwrap_or(0)
    }

    /// Triangles that make bottom-up builders chain their nodes.
    fn hostile() -> [(&'static str, Vec<Triangle>); 8] {
        let fan = |k: usize| Vec3::new((k as f32 * 1e-4).cos(), 0.0, (k as f32 * 1e-4).sin());
        let unit = [Vec3::ZERO, Vec3::X, Vec3::Z];
        let sized = |size: f32| triangle(unit.map(|v| v * size));
        let moved = |by: Vec3| triangle(unit.map(|v| v + by));
        [
            ("one", vec![sized(1.0)]),
            ("equal", vec![sized(1.0); 10_000]),
            // The same boxes of other triangles.
            (
                "equal boxes",
                (0..5000)
                    .flat_map(|_| [unit, [Vec3::X, Vec3::Z, Vec3::ONE * Vec3::new(1., 0., 1.)]])
                    .map(triangle)
                    .collect(),
            ),
            ("fan", (0..50_000).map(|k| triangle([Vec3::X, fan(k), fan(k + 1)])).collect()),
            ("each smaller", (0..800).map(|k| sized(0.9_f32.powi(k))).collect()),
            ("each a little smaller", (0..20_000).map(|k| sized(1.0 - 2e-5 * k as f32)).collect()),
            ("each further", (0..120).map(|k| moved(Vec3::X * 2_f32.powi(k))).collect()),
            ("pairs far apart", (0..5000).map(|k| moved(Vec3::X * (k % 2) as f32 * 1e30)).collect()),
        ]
    }

    #[test]
    fn hostile_triangles_make_no_deep_tree() {
        for (name, triangles) in hostile() {
            let Hierarchy { nodes, leaves, mut order } =
                build(&triangles, &Progress::new()).expect("nobody cancels");
            order.sort_unstable();
            assert!(order.into_iter().eq(0..triangles.len() as u32), "{name}");
            assert!(leaves.len() <= triangles.len());
            assert!(depth(&nodes, 0) <= MAX_DEPTH, "{name}: depth {}", depth(&nodes, 0));
        }
    }
}
