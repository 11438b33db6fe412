//! Builds the hierarchy over triangles: top down by the surface area heuristic over bins (Wald 2007), in parallel, then
//! widened by obvhs. The builder of obvhs itself merges bottom up; among triangles with equal boxes, such as a fan of many
//! around one corner, its trees become as deep as the fan is long. Here the depth is bounded for any input.

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;

use super::accel::Triangle;

/// Bins per axis.
const BINS: usize = 24;
/// Below this depth nodes are halved by count: at most 26 levels more, within the stacks of obvhs.
const MAX_SAH_DEPTH: usize = 40;
/// Share of the nodes that obvhs may move to a better place (Meister & Bittner 2018).
const REINSERTED: f32 = 0.05;
/// Triangles per leaf of the wide hierarchy, its limit.
const LEAF: u32 = 3;
/// Subtrees of more triangles than this are built as separate tasks.
const TASK: usize = 4096;

/// A triangle while sorting.
#[derive(Clone, Copy)]
struct Item {
    bounds: Aabb,
    centre: Vec3A,
    index: u32,
}

/// Builds the hierarchy of at least one triangle; deterministic.
pub(super) fn build(triangles: &[Triangle]) -> CwBvh {
    let mut items: Vec<Item> = triangles.iter().enumerate().map(item).collect();
    let mut nodes = vec![Bvh2Node::default(); 2 * items.len() - 1];
    let (root, rest) = nodes.split_at_mut(1);
    split(&mut items, &mut root[0], rest, 1, 0, 0);
    let mut bvh = Bvh2 {
        nodes,
        primitive_indices: items.iter().map(|item| item.index).collect(),
        children_are_ordered_after_parents: true,
        ..Bvh2::default()
    };
    ReinsertionOptimizer::default().run(&mut bvh, REINSERTED, None);
    bvh2_to_cwbvh(&bvh, LEAF, true, false)
}

fn item((index, triangle): (usize, &Triangle)) -> Item {
    let bounds = Aabb::from_points(&triangle.corners.map(Vec3A::from));
    Item { bounds, centre: bounds.center(), index: index as u32 }
}

/// Makes the node over `items` and all nodes below it. `below` is room for exactly these, `first` its index in the
/// whole list, `offset` that of the items.
fn split(
    items: &mut [Item],
    node: &mut Bvh2Node,
    below: &mut [Bvh2Node],
    first: u32,
    offset: u32,
    depth: usize,
) {
    let bounds = items.iter().fold(Aabb::empty(), |bounds, item| bounds.union(&item.bounds));
    if items.len() == 1 {
        *node = Bvh2Node::new(bounds, 1, offset);
        return;
    }
    *node = Bvh2Node::new(bounds, 0, first);
    let middle = divide(items, depth);
    let (left, right) = items.split_at_mut(middle);
    let (children, below) = below.split_at_mut(2);
    let (child_left, child_right) = children.split_at_mut(1);
    let (below_left, below_right) = below.split_at_mut(2 * middle - 2);
    let first_left = first + 2;
    let first_right = first_left + below_left.len() as u32;
    let large = left.len() + right.len() > TASK;
    let mut go_left = || split(left, &mut child_left[0], below_left, first_left, offset, depth + 1);
    let offset_right = offset + middle as u32;
    let mut go_right =
        || split(right, &mut child_right[0], below_right, first_right, offset_right, depth + 1);
    if large {
        rayon::join(go_left, go_right);
    } else {
        go_left();
        go_right();
    }
}

/// Sorts the items into two parts and returns the size of the first; both hold at least one.
fn divide(items: &mut [Item], depth: usize) -> usize {
    let centres = items.iter().fold(Aabb::empty(), |mut bounds, item| *bounds.extend(item.centre));
    if depth < MAX_SAH_DEPTH
        && let Some((axis, edge)) = best_plane(items, &centres)
    {
        let bin = binning(&centres, axis);
        let middle = partition(items, |item| bin(item) <= edge);
        if middle > 0 && middle < items.len() {
            return middle;
        }
    }
    let size = centres.max - centres.min;
    let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0);
    let middle = items.len() / 2;
    let by_place = |a: &Item, b: &Item| a.centre[axis].total_cmp(&b.centre[axis]).then(a.index.cmp(&b.index));
    items.select_nth_unstable_by(middle, by_place);
    middle
}

