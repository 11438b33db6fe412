//! Too few photons to determine a field, and many in one place.

use glam::Vec2;

use super::super::Size;
use super::super::case::Case;
use super::super::walk::{Walk, cloud, disc};
use super::{Group, refused, walk};

pub(super) const GROUP: Group = Group { name: "guide photons", cases };

const FEW: &str = "the bending alone determines the field where no photon is; linear functions that no photon sees are left at \
                   nothing";
const MANY: &str = "the weight of a cell grows with its photons, their mean does not";

fn cases(size: Size) -> Vec<Case> {
    let crowd = size.pick(20_000, 1_000_000);
    let with = |source: Vec<Vec2>, target: Vec<Vec2>| {
        let mut walk = Walk::new(size).with(source, target);
        walk.settings.guides = crowd as u32;
        walk
    };
    let to = |source: &[Vec2], way: Vec2| source.iter().map(|p| *p + way).collect::<Vec<_>>();
    let on_line = |count: usize| (0..count).map(|i| Vec2::new(0.3 + 0.1 * i as f32, 0.4)).collect::<Vec<_>>();
    let few = |count: usize| {
        let source = on_line(count);
        let target = source.iter().map(|p| Vec2::new(p.y, 1.0 - p.x)).collect();
        walk(format!("{count} on a line"), with(source, target), FEW)
    };
    let point = vec![Vec2::new(0.31, 0.42); crowd];
    let apart = with(point.clone(), disc([0.6, 0.6], 0.2, crowd));
    let cell: Vec<Vec2> = cloud(1, crowd).iter().map(|p| Vec2::splat(0.5) + *p / 128.0).collect();
    let clusters = || {
        let halves = [[0.05, 0.05], [0.95, 0.95]].map(|at| disc(at, 0.01, crowd / 2));
        halves.concat()
    };
    let turned: Vec<Vec2> = clusters().iter().map(|p| Vec2::new(1.0 - p.y, p.x)).collect();
    vec![
        few(1),
        few(2),
        few(3),
        walk(
            format!("{crowd} in one point to one point"),
            with(point.clone(), to(&point, Vec2::new(0.3, 0.2))),
            MANY,
        ),
        walk(
            format!("{crowd} in one point to a disc"),
            apart,
            "no field parts what is in one place: the fade does, and they arrive",
        ),
        walk(
            format!("{crowd} in one cell to a disc"),
            with(cell.clone(), disc([0.6, 0.6], 0.2, crowd)),
            MANY,
        ),
        walk("two far clusters", with(clusters(), turned), FEW),
        walk(
            "all beyond the plane",
            with(to(&cell, Vec2::splat(5.0)), cell.clone()),
            "the field goes on beyond its border",
        ),
        refused("none", with(Vec::new(), Vec::new()), "no photons", "there is nothing to move"),
        refused(
            "one not finite",
            with(vec![Vec2::NAN], vec![Vec2::ONE]),
            "not finite",
            "NaN must not spread",
        ),
    ]
}
