//! Walls that close, touch, crowd, and leave gaps of a cell.

use glam::Vec2;

use super::super::Size;
use super::super::case::Case;
use super::super::walk::{Walk, cloud, disc, limits};
use super::{Group, within};
use lightloom_core::constraint::{ActiveWall, Wall, Window};

pub(super) const GROUP: Group = Group { name: "walls", cases };

fn wall(points: &[[f32; 2]], thickness: f32) -> Option<ActiveWall> {
    Wall { thickness, ..Wall::new(points.to_vec()) }.active(Window::ALWAYS)
}

fn cases(size: Size) -> Vec<Case> {
    let count = size.pick(500, 50_000);
    let cell = 1.0 / size.pick(32.0, 128.0);
    let low = disc([0.5, 0.25], 0.15, count);
    let high = disc([0.5, 0.75], 0.15, count);
    let case = |name: &str,
                walls: Vec<Option<ActiveWall>>,
                [source, target]: [&Vec<Vec2>; 2],
                shut_off: [usize; 2]| {
        let walls = walls.into_iter().flatten().collect();
        let walk = Walk { walls, ..Walk::new(size).with(source.clone(), target.clone()) };
        let mut limits = limits(
            &walk.settings,
            "no photon crosses a wall that a way leads around; whom none reaches is counted",
        );
        // The mean way around is longer than the straight one, but a minimum is still below nothing at all.
        limits.unreachable = Some(shut_off);
        within(name, walk, limits)
    };
    let square = [[0.3, 0.05], [0.7, 0.05], [0.7, 0.45], [0.3, 0.45], [0.3, 0.05]];
    let (left, right) = (disc([0.25, 0.75], 0.1, count), disc([0.75, 0.75], 0.1, count));
    let halves = |gap: f32, thickness: f32| {
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
    let on: Vec<Vec2> = (0..count).map(|i| Vec2::new(0.5, 0.1 + 0.3 * i as f32 / count as f32)).collect();
    vec![
        case("closed around the light", vec![wall(&square, 0.02)], [&low, &high], [count, count]),
        case(
            "touching in a T",
            vec![wall(&[[-0.1, 0.5], [1.1, 0.5]], 0.01), wall(&[[0.5, 0.5], [0.5, 1.1]], 0.01)],
            [&left, &right],
            [count, count],
        ),
        case("500 of them", many.collect(), [&low, &high], [0, count / 10]),
        case("a gap of one cell, thin walls", halves(cell, 0.5 * cell), [&low, &high], [0, 0]),
        case("a gap of one cell, thick walls", halves(cell, 3.0 * cell), [&low, &high], [count, count]),
        case("a gap of a hundredth of a cell", halves(0.01 * cell, 1e-4), [&low, &high], [0, count]),
        case("through the light and its target", through.clone(), [&low, &high], [0, 0]),
        case("light on the wall itself", through, [&on, &high], [0, 0]),
    ]
}
