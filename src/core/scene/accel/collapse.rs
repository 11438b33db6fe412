//! Nodes of eight out of a binary tree, by dynamic programming over the surface area heuristic (Ylitie, Karras, Laine 2017).
//! Eight triangles are tested at once, so a leaf costs the same whether it is full or not.

use glam::Vec3;
use obvhs::bvh2::Bvh2;
use rayon::prelude::*;

use super::build::Groups;
use super::node::{Child, MAX_DEPTH, Node};
use super::triangle::Triangle;
use super::wide::{Boxes, Triangles};
use crate::{Progress, Result};

/// Triangles per leaf.
const LEAF: usize = 8;
/// Depth below which triangles are shared out by count, which takes at most ten levels more.
const MAX_TREE_DEPTH: usize = MAX_DEPTH - 11;
/// Cost of a leaf over that of a node.
const LEAF_COST: f32 = 1.0;
/// Nodes between two looks at whether the work is cancelled.
const PATIENCE: usize = 1 << 16;

/// A hierarchy.
pub(super) struct Hierarchy {
    /// The root first.
    pub(super) nodes: Vec<Node>,
    pub(super) leaves: Vec<Triangles>,
    /// The triangles in the order of the leaves.
    pub(super) order: Vec<u32>,
}

/// Collapses a binary tree over groups of triangles.
///
/// # Errors
/// `Cancelled`.
pub(super) fn collapse(
    tree: &Bvh2,
    groups: &Groups,
    triangles: &[Triangle],
    progress: &Progress,
) -> Result<Hierarchy> {
    let mut collapser = Collapser {
        tree,
        groups,
        triangles,
        costs: vec![[0.0; 7]; tree.nodes.len()],
        counts: vec![0; tree.nodes.len()],
        nodes: Vec::new(),
        leaves: Vec::new(),
        order: Vec::with_capacity(triangles.len()),
    };
    collapser.price(progress)?;
    collapser.node(&collapser.children(0), 1);
    progress.check()?;
    let Collapser { nodes, leaves, order, .. } = collapser;
    let leaf = |range: &[u32; 2]| {
        let of_leaf = &order[range[0] as usize..range[1] as usize];
        let mut corners = [[Vec3::ZERO; 3]; LEAF];
        corners.iter_mut().zip(of_leaf).for_each(|(to, i)| *to = triangles[*i as usize].corners);
        Triangles::new(&corners[..of_leaf.len()], range[0])
    };
    Ok(Hierarchy { nodes, leaves: leaves.par_iter().map(leaf).collect(), order })
}

/// A part of the triangles below a node.
enum Part {
    /// A subtree of the binary tree.
    Subtree(u32),
    /// Triangles shared out by count.
    Listed(Vec<u32>),
}

struct Collapser<'a> {
    tree: &'a Bvh2,
    groups: &'a Groups,
    triangles: &'a [Triangle],
    /// Least cost of each node of the tree as at most 1 to 7 children of another.
    costs: Vec<[f32; 7]>,
    /// Triangles of each node of the tree, counted up to one more than a leaf holds.
    counts: Vec<u8>,
    nodes: Vec<Node>,
    /// Where each leaf starts and ends in the order.
    leaves: Vec<[u32; 2]>,
    order: Vec<u32>,
}

