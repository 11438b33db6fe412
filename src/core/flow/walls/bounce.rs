//! Moves that walls mirror.

use glam::Vec2;

use super::walker::{MARGIN, SLIDES};
use crate::constraint::barrier::Barriers;

/// The end of a move from `c` by `by` that the walls it meets mirror: light that spreads evenly stays even beside them, where it
/// would pile up if it [slid](super::slide) or stopped.
pub(crate) fn bounce(barriers: &Barriers, mut c: Vec2, mut by: Vec2) -> Vec2 {
    for _ in 0..SLIDES {
        let Some(contact) = barriers.first_contact(c, c + by) else { return c + by };
        let normal = contact.edge.direction().perp();
        let side = if by.dot(normal) > 0.0 { -normal } else { normal };
        let near = c + by * contact.share + side * MARGIN;
        if barriers.blocks(c, near) {
            return c;
        }
        by = (by * (1.0 - contact.share)).reflect(normal);
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
