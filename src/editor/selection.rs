//! The selection of constraints and their points.

use std::collections::{BTreeMap, BTreeSet};

/// Selected constraints by index, each with its selected points; no points means the whole constraint.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    items: BTreeMap<usize, BTreeSet<usize>>,
}

impl Selection {
    /// One whole constraint.
    pub fn one(constraint: usize) -> Self {
        Self::all([constraint])
    }

    /// Several whole constraints.
    pub fn all(constraints: impl IntoIterator<Item = usize>) -> Self {
        Self { items: constraints.into_iter().map(|index| (index, BTreeSet::new())).collect() }
    }

    /// One point of a constraint.
    pub fn point(constraint: usize, point: usize) -> Self {
        Self { items: [(constraint, [point].into())].into() }
    }

    /// Whether nothing is selected.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// Whether a constraint, or a part of it, is selected.
    pub fn contains(&self, constraint: usize) -> bool {
        self.items.contains_key(&constraint)
    }

    /// The selected points of a constraint; empty where it is selected as a whole or not at all.
    pub fn points(&self, constraint: usize) -> impl Iterator<Item = usize> {
        self.items.get(&constraint).into_iter().flatten().copied()
    }

    /// Whether the point, or its whole constraint, is selected.
    pub fn moves(&self, constraint: usize, point: usize) -> bool {
        self.items.get(&constraint).is_some_and(|points| points.is_empty() || points.contains(&point))
    }

    /// The selected constraints, ascending.
    pub fn constraints(&self) -> impl Iterator<Item = usize> {
        self.items.keys().copied()
    }

    /// Adds a whole constraint, or removes it.
    pub fn toggle(&mut self, constraint: usize) {
        if self.items.remove(&constraint).is_none() {
            self.items.insert(constraint, BTreeSet::new());
        }
    }

    /// Adds a point, or removes it.
    pub fn toggle_point(&mut self, constraint: usize, point: usize) {
        let points = self.items.entry(constraint).or_default();
        if !points.remove(&point) {
            points.insert(point);
        } else if points.is_empty() {
            self.items.remove(&constraint);
        }
    }

    /// Several points of a constraint; no points is an empty selection.
    pub fn some(constraint: usize, points: impl IntoIterator<Item = usize>) -> Self {
        let points: BTreeSet<usize> = points.into_iter().collect();
        let items = if points.is_empty() { BTreeMap::new() } else { [(constraint, points)].into() };
        Self { items }
    }

    /// Whether a constraint is selected as a whole.
    pub fn is_whole(&self, constraint: usize) -> bool {
        self.items.get(&constraint).is_some_and(BTreeSet::is_empty)
    }

    /// Adds another selection; whole constraints win over points.
    pub fn extend(&mut self, other: &Self) {
        for (&constraint, points) in &other.items {
            match self.items.get_mut(&constraint) {
                Some(own) if own.is_empty() || points.is_empty() => own.clear(),
                Some(own) => own.extend(points),
                None => {
                    self.items.insert(constraint, points.clone());
                }
            }
        }
    }

    /// Removes another selection; `count` is the number of points of a constraint.
    pub fn subtract(&mut self, other: &Self, count: impl Fn(usize) -> usize) {
        for (&constraint, points) in &other.items {
            let Some(own) = self.items.get_mut(&constraint) else { continue };
            if own.is_empty() && !points.is_empty() {
                own.extend(0..count(constraint));
            }
            own.retain(|point| !points.contains(point));
            if points.is_empty() || own.is_empty() {
                self.items.remove(&constraint);
            }
        }
    }

    /// Drops constraints and points that no longer exist; `points` is the number of points of each constraint.
    pub fn keep_within(&mut self, points: &[usize]) {
        self.items.retain(|&constraint, chosen| {
            let Some(&count) = points.get(constraint) else { return false };
            let whole = chosen.is_empty();
            chosen.retain(|&point| point < count);
            whole || !chosen.is_empty()
        });
    }
}
