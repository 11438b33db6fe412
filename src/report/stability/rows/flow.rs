//! Rows of the flow itself: its grid, its photons, its steps and its turbulence.

use glam::Vec2;

use super::row::Expected::{Fails, Holds, Refused};
use super::row::Row;
use crate::effort::Effort;
use crate::stability::flow_case::{FlowCase, cloud, disc};
use lightloom_core::flow::{Fade, GridSize, TurbulenceSettings};

/// The coarsest grid, the finest, and one of long cells.
pub(super) fn grid(effort: Effort) -> Vec<Row> {
    const WHY: &str = "iterations do not grow with the grid";
    const LONG: &str = "cells 64 times as long as wide (8 times at reduced size): axes are coarsened one by one until cells are square";
    let on = move |cells: [u32; 2]| {
        move |flow: &mut FlowCase| {
            flow.settings.grid = GridSize::Both(cells);
            flow.settings.steps = effort.pick(2, 4);
        }
    };
    let square = |[x, y]: [u32; 2]| Row::flow(format!("{x} x {y}"), Holds(WHY), on([x, y]));
    let long = [8, effort.pick(64, 512)];
    let strip = move |flow: &mut FlowCase| {
        on(long)(flow);
        // Square cells: 1/8 of the width along x, one row along y.
        flow.extent.x = 8.0 / long[1] as f32;
        flow.source.iter_mut().chain(&mut flow.target).for_each(|p| p.x *= 8.0 / long[1] as f32);
    };
    let [fine, finest] = effort.pick([[64, 64], [96, 96]], [[512, 512], [1024, 1024]]);
    vec![
        square([8, 8]),
        Row::flow(format!("8 x {} on a strip", long[1]), Holds(WHY), strip),
        Row::flow(format!("8 x {} on a square", long[1]), Holds(LONG), on(long)),
        square(fine),
        square(finest),
        Row::flow("4 x 4", Refused("flow.grid", "a spline needs room for its boundary"), on([4, 4])),
        Row::flow("100000 x 100000", Refused("GiB", "more memory than there is"), on([100_000; 2])),
    ]
}

/// Too few photons to determine a field, and many in one place.
pub(super) fn guides(effort: Effort) -> Vec<Row> {
    const FEW: &str = "the bending alone determines the field where no photon is; linear functions that no photon sees are \
                       left at nothing";
    const MANY: &str = "the weight of a cell grows with its photons, their mean does not";
    const APART: &str = "no field parts what is in one place: the fade does, and they arrive";
    const BEYOND: &str = "the field goes on beyond its border";
    let crowd: usize = effort.pick(20_000, 1_000_000);
    type Points = Vec<Vec2>;
    let row = |name: String, expected, photons: Box<dyn Fn() -> (Points, Points)>| {
        Row::flow(name, expected, move |flow| {
            (flow.source, flow.target) = photons();
            flow.settings.guides = crowd as u32;
        })
    };
    let few = |count: usize| {
        let source = move || (0..count).map(|i| Vec2::new(0.3 + 0.1 * i as f32, 0.4));
        let turned = |p: Vec2| Vec2::new(p.y, 1.0 - p.x);
        let photons = move || (source().collect(), source().map(turned).collect());
        row(format!("{count} on a line"), Holds(FEW), Box::new(photons))
    };
    let moved = |points: &Points, by: Vec2| points.iter().map(|p| *p + by).collect::<Points>();
    let point = move || vec![Vec2::new(0.31, 0.42); crowd];
    let cell = move || cloud(1, crowd).iter().map(|p| Vec2::splat(0.5) + *p / 128.0).collect::<Points>();
    let to_disc = move || disc([0.6, 0.6], 0.2, crowd);
    let clusters = move || [[0.05, 0.05], [0.95, 0.95]].map(|at| disc(at, 0.01, crowd / 2)).concat();
    let turned = move || clusters().iter().map(|p| Vec2::new(1.0 - p.y, p.x)).collect();
    let to_point = move || moved(&point(), Vec2::new(0.3, 0.2));
    let outside = move || moved(&cell(), Vec2::splat(5.0));
    let named = |what: &str| format!("{crowd} in one {what}");
    vec![
        few(1),
        few(2),
        few(3),
        row(named("point to one point"), Holds(MANY), Box::new(move || (point(), to_point()))),
        row(named("point to a disc"), Holds(APART), Box::new(move || (point(), to_disc()))),
        row(named("cell to a disc"), Holds(MANY), Box::new(move || (cell(), to_disc()))),
        row("two far clusters".to_owned(), Holds(FEW), Box::new(move || (clusters(), turned()))),
        row("all beyond the plane".to_owned(), Holds(BEYOND), Box::new(move || (outside(), cell()))),
        row(
            "none".to_owned(),
            Refused("no photons", "there is nothing to move"),
            Box::new(|| (Vec::new(), Vec::new())),
        ),
        row(
            "one not finite".to_owned(),
            Refused("not finite", "NaN must not spread"),
            Box::new(|| (vec![Vec2::NAN], vec![Vec2::ONE])),
        ),
    ]
}

