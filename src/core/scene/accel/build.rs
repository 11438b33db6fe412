//! The construction of the hierarchy: top down by the binned surface area heuristic (Wald 2007), in parallel, eight children
//! per node. Its depth is bounded for any input.

use glam::Vec3;

use super::node::{Child, MAX_DEPTH, Node};
use super::triangle::Triangle;
use super::wide::{Boxes, Triangles};
use crate::{Progress, Result};

/// Bins per axis.
const BINS: usize = 16;
/// Depth below which nodes are halved by count, which takes at most 9 levels more.
const MAX_SAH_DEPTH: usize = MAX_DEPTH - 10;
/// Triangles per leaf.
const LEAF: usize = 8;
/// Triangles above which children are built as parallel tasks.
const TASK: usize = 4096;

/// The bounds of a triangle, while sorting.
#[derive(Clone, Copy)]
struct Item {
    bounds: Bounds,
    index: u32,
}

#[derive(Clone, Copy)]
struct Bounds {
    lower: Vec3,
    upper: Vec3,
}

impl Bounds {
    const EMPTY: Self = Self { lower: Vec3::INFINITY, upper: Vec3::NEG_INFINITY };

    fn union(self, other: Self) -> Self {
        Self { lower: self.lower.min(other.lower), upper: self.upper.max(other.upper) }
    }

    /// Twice the centre.
    fn doubled_centre(&self) -> Vec3 {
        self.lower + self.upper
    }

