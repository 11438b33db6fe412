//! One step and a thousand; a fade that never, late, or at once takes over.

use super::super::Size;
use super::super::case::{Bound, Case};
use super::super::walk::Walk;
use super::{Group, refused, walk};
use lightloom_core::flow::Fade;

pub(super) const GROUP: Group = Group { name: "steps and fade", cases };

const STEPS: &str = "the end is exact for any number of steps";
const FADE: &str = "in v = (b - c) / (1 - t) the end is regular for every fade that comes before it";
const BENEATH: &str = "beneath the format: still regular, however late";

fn cases(size: Size) -> Vec<Case> {
    let in_steps = |steps: u32| {
        let mut walk = Walk::new(size);
        walk.settings.steps = steps;
        walk
    };
    let faded = |fade: Fade| {
        let mut walk = Walk::new(size);
        walk.settings.fade = fade;
        walk
    };
    let paper = |tau: f32| faded(Fade::Paper { tau });
    let late = "a fade that begins at the end arrives nowhere";
    vec![
        walk("1 step", in_steps(1), STEPS),
        walk("2 steps", in_steps(2), STEPS),
        walk(format!("{} steps", size.pick(100, 1000)), in_steps(size.pick(100, 1000)), STEPS),
        walk("tau 0", paper(0.0), FADE),
        walk("tau 0.5", paper(0.5), FADE),
        walk("tau 0.99, the last that the format takes", paper(0.99), FADE),
        walk("smooth from 0.99 to 1", faded(Fade::Smooth { start: 0.99, end: 1.0, limit: 1000.0 }), FADE),
        walk("smooth from 0 to 0.01", faded(Fade::Smooth { start: 0.0, end: 0.01, limit: 1.0 }), FADE),
        refused("tau 0.999", paper(0.999), "flow.fade.tau", late),
        walk("tau 0.999, beneath the format", paper(0.999), BENEATH),
        refused("tau 1", paper(1.0), "flow.fade.tau", late),
        refused_beneath("tau 1, beneath the format", paper(1.0)),
    ]
}

/// A walk that the stage itself must refuse.
fn refused_beneath(name: &str, walk: Walk) -> Case {
    let why = "1 / (1 - t) has no limit at 1, and a photon that is lost must be told";
    Case::new(name, Bound::Refused { words: "no longer finite", why }, move |progress| walk.run(progress))
}
