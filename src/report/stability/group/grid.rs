//! The coarsest grid, the finest, and one of long cells.

use glam::Vec2;

use super::super::Size;
use super::super::case::Case;
use super::super::walk::Walk;
use super::{Group, refused, walk};
use lightloom_core::flow::GridSize;

pub(super) const GROUP: Group = Group { name: "grid", cases };

const WHY: &str = "iterations do not grow with the grid";

fn cases(size: Size) -> Vec<Case> {
    let on = |cells: [u32; 2]| {
        let mut walk = Walk::new(size);
        walk.settings.grid = GridSize::Both(cells);
        walk.settings.steps = size.pick(2, 4);
        walk
    };
    let holds = |cells: [u32; 2]| walk(format!("{} x {}", cells[0], cells[1]), on(cells), WHY);
    // Cells that are square: an eighth of a plane unit over the rows of the grid.
    let mut strip = on([8, size.pick(64, 512)]);
    strip.extent = Vec2::new(8.0 / size.pick(64.0, 512.0), 1.0);
    let narrow = |points: &mut Vec<Vec2>| points.iter_mut().for_each(|p| p.x *= strip.extent.x);
    narrow(&mut strip.source);
    narrow(&mut strip.target);
    let mut cases = vec![
        holds([8, 8]),
        walk(format!("8 x {} on a strip", size.pick(64, 512)), strip, WHY),
        walk(
            format!("8 x {} on a square", size.pick(64, 512)),
            on([8, size.pick(64, 512)]),
            "cells 64 times as long as wide (8 times at reduced size): axes are coarsened one by one until cells are square",
        ),
    ];
    cases.extend(size.pick([[64, 64], [96, 96]], [[512, 512], [1024, 1024]]).map(holds));
    cases.push(refused("4 x 4", on([4, 4]), "flow.grid", "a spline needs room for its boundary"));
    cases.push(refused("100000 x 100000", on([100_000; 2]), "GiB", "more memory than there is"));
    cases
}
