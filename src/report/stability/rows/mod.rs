//! The rows of the table, group by group: the name, the input and the bound of each.

mod constraints;
mod fit;
mod flow;
mod meeting;
mod pictures;
mod row;
mod scene;

use crate::effort::Effort;
use row::Row;

/// Rows about one thing.
pub(super) struct Group {
    pub(super) name: &'static str,
    pub(super) rows: fn(Effort) -> Vec<Row>,
}

/// All groups, in the order of the table.
pub(super) const GROUPS: [Group; 12] = [
    Group { name: "gamma and alpha", rows: fit::gamma_and_alpha },
    Group { name: "beta", rows: constraints::beta },
    Group { name: "grid", rows: flow::grid },
    Group { name: "guide photons", rows: flow::guides },
    Group { name: "steps and fade", rows: flow::time },
    Group { name: "turbulence", rows: flow::turbulence },
    Group { name: "target", rows: pictures::target },
    Group { name: "receiver", rows: scene::receiver },
    Group { name: "walls", rows: constraints::walls },
    Group { name: "meeting", rows: meeting::meeting },
    Group { name: "lines", rows: constraints::lines },
    Group { name: "glass", rows: scene::glass },
];
