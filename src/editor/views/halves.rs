//! Two views that share a rectangle: side by side or one over the other, so that their pictures are as large as they can be.

use egui::{Pos2, Rect, vec2};
use lightloom_core::project::Project;

/// Smallest and largest share of the first view before the user chooses one.
const SHARES: [f32; 2] = [0.3, 0.7];

/// How two views share a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arranged {
    /// Whether the first is over the second, not left of it.
    pub(super) stacked: bool,
    /// Share of the first.
    share: f32,
}

/// Width over height of the plane and of the shot.
pub(super) fn aspects(project: &Project) -> [f32; 2] {
    let extent = project.extent();
    [extent.x / extent.y, project.render.width.max(1) as f32 / project.render.height.max(1) as f32]
}

/// The arrangement in `all` for pictures of these aspects; `chosen` is the share of the first that the user wants.
pub(super) fn arranged(all: Rect, aspects: [f32; 2], chosen: Option<f32>) -> Arranged {
    let best = |a: Arranged, b: Arranged| {
        if b.shown(all, aspects) > a.shown(all, aspects) { b } else { a }
    };
    let of = |stacked: bool| {
        // Of equal height side by side, of equal width over each other.
        let [a, b] = if stacked { aspects.map(f32::recip) } else { aspects };
        let even = (a / (a + b)).clamp(SHARES[0], SHARES[1]);
        let with = |share| Arranged { stacked, share };
        chosen.map_or_else(|| best(with(0.5), with(even)), with)
    };
    best(of(false), of(true))
}

impl Arranged {
    /// The two rectangles, `gap` points apart.
    pub(super) fn places(&self, all: Rect, gap: f32) -> [Rect; 2] {
        let handle = self.handle(all, gap);
        match self.stacked {
            true => [all.with_max_y(handle.top()), all.with_min_y(handle.bottom())],
            false => [all.with_max_x(handle.left()), all.with_min_x(handle.right())],
        }
    }

    /// The rectangle between the two.
    pub(super) fn handle(&self, all: Rect, gap: f32) -> Rect {
        let middle = all.min + self.share * all.size();
        match self.stacked {
            true => Rect::from_x_y_ranges(all.x_range(), middle.y - 0.5 * gap..=middle.y + 0.5 * gap),
            false => Rect::from_x_y_ranges(middle.x - 0.5 * gap..=middle.x + 0.5 * gap, all.y_range()),
        }
    }

    /// The share of the first view whose border lies at a position.
    pub(super) fn share(&self, all: Rect, at: Pos2) -> f32 {
        let share = (at - all.min) / all.size().max(vec2(1.0, 1.0));
        if self.stacked { share.y } else { share.x }
    }

    /// Area of the two pictures.
    fn shown(&self, all: Rect, aspects: [f32; 2]) -> f32 {
        let area = |(place, aspect): (Rect, f32)| {
            let width = place.width().min(place.height() * aspect);
            width * width / aspect
        };
        self.places(all, 0.0).into_iter().zip(aspects).map(area).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_pictures_use_the_window_as_far_as_they_can() {
        let all = |width: f32, height: f32| Rect::from_min_size(Pos2::ZERO, vec2(width, height));
        // In a wide window side by side and of one height, in a high one over each other.
        let wide = arranged(all(2000.0, 600.0), [1.2, 1.8], None);
        assert!(!wide.stacked && (wide.share - 0.4).abs() < 1e-6);
        assert!(arranged(all(900.0, 1200.0), [1.2, 1.8], None).stacked);
        for (width, height) in [(1000.0, 650.0), (1600.0, 800.0), (700.0, 900.0)] {
            let all = all(width, height);
            let halves = Arranged { stacked: false, share: 0.5 };
            let best = arranged(all, [1.2, 1.8], None);
            assert!(best.shown(all, [1.2, 1.8]) >= halves.shown(all, [1.2, 1.8]), "{width} {height}");
        }
        assert_eq!(arranged(all(2000.0, 600.0), [1.2, 1.8], Some(0.25)).share, 0.25);
    }
}
