//! Glass vessels from their profiles in millimetres, and the liquid in them.
//!
//! A vessel is one closed surface. Its profile runs from the axis below the foot outwards and up the outer wall, over the lip,
//! down the inner wall, and along the floor of the hollow back to the axis.

use glam::DVec2;

use crate::curve::{Curve, Fineness, Station, offset};
use crate::loft::{loft, round, superellipse};
use crate::mesh::Mesh;

const METRES: f64 = 1e-3;
const FINENESS: Fineness = Fineness { step: 3.8, turn: 0.25 };
const SIDES: usize = 96;
/// For liquids whose walls lie hidden in the glass: facets there are never seen, and need only stay within it.
const HIDDEN: Fineness = Fineness { step: 8.0, turn: 0.4 };
const HIDDEN_SIDES: usize = 48;

/// Control points of a hollow vessel: radius and height in millimetres.
pub(crate) struct Vessel {
    /// From the axis below to the wall: underside, foot and stem.
    pub foot: &'static [(f64, f64)],
    /// The outer wall, upwards. The inner wall follows it at `thickness`.
    pub wall: &'static [(f64, f64)],
    /// Thickness of the wall.
    pub thickness: f64,
    /// From the outer to the inner wall.
    pub lip: &'static [(f64, f64)],
    /// From the inner wall to the axis.
    pub floor: &'static [(f64, f64)],
    /// Cross-section of all surfaces.
    pub section: Section,
}

/// How a vessel differs from a surface of revolution.
pub(crate) enum Section {
    /// Not at all.
    Round,
    /// A superellipse below, a circle above.
    Squared {
        /// Of the superellipse: 2 is round, larger is squarer.
        exponent: f64,
        /// Between which it becomes round.
        heights: [f64; 2],
    },
    /// Soft ribs in the inner wall, as in optic-blown glass: each is a lens.
    Ribbed {
        /// Ribs around.
        count: f64,
        /// Greatest share of the radius by which they rise and fall.
        depth: f64,
        /// Where they begin to grow, are grown, begin to fade, have faded.
        heights: [f64; 4],
    },
}

impl Vessel {
    /// The mesh in metres, standing on y = 0.
    pub(crate) fn mesh(&self) -> Mesh {
        let profile = grounded(self.profile(), self.ground());
        lofted(&profile, |angle, height, inside| self.section.radius(angle, height, inside), SIDES)
    }

    /// The liquid that fills the vessel up to `surface`, the control points from the wall to the axis.
    pub(crate) fn liquid(&self, surface: &[(f64, f64)]) -> Mesh {
        lofted(&self.liquid_profile(surface, FINENESS), round, SIDES)
    }

    /// The same for a vessel that is not round, or a liquid that is looked at from the side only: fewer triangles.
    pub(crate) fn filling(&self, surface: &[(f64, f64)]) -> Mesh {
        let profile = self.liquid_profile(surface, HIDDEN);
        lofted(&profile, |angle, height, _| self.section.radius(angle, height, false), HIDDEN_SIDES)
    }

    fn liquid_profile(&self, surface: &[(f64, f64)], fineness: Fineness) -> Vec<Station> {
        let half = self.thickness / 2.0;
        let floor = self.floor.iter().rev().map(|&(x, y)| DVec2::new(x, y - half));
        let level = surface[0].1;
        let wall = offset(&points(self.wall), half).into_iter().filter(|p| p.y < level - 2.0);
        let control: Vec<_> = floor.chain(wall).chain(points(surface)).collect();
        grounded(Curve::profile(&control).stations(fineness), self.ground())
    }

    /// Height of the lowest point of the foot.
    fn ground(&self) -> f64 {
        self.profile().iter().map(|s| s.point.y).fold(f64::INFINITY, f64::min)
    }

    fn profile(&self) -> Vec<Station> {
        let wall = points(self.wall);
        let inner = offset(&wall, self.thickness).into_iter().rev();
        let mut control = points(self.foot);
        control.extend(&wall);
        control.extend(points(self.lip));
        control.extend(inner);
        control.extend(points(self.floor));
        Curve::profile(&control).stations(FINENESS)
    }
}

