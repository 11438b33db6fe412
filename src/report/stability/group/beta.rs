//! How strongly a directed line pulls: not at all, hardly, and a million times as all photons.

use super::super::Size;
use super::super::case::Case;
use super::super::walk::{Walk, limits};
use super::lines::line;
use super::{Group, refused, within};

pub(super) const GROUP: Group = Group { name: "beta", cases };

fn cases(size: Size) -> Vec<Case> {
    let with = |beta: f32| {
        let mut walk = Walk::new(size);
        walk.settings.beta = beta;
        walk.lines = line(&[[0.2, 0.7], [0.5, 0.3], [0.8, 0.7]], 0.05);
        walk
    };
    let holds = |beta: f32| {
        let walk = with(beta);
        let mut limits =
            limits(&walk.settings, "a line may ask for what the photons do not, so the misfit has no limit");
        if beta > 0.0 {
            limits.energy = None;
        }
        within(format!("{beta:e}"), walk, limits)
    };
    vec![
        holds(0.0),
        holds(1e-6),
        holds(1.0),
        holds(1e6),
        refused("1e7", with(1e7), "flow.beta", "beyond the range of the format"),
    ]
}
