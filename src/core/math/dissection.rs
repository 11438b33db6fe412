//! Nested dissection of nodes of a grid: an order of elimination in which little fills in (George 1973).
//!
//! A matrix that links each node with its 7 x 7 neighbours falls into two parts that do not touch where three lines of
//! nodes are left for last. Each part is split again.

use std::ops::Range;

use super::vector::HALO;

/// Nodes that are not split further.
const LEAF: usize = 32;

/// Nodes in the order of elimination, and the fronts in which they are eliminated.
#[derive(Clone, Debug, Default)]
pub(super) struct Dissection {
    /// Nodes (x, y) by position in the order.
    pub(super) order: Vec<[usize; 2]>,
    /// Each after the fronts of its parts; the last is the whole.
    pub(super) fronts: Vec<Front>,
    /// Nodes of the grid along x.
    width: usize,
    /// Position of each node of the grid, row by row.
    positions: Vec<Option<u32>>,
}

/// Nodes that are eliminated together.
#[derive(Clone, Debug)]
pub(super) struct Front {
    /// Fronts of the parts that it kept from touching, two at most.
    pub(super) parts: Vec<usize>,
    /// Positions eliminated here.
    pub(super) pivots: Range<usize>,
    /// Later positions that the pivots or the parts are linked with, ascending.
    pub(super) border: Vec<usize>,
}

impl Dissection {
    /// Of these nodes of a grid of `size` nodes along x and y.
    pub(super) fn new(mut nodes: Vec<[usize; 2]>, size: [usize; 2]) -> Self {
        let mut all = Self { width: size[0], positions: vec![None; size[0] * size[1]], ..Self::default() };
        all.split(&mut nodes);
        for i in 0..all.fronts.len() {
            all.fronts[i].border = all.border(&all.fronts[i]);
        }
        all
    }

    /// The position of the node at (x, y), if it is one of these.
    pub(super) fn position(&self, x: usize, y: usize) -> Option<usize> {
        let inside = x < self.width;
        let position = if inside { *self.positions.get(y * self.width + x)? } else { None };
        position.map(|position| position as usize)
    }

    /// The nodes that the one at `position` is linked with, itself included: positions and offsets.
    pub(super) fn links(&self, position: usize) -> impl Iterator<Item = (usize, [isize; 2])> {
        let [x, y] = self.order[position];
        let reach = HALO as isize;
        let offsets = (-reach..=reach).flat_map(move |dy| (-reach..=reach).map(move |dx| [dx, dy]));
        offsets.filter_map(move |[dx, dy]| {
            // Beyond the lower border numbers wrap around to the largest, which are beyond the upper.
            let y = y.wrapping_add_signed(dy);
            let other = (y < self.positions.len()).then(|| self.position(x.wrapping_add_signed(dx), y))??;
            Some((other, [dx, dy]))
        })
    }

    /// Numbers that a factor of `components` unknowns for each node has.
    pub(super) fn numbers(&self, components: usize) -> usize {
        let of = |front: &Front| front.pivots.len() * (front.pivots.len() + front.border.len());
        components * components * self.fronts.iter().map(of).sum::<usize>()
    }

    /// Orders the nodes and adds their fronts; returns the last of these, none without nodes.
    fn split(&mut self, nodes: &mut [[usize; 2]]) -> Option<usize> {
        if nodes.is_empty() {
            return None;
        }
        let [low, pivots, high] = separate(nodes);
        let parts = [low, high].into_iter().filter_map(|part| self.split(part)).collect();
        let first = self.order.len();
        for &mut [x, y] in pivots {
            self.positions[y * self.width + x] = Some(self.order.len() as u32);
            self.order.push([x, y]);
        }
        self.fronts.push(Front { parts, pivots: first..self.order.len(), border: Vec::new() });
        Some(self.fronts.len() - 1)
    }

    fn border(&self, front: &Front) -> Vec<usize> {
        let linked = front.pivots.clone().flat_map(|pivot| self.links(pivot).map(|(other, _)| other));
        let of_parts = front.parts.iter().flat_map(|&part| self.fronts[part].border.iter().copied());
        let mut border: Vec<usize> =
            linked.chain(of_parts).filter(|position| *position >= front.pivots.end).collect();
        border.sort_unstable();
        border.dedup();
        border
    }
}

/// Nodes below three lines across the longer axis, on them, and above; all on them where they are few.
fn separate(nodes: &mut [[usize; 2]]) -> [&mut [[usize; 2]]; 3] {
    if nodes.len() <= LEAF {
        return [&mut [], nodes, &mut []];
    }
    let range = |axis: usize| {
        let along = nodes.iter().map(|node| node[axis]);
        along.clone().max().unwrap_or_default() - along.min().unwrap_or_default()
    };
    let axis = usize::from(range(1) > range(0));
    nodes.sort_unstable_by_key(|node| (node[axis], node[1 - axis]));
    let first = nodes[nodes.len() / 2][axis].saturating_sub(1);
    let start = nodes.partition_point(|node| node[axis] < first);
    let end = nodes.partition_point(|node| node[axis] < first + HALO);
    let (below, above) = nodes.split_at_mut(end);
    let (low, on) = below.split_at_mut(start);
    [low, on, above]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes of a grid, a share of them left out.
    fn nodes(size: [usize; 2], keep: fn(usize, usize) -> bool) -> Vec<[usize; 2]> {
        let all = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
        all.filter(|[x, y]| keep(*x, *y)).collect()
    }

    #[test]
    fn parts_do_not_touch_and_borders_hold_all_that_is_linked() {
        let size = [40, 23];
        let shapes: [fn(usize, usize) -> bool; 3] =
            [|_, _| true, |x, y| (x * 7 + y * 13) % 5 < 2, |x, y| x.abs_diff(2 * y) < 4];
        for keep in shapes {
            let all = Dissection::new(nodes(size, keep), size);
            assert_eq!(all.order.len(), nodes(size, keep).len());
            let mut begins: Vec<usize> = Vec::new();
            for front in &all.fronts {
                let begin = front.parts.iter().map(|&part| begins[part]).min().unwrap_or(front.pivots.start);
                begins.push(begin);
                for pivot in front.pivots.clone() {
                    for (other, [dx, dy]) in all.links(pivot) {
                        let [[x, y], [to_x, to_y]] = [all.order[pivot], all.order[other]];
                        assert_eq!([x as isize + dx, y as isize + dy], [to_x as isize, to_y as isize]);
                        // In its own part, or still to come and on the border.
                        let known =
                            (begin..front.pivots.end).contains(&other) || front.border.contains(&other);
                        assert!(known, "{other} of {pivot}");
                    }
                }
            }
        }
        assert!(Dissection::new(Vec::new(), size).fronts.is_empty());
    }
}
