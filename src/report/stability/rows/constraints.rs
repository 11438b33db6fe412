//! Rows of directed lines and walls.

use glam::Vec2;

use super::row::Expected::{Holds, Refused};
use super::row::Row;
use crate::effort::Effort;
use crate::stability::flow_case::{cloud, disc};
use lightloom_core::constraint::{ActiveLine, ActiveWall, DirectedLine, Wall, Window};

/// A line as the fit sees it, on the unit square.
fn line(points: &[[f32; 2]], width: f32) -> Vec<ActiveLine> {
    let line = DirectedLine { width, ..DirectedLine::new(points.to_vec()) };
    line.active(Window::ALWAYS, Vec2::ONE).into_iter().collect()
}

fn wall(points: &[[f32; 2]], thickness: f32) -> Vec<ActiveWall> {
    let wall = Wall { thickness, ..Wall::new(points.to_vec()) };
    wall.active(Window::ALWAYS).into_iter().collect()
}

/// How strongly a directed line pulls: not at all, hardly, and a million times as all photons.
pub(super) fn beta(_: Effort) -> Vec<Row> {
    const WHY: &str = "a line may ask for what the photons do not, so the misfit has no limit";
    let row = |name: &str, expected, beta: f32| {
        Row::flow(name, expected, move |flow| {
            flow.settings.beta = beta;
            flow.lines = line(&[[0.2, 0.7], [0.5, 0.3], [0.8, 0.7]], 0.05);
        })
    };
    let pulls = |name, beta| row(name, Holds(WHY), beta).limited(|limits| limits.energy = None);
    vec![
        row("0e0", Holds(WHY), 0.0),
        pulls("1e-6", 1e-6),
        pulls("1e0", 1.0),
        pulls("1e6", 1e6),
        row("1e7", Refused("flow.beta", "beyond the range of the format"), 1e7),
    ]
}

/// Directed lines that contradict each other, and one that goes round in a point.
pub(super) fn lines(_: Effort) -> Vec<Row> {
    const WHY: &str = "what cannot be had together is shared by least squares";
    let (left, right) = ([0.2, 0.5], [0.8, 0.5]);
    let star = (0..8).flat_map(|i| {
        let end = Vec2::splat(0.5) + 0.3 * Vec2::from_angle(i as f32 * std::f32::consts::FRAC_PI_4);
        line(&[[0.5, 0.5], end.to_array()], 0.05)
    });
    let spiral: Vec<[f32; 2]> = (0..200)
        .map(|i| (Vec2::splat(0.5) + 1e-4 * i as f32 * Vec2::from_angle(0.3 * i as f32)).to_array())
        .collect();
    let against = |width| [line(&[left, right], width), line(&[right, left], width)].concat();
    let across = [line(&[left, right], 0.05), line(&[[0.5, 0.2], [0.5, 0.8]], 0.05)].concat();
    let drawn = [
        ("one against the other in the same place", against(0.05)),
        ("across each other", across),
        ("eight out of one point", star.collect()),
        ("a spiral within two cells", line(&spiral, 0.001)),
        ("as wide as the plane", against(1.0)),
    ];
    let row = |name: &str, lines: Vec<ActiveLine>, beta: f32| {
        let draw = move |flow: &mut crate::stability::flow_case::FlowCase| {
            (flow.lines, flow.settings.beta) = (lines, beta);
        };
        Row::flow(format!("{name}, beta {beta:e}"), Holds(WHY), draw).limited(|limits| limits.energy = None)
    };
    drawn
        .into_iter()
        .flat_map(|(name, lines)| [1.0, 1e6].map(|beta| row(name, lines.clone(), beta)))
        .collect()
}

/// Walls that close, touch, crowd, and leave gaps of a cell.
pub(super) fn walls(effort: Effort) -> Vec<Row> {
    const WHY: &str =
        "no photon crosses a wall that a path leads around; photons that none reaches are counted";
    let count: usize = effort.pick(500, 50_000);
    let cell = 1.0 / effort.pick(32.0, 128.0);
    let row = |name: &str, walls: Vec<Vec<ActiveWall>>, photons: [&Vec<Vec2>; 2], unreachable: [usize; 2]| {
        let [source, target] = photons.map(Vec::clone);
        Row::flow(name, Holds(WHY), move |flow| {
            (flow.source, flow.target, flow.walls) = (source, target, walls.concat());
        })
        // The mean path around is longer than the straight one, but a minimum is still below nothing at all.
        .limited(move |limits| limits.unreachable = Some(unreachable))
    };
    let [low, high] = [0.25, 0.75].map(|y| disc([0.5, y], 0.15, count));
    let [left, right] = [0.25, 0.75].map(|x| disc([x, 0.75], 0.1, count));
    let on = (0..count).map(|i| Vec2::new(0.5, 0.1 + 0.3 * i as f32 / count as f32)).collect();
    let square = wall(&[[0.3, 0.05], [0.7, 0.05], [0.7, 0.45], [0.3, 0.45], [0.3, 0.05]], 0.02);
    let tee = vec![wall(&[[-0.1, 0.5], [1.1, 0.5]], 0.01), wall(&[[0.5, 0.5], [0.5, 1.1]], 0.01)];
    let gap = |gap: f32, thickness: f32| {
        vec![
            wall(&[[-0.1, 0.5], [0.5 - 0.5 * gap, 0.5]], thickness),
            wall(&[[0.5 + 0.5 * gap, 0.5], [1.1, 0.5]], thickness),
        ]
    };
    let crowd = cloud(3, 1000);
    let many = crowd.chunks_exact(2).map(|p| {
        let end = p[0] + 0.03 * (p[1] - Vec2::splat(0.5)).normalize_or(Vec2::X);
        wall(&[p[0].to_array(), end.to_array()], 0.002)
    });
    let through = vec![wall(&[[0.5, 0.1], [0.5, 0.4]], 0.02), wall(&[[0.4, 0.75], [0.6, 0.75]], 0.02)];
    let up = [&low, &high];
    vec![
        row("closed around the light", vec![square], up, [count, count]),
        row("touching in a T", tee, [&left, &right], [count, count]),
        row("500 of them", many.collect(), up, [0, count / 10]),
        row("a gap of one cell, thin walls", gap(cell, 0.5 * cell), up, [0, 0]),
        row("a gap of one cell, thick walls", gap(cell, 3.0 * cell), up, [count, count]),
        row("a gap of a hundredth of a cell", gap(0.01 * cell, 1e-4), up, [0, count]),
        row("through the light and its target", through.clone(), up, [0, 0]),
        row("light on the wall itself", through, [&on, &high], [0, 0]),
    ]
}
