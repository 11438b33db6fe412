//! Circles in a graph.

use std::collections::BTreeSet;

/// Strongly connected components of two nodes or more (Tarjan 1972); `edges[n]` are the successors of n.
pub(crate) fn circles(edges: &[BTreeSet<usize>]) -> Vec<Vec<usize>> {
    let unseen = usize::MAX;
    let mut search =
        Search { edges, order: vec![unseen; edges.len()], low: vec![0; edges.len()], ..Search::default() };
    for node in 0..edges.len() {
        if search.order[node] == unseen {
            search.visit(node);
        }
    }
    search.found
}

#[derive(Default)]
struct Search<'a> {
    edges: &'a [BTreeSet<usize>],
    order: Vec<usize>,
    /// The earliest node of the stack that is reached from here.
    low: Vec<usize>,
    stack: Vec<usize>,
    visited: usize,
    found: Vec<Vec<usize>>,
}

impl Search<'_> {
    fn visit(&mut self, node: usize) {
        (self.order[node], self.low[node]) = (self.visited, self.visited);
        self.visited += 1;
        self.stack.push(node);
        for &next in &self.edges[node] {
            if self.order[next] == usize::MAX {
                self.visit(next);
                self.low[node] = self.low[node].min(self.low[next]);
            } else if self.stack.contains(&next) {
                self.low[node] = self.low[node].min(self.order[next]);
            }
        }
        if self.low[node] == self.order[node] {
            let at = self.stack.iter().position(|other| *other == node).unwrap();
            let component = self.stack.split_off(at);
            if component.len() > 1 {
                self.found.push(component);
            }
        }
    }
}

#[test]
fn circles_are_found_and_chains_are_not() {
    // 0 -> 1 -> 2 -> 1, 3 -> 4 -> 5 -> 3, 5 -> 0.
    let edges = [vec![1], vec![2], vec![1], vec![4], vec![5], vec![3, 0]].map(BTreeSet::from_iter);
    let mut found = circles(&edges);
    found.iter_mut().for_each(|circle| circle.sort_unstable());
    found.sort();
    assert_eq!(found, [vec![1, 2], vec![3, 4, 5]]);
}