/// The bin of an item along an axis.
fn binning(centres: &Aabb, axis: usize) -> impl Fn(&Item) -> usize + use<> {
    let low = centres.min[axis];
    let scale = BINS as f32 / (centres.max[axis] - low);
    move |item| (((item.centre[axis] - low) * scale) as usize).min(BINS - 1)
}

/// Axis and last bin of the first part of the cheapest division; none if all centres coincide.
fn best_plane(items: &[Item], centres: &Aabb) -> Option<(usize, usize)> {
    let mut best = None;
    let mut lowest = f32::INFINITY;
    for axis in 0..3 {
        let size = centres.max[axis] - centres.min[axis];
        if !(size > 0.0 && (BINS as f32 / size).is_finite()) {
            continue;
        }
        let bin = binning(centres, axis);
        let mut bins = [(Aabb::empty(), 0_u32); BINS];
        for item in items {
            let (bounds, count) = &mut bins[bin(item)];
            *bounds = bounds.union(&item.bounds);
            *count += 1;
        }
        let mut above = [0.0; BINS];
        let mut sum = (Aabb::empty(), 0_u32);
        for k in (1..BINS).rev() {
            sum = (sum.0.union(&bins[k].0), sum.1 + bins[k].1);
            above[k - 1] = cost(&sum);
        }
        let mut sum = (Aabb::empty(), 0_u32);
        for k in 0..BINS - 1 {
            sum = (sum.0.union(&bins[k].0), sum.1 + bins[k].1);
            let total = cost(&sum) + above[k];
            if sum.1 > 0 && (sum.1 as usize) < items.len() && total < lowest {
                lowest = total;
                best = Some((axis, k));
            }
        }
    }
    best
}

/// Surface times count; 0 for nothing.
fn cost((bounds, count): &(Aabb, u32)) -> f32 {
    if *count == 0 { 0.0 } else { bounds.half_area() * *count as f32 }
}

/// Moves the items that satisfy `first` to the front; their number.
fn partition(items: &mut [Item], first: impl Fn(&Item) -> bool) -> usize {
    let mut end = 0;
    for i in 0..items.len() {
        if first(&items[i]) {
            items.swap(i, end);
            end += 1;
        }
    }
    end
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn triangle(corners: [Vec3; 3]) -> Triangle {
        Triangle { corners, normals: [Vec3::Y; 3], mesh: 0 }
    }

    fn depth(bvh: &CwBvh, node: usize) -> usize {
        let inner = bvh.nodes[node].imask.count_ones() as usize;
        let base = bvh.nodes[node].child_base_idx as usize;
        (base..base + inner).map(|child| 1 + depth(bvh, child)).max().unwrap_or(1)
    }

    /// All triangles once, and not deeper than the traversal's stack of 32.
    fn assert_sound(triangles: &[Triangle]) {
        let bvh = build(triangles);
        let mut indices = bvh.primitive_indices.clone();
        indices.sort_unstable();
        assert!(indices.into_iter().eq(0..triangles.len() as u32));
        let depth = depth(&bvh, 0);
        assert!(depth < 32, "depth {depth}");
    }

    #[test]
    fn hostile_triangles_make_no_deep_tree() {
        let fan = |k: usize| Vec3::from_array([(k as f32 * 1e-4).cos(), 0.0, (k as f32 * 1e-4).sin()]);
        let cases: [Vec<Triangle>; 4] = [
            vec![triangle([Vec3::ZERO, Vec3::X, Vec3::Z])],
            vec![triangle([Vec3::ZERO, Vec3::X, Vec3::Z]); 10_000],
            (0..50_000).map(|k| triangle([Vec3::X, fan(k), fan(k + 1)])).collect(),
            // Each ten times smaller than the one before: every plane cuts off one.
            (0..30).map(|k| triangle([Vec3::ZERO, Vec3::X, Vec3::Z].map(|v| v * 0.1_f32.powi(k)))).collect(),
        ];
        cases.iter().for_each(|triangles| assert_sound(triangles));
    }
}
