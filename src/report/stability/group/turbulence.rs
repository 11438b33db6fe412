//! Swirls: none, the default, and a hundred planes from one key to the next.

use super::super::Size;
use super::super::case::Case;
use super::super::walk::{Walk, limits};
use super::{Group, refused, within};
use lightloom_core::flow::TurbulenceSettings;

pub(super) const GROUP: Group = Group { name: "turbulence", cases };

fn cases(size: Size) -> Vec<Case> {
    let with = |strength: f32, grids: &[u32]| {
        let mut walk = Walk::new(size);
        walk.settings.turbulence =
            Some(TurbulenceSettings { strength, grids: grids.to_vec(), ..TurbulenceSettings::default() });
        walk
    };
    let holds = |name: &str, walk: Walk| {
        let limits =
            limits(&walk.settings, "noise is divergence-free and fades before the end, so all arrive");
        within(name, walk, limits)
    };
    vec![
        holds("0", with(0.0, &[30])),
        holds("20", with(20.0, &[30])),
        holds("1000, the most that the format takes", with(1000.0, &[30])),
        holds("1000 on eight grids", with(1000.0, &[4, 8, 16, 32, 64, 128, 256, 512])),
        refused("1e4", with(1e4, &[30]), "flow.turbulence.strength", "beyond the range of the format"),
        holds("1e4, beneath the format", with(1e4, &[30])),
    ]
}
