//! Moves that walls turn.

use glam::Vec2;

use crate::constraint::barrier::Barriers;

/// Distance from a wall at which a turned move goes on, plane units: far above rounding, far below a cell.
const MARGIN: f32 = 1e-5;
/// Limit of walls that turn one move.
const TURNS: usize = 3;

/// The end of a move from `c` by `drift` that slides along the walls it meets.
pub(crate) fn slide(barriers: &Barriers, c: Vec2, drift: Vec2) -> Vec2 {
    turned(barriers, (c, drift), |left, along| along * left.dot(along))
}

/// The end of a move from `c` by `by` that the walls it meets mirror: light that spreads evenly stays even beside them, where it
/// would pile up if it slid or stopped.
pub(crate) fn bounce(barriers: &Barriers, c: Vec2, by: Vec2) -> Vec2 {
    turned(barriers, (c, by), |left, along| left.reflect(along.perp()))
}

/// The end of a move from `c` by `by`, of which each wall it meets turns what is left; `turn` has that and the direction of
/// the wall.
fn turned(barriers: &Barriers, (mut c, mut by): (Vec2, Vec2), turn: impl Fn(Vec2, Vec2) -> Vec2) -> Vec2 {
    for _ in 0..TURNS {
        let Some(contact) = barriers.first_contact(c, c + by) else { return c + by };
        let along = contact.edge.direction();
        let normal = along.perp();
        let side = if by.dot(normal) > 0.0 { -normal } else { normal };
        let near = c + by * contact.share + side * MARGIN;
        if barriers.blocks(c, near) {
            return c;
        }
        by = turn(by * (1.0 - contact.share), along);
        c = near;
    }
    c
}

#[cfg(test)]
mod tests {
    use glam::vec2;

    use super::*;
    use crate::constraint::barrier::tests::wall;
    use crate::math::rng::{Purpose, Stream};

    #[test]
    fn even_light_stays_even_beside_a_wall_and_on_its_side() {
        let wall = wall(&[[0.5, -1.0], [0.5, 2.0]], 0.0);
        let barriers = Barriers::new(&[&wall], vec2(1.0, 1.0));
        let mut stream = Stream::new(1, Purpose::Match, 0, 0);
        let count = 100_000;
        let mut beside = [0, 0];
        for _ in 0..count {
            let from = vec2(0.3 + 0.2 * stream.f32(), 0.5);
            let angle = std::f32::consts::TAU * stream.f32();
            let to = bounce(&barriers, from, 0.05 * stream.f32() * Vec2::from_angle(angle));
            assert!(to.x < 0.5, "from {from} through the wall to {to}");
            beside[0] += usize::from(to.x > 0.48);
            beside[1] += usize::from(to.x > 0.42 && to.x < 0.44);
        }
        // Ten thousand in each strip: even to four standard deviations of their difference.
        assert!(beside[0].abs_diff(beside[1]) < 560, "{beside:?}");
    }
}