impl Collapser<'_> {
    /// Finds the costs, children before parents.
    fn price(&mut self, progress: &Progress) -> Result<()> {
        let tree = self.tree;
        let mut down = Vec::with_capacity(tree.nodes.len());
        let mut open = vec![0_u32];
        while let Some(index) = open.pop() {
            down.push(index);
            let node = &tree.nodes[index as usize];
            if !node.is_leaf() {
                open.extend([node.first_index, node.first_index + 1]);
            }
        }
        for (done, index) in down.into_iter().rev().enumerate() {
            if done % PATIENCE == 0 {
                progress.check()?;
            }
            let index = index as usize;
            let node = &tree.nodes[index];
            let area = node.aabb().half_area();
            if node.is_leaf() {
                let group = tree.primitive_indices[node.first_index as usize];
                let count = self.groups.members(group).take(LEAF + 1).count();
                self.counts[index] = count as u8;
                self.costs[index] = [area * LEAF_COST; 7];
                continue;
            }
            let [a, b] = [0, 1].map(|side| node.first_index as usize + side);
            let count = (self.counts[a] + self.counts[b]).min(LEAF as u8 + 1);
            let leaf = if usize::from(count) <= LEAF { area * LEAF_COST } else { f32::INFINITY };
            let [(_, eight), rest @ ..] = [8, 2, 3, 4, 5, 6, 7].map(|slots| self.shared_out([a, b], slots));
            let mut costs = [leaf.min(area + eight); 7];
            for (k, (_, cost)) in rest.into_iter().enumerate() {
                costs[k + 1] = cost.min(costs[k]);
            }
            (self.counts[index], self.costs[index]) = (count, costs);
        }
        Ok(())
    }

    /// Two nodes of the tree in so many slots, 2 to 8: how many the first should have, and the cost.
    fn shared_out(&self, [a, b]: [usize; 2], slots: usize) -> (usize, f32) {
        let cost = |first: usize| self.costs[a][first - 1] + self.costs[b][slots - first - 1];
        let firsts = slots.saturating_sub(7).max(1)..=(slots - 1).min(7);
        let best = firsts.map(|first| (first, cost(first))).min_by(|a, b| a.1.total_cmp(&b.1));
        best.unwrap_or((1, f32::INFINITY))
    }

    /// The children of the node that stands for a node of the tree.
    fn children(&self, index: u32) -> Vec<Part> {
        let mut parts = Vec::with_capacity(8);
        if self.is_leaf(index) {
            parts.push(Part::Subtree(index))
        } else {
            self.divide(index, 8, &mut parts)
        }
        parts
    }

    /// Whether a node of the tree fits into a leaf.
    fn is_leaf(&self, index: u32) -> bool {
        usize::from(self.counts[index as usize]) <= LEAF
    }

    /// Puts the two children of a node of the tree into so many slots.
    fn divide(&self, index: u32, slots: usize, parts: &mut Vec<Part>) {
        let node = &self.tree.nodes[index as usize];
        if node.is_leaf() {
            parts.push(Part::Subtree(index));
            return;
        }
        let [a, b] = [node.first_index, node.first_index + 1];
        let (first, _) = self.shared_out([a as usize, b as usize], slots);
        self.place(a, first, parts);
        self.place(b, slots - first, parts);
    }

    /// Puts a node of the tree into at most so many slots.
    fn place(&self, index: u32, slots: usize, parts: &mut Vec<Part>) {
        let costs = &self.costs[index as usize];
        let fewest = (1..slots).find(|fewer| costs[fewer - 1] <= costs[slots - 1]).unwrap_or(slots);
        if fewest == 1 {
            parts.push(Part::Subtree(index));
        } else {
            self.divide(index, fewest, parts);
        }
    }

    /// Adds a node over some parts at a depth.
    fn node(&mut self, parts: &[Part], depth: usize) {
        let at = self.nodes.len();
        let mut bounds = [(Vec3::INFINITY, Vec3::NEG_INFINITY); 8];
        bounds.iter_mut().zip(parts).for_each(|(bounds, part)| *bounds = self.bounds(part));
        self.nodes.push(Node { boxes: Boxes::new(bounds), children: [Child::EMPTY; 8] });
        for (slot, part) in parts.iter().enumerate() {
            self.nodes[at].children[slot] = self.child(part, depth);
        }
    }

    /// Adds what stands below a slot of a node at a depth.
    fn child(&mut self, part: &Part, depth: usize) -> Child {
        let next = match part {
            Part::Subtree(index) if self.is_leaf(*index) => return self.leaf(&self.listed(*index)),
            Part::Subtree(index) if depth < MAX_TREE_DEPTH && !self.tree.nodes[*index as usize].is_leaf() => {
                self.children(*index)
            }
            Part::Subtree(index) => by_count(&self.listed(*index)),
            Part::Listed(list) if list.len() <= LEAF => return self.leaf(list),
            Part::Listed(list) => by_count(list),
        };
        let child = Child::node(self.nodes.len() as u32);
        self.node(&next, depth + 1);
        child
    }

    fn leaf(&mut self, list: &[u32]) -> Child {
        let start = self.order.len() as u32;
        self.order.extend(list);
        self.leaves.push([start, start + list.len() as u32]);
        Child::leaf(self.leaves.len() as u32 - 1)
    }

    /// The triangles of a node of the tree, near ones together.
    fn listed(&self, index: u32) -> Vec<u32> {
        let (mut list, mut open) = (Vec::new(), vec![index]);
        while let Some(index) = open.pop() {
            let node = &self.tree.nodes[index as usize];
            if node.is_leaf() {
                list.extend(self.groups.members(self.tree.primitive_indices[node.first_index as usize]));
            } else {
                open.extend([node.first_index + 1, node.first_index]);
            }
        }
        list
    }

    fn bounds(&self, part: &Part) -> (Vec3, Vec3) {
        match part {
            Part::Subtree(index) => {
                let bounds = self.tree.nodes[*index as usize].aabb();
                (bounds.min.into(), bounds.max.into())
            }
            Part::Listed(list) => {
                let corners = || list.iter().flat_map(|i| self.triangles[*i as usize].corners);
                (corners().fold(Vec3::INFINITY, Vec3::min), corners().fold(Vec3::NEG_INFINITY, Vec3::max))
            }
        }
    }
}

/// At most eight parts of a list, all full leaves but the last.
fn by_count(list: &[u32]) -> Vec<Part> {
    let leaves = list.len().div_ceil(LEAF);
    list.chunks(leaves.div_ceil(8) * LEAF).map(|part| Part::Listed(part.to_vec())).collect()
}
