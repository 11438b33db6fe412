//! Rows of light that meets half way: what a plan must find its way through.

use glam::Vec2;

use super::row::Expected::Holds;
use super::row::Row;
use crate::effort::Effort;
use crate::stability::flow_case::disc;
use crate::stability::meeting_case::MeetingCase;
use lightloom_core::constraint::{ActiveWall, Wall, Window};
use lightloom_core::continuity::PHOTONS;

/// Thickness of the walls, plane units.
const THICKNESS: f32 = 0.02;

fn row(
    name: impl Into<String>,
    why: &'static str,
    change: impl FnOnce(&mut MeetingCase, usize) + 'static,
) -> Row {
    Row::new(name, Holds(why), |effort| {
        let mut case = MeetingCase::new(effort);
        let count = case.source.len();
        change(&mut case, count);
        case
    })
}

fn wall(points: &[[f32; 2]]) -> Vec<ActiveWall> {
    Wall { thickness: THICKNESS, ..Wall::new(points.to_vec()) }.active(Window::ALWAYS).into_iter().collect()
}

/// A wall all over the plane, but for a slit in its middle.
fn slit(width: f32) -> Vec<ActiveWall> {
    let half = 0.5 * (width + THICKNESS);
    [wall(&[[0.5, -0.1], [0.5, 0.5 - half]]), wall(&[[0.5, 0.5 + half], [0.5, 1.1]])].concat()
}

/// Slits and caps, light far apart and in one place, and settings at their ends.
pub(super) fn meeting(effort: Effort) -> Vec<Row> {
    [around_walls(effort), light(), settings()].into_iter().flatten().collect()
}

fn around_walls(effort: Effort) -> Vec<Row> {
    const SLIT: &str = "a slit takes what it takes, and light that is late makes up for it on a detour";
    const CAP: &str = "light as dense as at the keys may be no denser on the way: the last of it is late";
    const FAR: &str = "a wall that no light comes near changes nothing but the method";
    const CLOSED: &str = "light that is shut off goes straight and is counted";
    let (cell, all) = (MeetingCase::cell(effort), MeetingCase::new(effort).source.len().min(PHOTONS));
    let through = move |cells: f32| {
        let walls = move |case: &mut MeetingCase, _| case.walls = slit(cells * cell);
        row(format!("a slit of {cells} cells"), SLIT, walls)
    };
    let around = [[0.55, 0.3], [0.95, 0.3], [0.95, 0.7], [0.55, 0.7], [0.55, 0.3]];
    vec![
        through(1.0),
        through(2.0),
        through(4.0),
        row("a slit of 4 cells, density 1", CAP, move |case, _| {
            (case.walls, case.settings.density) = (slit(4.0 * cell), 1.0);
        }),
        row("no wall", "the plan is free", |_, _| ()),
        row("a wall far from all light", FAR, |case, _| case.walls = wall(&[[0.02, 0.02], [0.02, 0.1]])),
        row("a closed wall around the target", CLOSED, move |case, _| case.walls = wall(&around)).limited(
            move |limits| {
                limits.unreachable = Some([all; 2]);
                (limits.misplaced, limits.gap) = (None, None);
            },
        ),
    ]
}

fn light() -> Vec<Row> {
    const ONE: &str = "no field parts what is in one place: the gap is made up for on the way";
    const FEW: &str = "density of few photons is that of points";
    let point = |count: usize| vec![Vec2::new(0.31, 0.42); count];
    let cell = |at: [f32; 2], count: usize| disc(at, 1e-3, count);
    vec![
        row("far corners", "the longest way there is", move |case, count| {
            (case.source, case.target) = (disc([0.02; 2], 0.01, count), disc([0.98; 2], 0.01, count));
        }),
        row("one cell to a disc", ONE, move |case, count| case.source = cell([0.3, 0.4], count))
            .limited(|limits| limits.gap = None),
        row("a disc to one cell", ONE, move |case, count| case.target = cell([0.3, 0.4], count))
            .limited(|limits| limits.gap = None),
        row("one cell to one cell", ONE, move |case, count| {
            (case.source, case.target) = (cell([0.3, 0.4], count), cell([0.8, 0.7], count));
        }),
        row("one place to a disc", ONE, move |case, count| case.source = point(count))
            .limited(|limits| limits.gap = None),
        row("one photon", FEW, |case, _| {
            (case.source, case.target) = (vec![Vec2::new(0.1, 0.2)], vec![Vec2::new(0.9, 0.7)]);
        }),
        row("three photons", FEW, |case, _| {
            (case.source, case.target) = (disc([0.2, 0.2], 0.1, 3), disc([0.7, 0.6], 0.2, 3));
        }),
    ]
}

fn settings() -> Vec<Row> {
    const END: &str = "the end is exact whatever the field is like";
    let with = |name: &str, change: fn(&mut MeetingCase)| row(name, END, move |case, _| change(case));
    let loose = |row: Row| row.limited(|limits| limits.gap = None);
    vec![
        with("gamma 0", |case| case.settings.gamma = 0.0),
        with("gamma 1", |case| case.settings.gamma = 1.0),
        loose(with("alpha 1e6", |case| case.settings.alpha = 1e6)),
        with("alpha 1e-12", |case| case.settings.alpha = 1e-12),
        with("hold 0.04", |case| case.settings.hold = 0.04),
        with("hold 0.2", |case| case.settings.hold = 0.2),
        loose(with("1 step", |case| case.settings.steps = 1)),
        with("3 steps", |case| case.settings.steps = 3),
    ]
}
