//! Directed lines that contradict each other, and one that goes round in a point.

use super::super::Size;
use super::super::case::Case;
use super::super::walk::{Walk, limits};
use super::{Group, within};
use glam::Vec2;
use lightloom_core::constraint::{ActiveLine, DirectedLine, Window};

pub(super) const GROUP: Group = Group { name: "lines", cases };

/// A line as the fit sees it, on the unit square.
pub(super) fn line(points: &[[f32; 2]], width: f32) -> Vec<ActiveLine> {
    let line = DirectedLine { width, ..DirectedLine::new(points.to_vec()) };
    line.active(Window::ALWAYS, Vec2::ONE).into_iter().collect()
}

fn cases(size: Size) -> Vec<Case> {
    let (left, right) = ([0.2, 0.5], [0.8, 0.5]);
    let star = (0..8).flat_map(|i| {
        let end = Vec2::splat(0.5) + 0.3 * Vec2::from_angle(i as f32 * std::f32::consts::FRAC_PI_4);
        line(&[[0.5, 0.5], end.to_array()], 0.05)
    });
    let spiral: Vec<[f32; 2]> = (0..200)
        .map(|i| (Vec2::splat(0.5) + 1e-4 * i as f32 * Vec2::from_angle(0.3 * i as f32)).to_array())
        .collect();
    let drawn = [
        (
            "one against the other in the same place",
            [line(&[left, right], 0.05), line(&[right, left], 0.05)].concat(),
        ),
        ("across each other", [line(&[left, right], 0.05), line(&[[0.5, 0.2], [0.5, 0.8]], 0.05)].concat()),
        ("eight out of one point", star.collect()),
        ("a spiral within two cells", line(&spiral, 0.001)),
        ("as wide as the plane", [line(&[left, right], 1.0), line(&[right, left], 1.0)].concat()),
    ];
    let betas = [1.0_f32, 1e6];
    drawn
        .into_iter()
        .flat_map(|(name, lines)| {
            betas.map(|beta| {
                let mut walk = Walk { lines: lines.clone(), ..Walk::new(size) };
                walk.settings.beta = beta;
                let mut limits =
                    limits(&walk.settings, "what cannot be had together is shared by least squares");
                limits.energy = None;
                within(format!("{name}, beta {beta:e}"), walk, limits)
            })
        })
        .collect()
}
