//! The nodes of the hierarchy, and the stack of a search among them.

use arrayvec::ArrayVec;

use super::wide::{Boxes, WideRay};

/// Bound on the depth of the hierarchy.
pub(super) const MAX_DEPTH: usize = 26;

/// Eight boxes with their children.
pub(super) struct Node {
    pub boxes: Boxes,
    pub children: [Child; 8],
}

/// A node, or a leaf with the highest bit set.
#[derive(Clone, Copy)]
pub(super) struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    /// An unused slot; its box is never hit.
    pub(super) const EMPTY: Self = Self(u32::MAX);

    pub(super) fn node(index: u32) -> Self {
        Self(index)
    }

    pub(super) fn leaf(index: u32) -> Self {
        Self(index | Self::LEAF)
    }

    pub(super) fn as_node(self) -> Option<usize> {
        (self.0 & Self::LEAF == 0).then_some(self.0 as usize)
    }

    pub(super) fn as_leaf(self) -> usize {
        (self.0 & !Self::LEAF) as usize
    }
}

/// The traversal stack: each level leaves at most seven children.
pub(super) type Stack = ArrayVec<(f32, Child), { 7 * MAX_DEPTH + 8 }>;

impl Node {
    /// The nearest child hit; the others go onto the stack, the next nearest on top.
    #[inline(always)]
    pub(super) fn enter(&self, ray: &WideRay, limit: f32, stack: &mut Stack) -> Option<Child> {
        let (mut mask, enter) = self.boxes.intersect(ray, limit);
        if mask == 0 {
            return None;
        }
        let first = mask.trailing_zeros() as usize;
        mask &= mask - 1;
        if mask == 0 {
            return Some(self.children[first]);
        }
        let enter = enter.to_array();
        let second = mask.trailing_zeros() as usize;
        if mask & (mask - 1) == 0 {
            let (near, far) = if enter[first] <= enter[second] { (first, second) } else { (second, first) };
            stack.push((enter[far], self.children[far]));
            return Some(self.children[near]);
        }
        let bottom = stack.len();
        stack.push((enter[first], self.children[first]));
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            let mut at = stack.len();
            stack.push((enter[lane], self.children[lane]));
            while at > bottom && stack[at - 1].0 < enter[lane] {
                stack.swap(at - 1, at);
                at -= 1;
            }
        }
        stack.pop().map(|(_, child)| child)
    }
}
