//! The groups of rows, one file each.

mod beta;
mod glass;
mod grid;
mod guides;
mod lines;
mod receiver;
mod smoothness;
mod target;
mod time;
mod turbulence;
mod walls;

use super::Size;
use super::case::{Bound, Case, Limits};
use super::walk::{self, Walk};

/// Rows about one thing.
pub(super) struct Group {
    pub(super) name: &'static str,
    pub(super) cases: fn(Size) -> Vec<Case>,
}

/// All groups, in the order of the table.
pub(super) const GROUPS: [Group; 11] = [
    smoothness::GROUP,
    beta::GROUP,
    grid::GROUP,
    guides::GROUP,
    time::GROUP,
    turbulence::GROUP,
    target::GROUP,
    receiver::GROUP,
    walls::GROUP,
    lines::GROUP,
    glass::GROUP,
];

/// A walk that must hold what all walks must.
fn walk(name: impl Into<String>, walk: Walk, why: &'static str) -> Case {
    let limits = walk::limits(&walk.settings, why);
    within(name, walk, limits)
}

/// A walk within limits of its own.
fn within(name: impl Into<String>, walk: Walk, limits: Limits) -> Case {
    Case::new(name, Bound::Holds(limits), move |progress| walk.run(progress))
}

/// Settings that the project format must refuse.
fn refused(name: impl Into<String>, walk: Walk, words: &'static str, why: &'static str) -> Case {
    Case::new(name, Bound::Refused { words, why }, move |progress| {
        walk.settings.check("flow")?;
        walk.run(progress)
    })
}