    /// Half the surface; 0 if empty.
    fn half_area(&self) -> f32 {
        let size = (self.upper - self.lower).max(Vec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// A subtree; its indices count from 0.
#[derive(Default)]
struct Tree {
    nodes: Vec<Node>,
    leaves: Vec<Triangles>,
}

/// Nodes (the root first), leaves, and the order of the triangles in them. Deterministic.
pub(super) fn build(
    triangles: &[Triangle],
    progress: &Progress,
) -> Result<(Vec<Node>, Vec<Triangles>, Vec<u32>)> {
    let mut items: Vec<Item> = triangles.iter().enumerate().map(item).collect();
    let Tree { nodes, leaves } = subtree(&mut items, 0, triangles, (0, progress))?;
    Ok((nodes, leaves, items.iter().map(|item| item.index).collect()))
}

fn item((index, triangle): (usize, &Triangle)) -> Item {
    let [a, b, c] = triangle.corners;
    Item { bounds: Bounds { lower: a.min(b).min(c), upper: a.max(b).max(c) }, index: index as u32 }
}

fn bounds(items: &[Item]) -> Bounds {
    items.iter().fold(Bounds::EMPTY, |bounds, item| bounds.union(item.bounds))
}

/// The tree over `items`, the first of which is triangle `offset` of the final order.
fn subtree(
    items: &mut [Item],
    offset: usize,
    triangles: &[Triangle],
    (depth, progress): (usize, &Progress),
) -> Result<Tree> {
    progress.check()?;
    let parts = eight_parts(items, depth);
    let mut rest = items;
    let mut tasks = Vec::with_capacity(parts.len());
    let mut start = offset;
    for (count, bounds) in parts {
        let (part, more) = rest.split_at_mut(count);
        tasks.push((part, start, bounds));
        start += count;
        rest = more;
    }
    let boxes = Boxes::new(std::array::from_fn(|k| {
        let bounds = tasks.get(k).map_or(Bounds::EMPTY, |task| task.2);
        (bounds.lower, bounds.upper)
    }));
    let large = start - offset > TASK;
    let build = |(part, start, _): (&mut [Item], usize, Bounds)| {
        if part.len() > LEAF {
            return subtree(part, start, triangles, (depth + 1, progress));
        }
        let corners: Vec<_> = part.iter().map(|item| triangles[item.index as usize].corners).collect();
        Ok(Tree { nodes: Vec::new(), leaves: vec![Triangles::new(&corners, start as u32)] })
    };
    let children: Vec<Tree> = if large {
        use rayon::prelude::*;
        tasks.into_par_iter().map(build).collect::<Result<_>>()?
    } else {
        tasks.into_iter().map(build).collect::<Result<_>>()?
    };
    Ok(join(boxes, children))
}

/// A node over finished subtrees, with their indices offset.
fn join(boxes: Boxes, children: Vec<Tree>) -> Tree {
    let mut tree = Tree { nodes: vec![Node { boxes, children: [Child::EMPTY; 8] }], leaves: Vec::new() };
    for (slot, mut child) in children.into_iter().enumerate() {
        let (nodes, leaves) = (tree.nodes.len() as u32, tree.leaves.len() as u32);
        tree.nodes[0].children[slot] =
            if child.nodes.is_empty() { Child::leaf(leaves) } else { Child::node(nodes) };
        for child in child.nodes.iter_mut().flat_map(|node| &mut node.children) {
            child.shift(nodes, leaves);
        }
        tree.nodes.append(&mut child.nodes);
        tree.leaves.append(&mut child.leaves);
    }
    tree
}

/// Partitions the items into up to eight parts: the part of the largest surface is divided until there are eight, or all fit
/// into leaves. Size and bounds of each, in order.
fn eight_parts(items: &mut [Item], depth: usize) -> Vec<(usize, Bounds)> {
    let mut parts = vec![(items.len(), bounds(items))];
    while parts.len() < 8 {
        let area =
            |part: &(usize, Bounds)| if depth < MAX_SAH_DEPTH { part.1.half_area() } else { part.0 as f32 };
        let divisible = parts.iter().enumerate().filter(|(_, part)| part.0 > LEAF);
        let Some((largest, _)) = divisible.max_by(|a, b| area(a.1).total_cmp(&area(b.1))) else { break };
        let start: usize = parts[..largest].iter().map(|part| part.0).sum();
        let part = &mut items[start..start + parts[largest].0];
        let middle = divide(part, depth);
        let (left, right) = part.split_at(middle);
        let halves = [(left.len(), bounds(left)), (right.len(), bounds(right))];
        parts.splice(largest..=largest, halves);
    }
    parts
}

/// Partitions the items in two, both nonempty; the size of the first.
fn divide(items: &mut [Item], depth: usize) -> usize {
    let centres = items.iter().fold(Bounds::EMPTY, |all, item| {
        let centre = item.bounds.doubled_centre();
        all.union(Bounds { lower: centre, upper: centre })
    });
    if depth < MAX_SAH_DEPTH
        && let Some((axis, edge)) = best_plane(items, &centres)
    {
        let bin = binning(&centres, axis);
        return partition(items, |item| bin(item) <= edge);
    }
    let size = centres.upper - centres.lower;
    let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0);
    let middle = items.len() / 2;
    let centre = |item: &Item| item.bounds.doubled_centre()[axis];
    items.select_nth_unstable_by(middle, |a, b| centre(a).total_cmp(&centre(b)).then(a.index.cmp(&b.index)));
    middle
}

/// The bin of an item along an axis.
fn binning(centres: &Bounds, axis: usize) -> impl Fn(&Item) -> usize + use<> {
    let low = centres.lower[axis];
    let scale = BINS as f32 / (centres.upper[axis] - low);
    move |item| (((item.bounds.doubled_centre()[axis] - low) * scale) as usize).min(BINS - 1)
}

/// Axis and last bin of the first part of the cheapest split; none if all centres coincide.
fn best_plane(items: &[Item], centres: &Bounds) -> Option<(usize, usize)> {
    let mut best = None;
    let mut lowest = f32::INFINITY;
    for axis in 0..3 {
        let size = centres.upper[axis] - centres.lower[axis];
        if !(size > 0.0 && (BINS as f32 / size).is_finite()) {
            continue;
        }
        let bin = binning(centres, axis);
        let mut bins = [(Bounds::EMPTY, 0_usize); BINS];
        for item in items {
            let (bounds, count) = &mut bins[bin(item)];
            *bounds = bounds.union(item.bounds);
            *count += 1;
        }
        let grow = |sum: &mut (Bounds, usize), k: usize| {
            *sum = (sum.0.union(bins[k].0), sum.1 + bins[k].1);
            sum.0.half_area() * leaves(sum.1)
        };
        let mut above = [0.0; BINS];
        let mut sum = (Bounds::EMPTY, 0);
        (1..BINS).rev().for_each(|k| above[k - 1] = grow(&mut sum, k));
        let mut sum = (Bounds::EMPTY, 0);
        for k in 0..BINS - 1 {
            let cost = grow(&mut sum, k) + above[k];
            if (1..items.len()).contains(&sum.1) && cost < lowest {
                lowest = cost;
                best = Some((axis, k));
            }
        }
    }
    best
}

/// The cost of `count` triangles, in leaves.
fn leaves(count: usize) -> f32 {
    count as f32 / LEAF as f32 + if count > 0 { 0.5 } else { 0.0 }
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
    use super::*;

    fn triangle(corners: [Vec3; 3]) -> Triangle {
        Triangle { corners, normals: [Vec3::Y; 3], mesh: 0 }
    }

    fn depth(nodes: &[Node], node: usize) -> usize {
        let inner = nodes[node].children.iter().filter_map(|child| child.as_node());
        1 + inner.map(|child| depth(nodes, child)).max().unwrap_or(0)
    }

    #[test]
    fn hostile_triangles_make_no_deep_tree() {
        let fan = |k: usize| Vec3::new((k as f32 * 1e-4).cos(), 0.0, (k as f32 * 1e-4).sin());
        let cases: [Vec<Triangle>; 4] = [
            vec![triangle([Vec3::ZERO, Vec3::X, Vec3::Z])],
            vec![triangle([Vec3::ZERO, Vec3::X, Vec3::Z]); 10_000],
            (0..50_000).map(|k| triangle([Vec3::X, fan(k), fan(k + 1)])).collect(),
            // Each smaller than the one before: every plane cuts off a few.
            (0..800).map(|k| triangle([Vec3::ZERO, Vec3::X, Vec3::Z].map(|v| v * 0.9_f32.powi(k)))).collect(),
        ];
        for triangles in &cases {
            let (nodes, leaves, mut order) = build(triangles, &Progress::new()).expect("nobody cancels");
            order.sort_unstable();
            assert!(order.into_iter().eq(0..triangles.len() as u32));
            assert!(leaves.len() <= triangles.len());
            assert!(depth(&nodes, 0) <= MAX_DEPTH, "depth {}", depth(&nodes, 0));
        }
    }
}
