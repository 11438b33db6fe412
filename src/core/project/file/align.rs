//! Alignment of two versions of a list, so that the text of an element stays with it when others are inserted, deleted or
//! moved.

use std::collections::{BTreeMap, VecDeque};

use super::tree::{Kind, Node};

/// Most pairs of changed elements that are compared by content; beyond, elements are paired in order.
const MOST_PAIRS: usize = 250_000;

/// For each element of `after` the index of its earlier version in `before`; none for new elements.
pub(super) fn origins(before: &[Node], after: &[Node]) -> Vec<Option<usize>> {
    let mut pairs = Pairs { origin: vec![None; after.len()], taken: vec![false; before.len()] };
    pairs.equal_at_the_ends(before, after);
    pairs.equal_elsewhere(before, after);
    pairs.similar(before, after);
    pairs.origin
}

struct Pairs {
    origin: Vec<Option<usize>>,
    taken: Vec<bool>,
}

impl Pairs {
    fn take(&mut self, old: usize, new: usize) {
        self.origin[new] = Some(old);
        self.taken[old] = true;
    }

    /// Pairs equal elements at the same place from the start or from the end.
    fn equal_at_the_ends(&mut self, before: &[Node], after: &[Node]) {
        let same = |(a, b): &(&Node, &Node)| a.text == b.text;
        let head = before.iter().zip(after).take_while(same).count();
        let tail = before[head..].iter().rev().zip(after[head..].iter().rev()).take_while(same).count();
        (0..head).for_each(|i| self.take(i, i));
        (1..=tail).for_each(|i| self.take(before.len() - i, after.len() - i));
    }

    /// Pairs equal elements at any place, in order.
    fn equal_elsewhere(&mut self, before: &[Node], after: &[Node]) {
        let mut by_text: BTreeMap<&str, VecDeque<usize>> = BTreeMap::new();
        for old in self.free() {
            by_text.entry(before[old].text).or_default().push_back(old);
        }
        for new in self.open() {
            if let Some(old) = by_text.get_mut(after[new].text).and_then(VecDeque::pop_front) {
                self.take(old, new);
            }
        }
    }

    /// Pairs changed elements by similarity, the most similar first.
    fn similar(&mut self, before: &[Node], after: &[Node]) {
        let (free, open) = (self.free(), self.open());
        if free.len().saturating_mul(open.len()) > MOST_PAIRS {
            free.into_iter().zip(open).for_each(|(old, new)| self.take(old, new));
            return;
        }
        let mut scored = Vec::new();
        for &new in &open {
            for &old in &free {
                if let Some(similarity) = similarity(&before[old], &after[new]) {
                    scored.push((similarity, old.abs_diff(new), new, old));
                }
            }
        }
        scored
            .sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then_with(|| (a.1, a.2, a.3).cmp(&(b.1, b.2, b.3))));
        for (_, _, new, old) in scored {
            if self.origin[new].is_none() && !self.taken[old] {
                self.take(old, new);
            }
        }
    }

    /// Unpaired elements of `before`.
    fn free(&self) -> Vec<usize> {
        (0..self.taken.len()).filter(|&old| !self.taken[old]).collect()
    }

    /// Unpaired elements of `after`.
    fn open(&self) -> Vec<usize> {
        (0..self.origin.len()).filter(|&new| self.origin[new].is_none()).collect()
    }
}

/// Similarity of two elements, 0 to 2: the share of equal members, plus 1 for an equal name. None for elements that are
/// never versions of each other.
fn similarity(old: &Node, new: &Node) -> Option<f32> {
    match (&old.kind, &new.kind) {
        (Kind::Object(before), Kind::Object(after)) => {
            let equal = |name: &str| match (old.get(name), new.get(name)) {
                (Some(a), Some(b)) => a.text == b.text,
                _ => false,
            };
            let shared = after.iter().filter(|(name, _)| equal(name)).count() as f32;
            let share = shared / before.len().max(after.len()).max(1) as f32;
            let named = equal("name") && new.get("name").is_some_and(|name| name.text != "\"\"");
            (named || share >= 0.5).then_some(share + f32::from(u8::from(named)))
        }
        // Numbers, and lists of them, have no members that could stay with them.
        _ => None,
    }
}