impl Section {
    /// Factor on the radius of the profile, twice differentiable.
    fn radius(&self, angle: f64, height: f64, inside: bool) -> f64 {
        match *self {
            Self::Squared { exponent, heights: [low, high] } => {
                superellipse(exponent + (2.0 - exponent) * smooth((height - low) / (high - low)), angle)
            }
            Self::Ribbed { count, depth, heights: [low, grown, fading, high] } if inside => {
                let rise = smooth((height - low) / (grown - low));
                let fall = smooth((height - fading) / (high - fading));
                1.0 + depth * (rise - fall) * libm::cos(count * angle)
            }
            Self::Round | Self::Ribbed { .. } => 1.0,
        }
    }
}

/// Step from 0 at 0 to 1 at 1 with two continuous derivatives.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)
}

/// The profile moved down by `ground`.
fn grounded(mut profile: Vec<Station>, ground: f64) -> Vec<Station> {
    profile.iter_mut().for_each(|s| s.point.y -= ground);
    profile
}

fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
    list.iter().copied().map(DVec2::from).collect()
}

fn lofted(profile: &[Station], section: impl Fn(f64, f64, bool) -> f64, sides: usize) -> Mesh {
    let mut mesh = loft(profile, section, sides);
    mesh.positions.iter_mut().for_each(|p| *p *= METRES);
    mesh
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::glassware::{BOTTLE_ROUND, BOTTLE_SQUARE, BOTTLE_TALL, GOBLET, WINE, WINE_GLASS};

    /// Length of the way through glass from a station of the profile straight inwards.
    fn glass_behind(profile: &[Station], i: usize) -> f64 {
        let (from, inwards) = (profile[i].point, profile[i].tangent.perp());
        let mut nearest = f64::INFINITY;
        for k in (0..profile.len() - 1).filter(|k| k.abs_diff(i) > 2) {
            let (a, b) = (profile[k].point, profile[k + 1].point);
            let side = b - a;
            let along = (a - from).perp_dot(side) / inwards.perp_dot(side);
            let across = (a - from).perp_dot(inwards) / inwards.perp_dot(side);
            if along > 0.0 && (0.0..=1.0).contains(&across) {
                nearest = nearest.min(along);
            }
        }
        nearest
    }

    #[test]
    fn walls_are_as_thick_as_they_should_be() {
        for vessel in [&WINE_GLASS, &GOBLET, &BOTTLE_ROUND, &BOTTLE_TALL, &BOTTLE_SQUARE] {
            let profile = vessel.profile();
            let thinnest =
                (1..profile.len() - 1).map(|i| glass_behind(&profile, i)).fold(f64::INFINITY, f64::min);
            // The lip is rounded and the offset of a spline polygon only nearly that of its curve.
            assert!(thinnest > 0.75 * vessel.thickness, "{thinnest} of {}", vessel.thickness);
        }
    }

    #[test]
    fn the_bowl_of_the_wine_glass_is_evenly_thin() {
        let profile = WINE_GLASS.profile();
        let bowl = (1..profile.len())
            .filter(|&i| profile[i].tangent.y > 0.3 && (110.0..215.0).contains(&profile[i].point.y));
        for i in bowl {
            assert!((glass_behind(&profile, i) - 1.2).abs() < 0.06, "{:?}", profile[i]);
        }
    }

    #[test]
    fn the_wine_overlaps_the_glass_but_stays_within_it() {
        let wine = WINE_GLASS.liquid(&WINE);
        let glass = WINE_GLASS.mesh();
        let wetted = wine.positions.iter().filter(|p| p.y < 0.137 && p.z == 0.0);
        for p in wetted {
            let nearest = glass.positions.iter().map(|q| p.distance(*q)).fold(f64::INFINITY, f64::min);
            // In the middle of the wall, 0.6 mm from both its sides, whose vertices are up to 6 mm apart.
            assert!((4e-4..3.1e-3).contains(&nearest), "{p} is {nearest} from the glass");
        }
        // A glass of wine: between 0.1 and 0.2 litres.
        assert!((1e-4..2e-4).contains(&wine.volume()), "{}", wine.volume());
    }
}