/// One step and a thousand; a fade that never, late, or at once takes over.
pub(super) fn time(effort: Effort) -> Vec<Row> {
    const STEPS: &str = "the end is exact for any number of steps";
    const FADE: &str = "in v = (b - c) / (1 - t) the end is regular for every fade that comes before it";
    const BENEATH: &str = "beneath the format: still regular, however late";
    const LATE: &str = "a fade that begins at the end arrives nowhere";
    const LOST: &str = "1 / (1 - t) has no limit at 1, and a photon that is lost must be told";
    let steps = |steps: u32| move |flow: &mut FlowCase| flow.settings.steps = steps;
    let fade = |fade: Fade| move |flow: &mut FlowCase| flow.settings.fade = fade;
    let paper = |tau: f32| fade(Fade::Paper { tau });
    let smooth = |start, end, limit| fade(Fade::Smooth { start, end, limit });
    let many = effort.pick(100, 1000);
    vec![
        Row::flow("1 step", Holds(STEPS), steps(1)),
        Row::flow("2 steps", Holds(STEPS), steps(2)),
        Row::flow(format!("{many} steps"), Holds(STEPS), steps(many)),
        Row::flow("tau 0", Holds(FADE), paper(0.0)),
        Row::flow("tau 0.5", Holds(FADE), paper(0.5)),
        Row::flow("tau 0.99, the last that the format takes", Holds(FADE), paper(0.99)),
        Row::flow("smooth from 0.99 to 1", Holds(FADE), smooth(0.99, 1.0, 1000.0)),
        Row::flow("smooth from 0 to 0.01", Holds(FADE), smooth(0.0, 0.01, 1.0)),
        Row::flow("tau 0.999", Refused("flow.fade.tau", LATE), paper(0.999)),
        Row::flow("tau 0.999, beneath the format", Holds(BENEATH), paper(0.999)),
        Row::flow("tau 1", Refused("flow.fade.tau", LATE), paper(1.0)),
        Row::flow("tau 1, beneath the format", Fails("no longer finite", LOST), paper(1.0)),
    ]
}

/// Swirls: none, the default, and a hundred planes from one key to the next.
pub(super) fn turbulence(_: Effort) -> Vec<Row> {
    const WHY: &str = "noise is divergence-free and fades before the end, so all arrive";
    const RANGE: &str = "beyond the range of the format";
    let noise = |strength: f32, grids: &'static [u32]| {
        move |flow: &mut FlowCase| {
            let grids = grids.to_vec();
            let settings = TurbulenceSettings { strength, grids, ..TurbulenceSettings::default() };
            flow.settings.turbulence = Some(settings);
        }
    };
    vec![
        Row::flow("0", Holds(WHY), noise(0.0, &[30])),
        Row::flow("20", Holds(WHY), noise(20.0, &[30])),
        Row::flow("1000, the most that the format takes", Holds(WHY), noise(1000.0, &[30])),
        Row::flow("1000 on eight grids", Holds(WHY), noise(1000.0, &[4, 8, 16, 32, 64, 128, 256, 512])),
        Row::flow("1e4", Refused("flow.turbulence.strength", RANGE), noise(1e4, &[30])),
        Row::flow("1e4, beneath the format", Holds(WHY), noise(1e4, &[30])),
    ]
}

/// Photons that do not move, and photons that hardly do.
pub(super) fn rest(_: Effort) -> Vec<Row> {
    let same = |flow: &mut FlowCase| flow.target = flow.source.clone();
    // Half a plane unit apart, no more than rounding moves them.
    let rounded =
        |flow: &mut FlowCase| flow.target = flow.source.iter().map(|p| *p * (1.0 + f32::EPSILON)).collect();
    vec![
        Row::flow("the source itself", Holds("nothing moves, and no number is 0/0"), same),
        Row::flow("the source but for rounding", Holds("paths of 1e-8 are paths like others"), rounded),
    ]
}
