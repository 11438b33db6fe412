//! The part of a frame that differs from the one before.

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Window {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl Window {
    /// A whole picture.
    pub(super) fn whole([width, height]: [usize; 2]) -> Self {
        Self { left: 0, top: 0, width, height }
    }

    /// The pixels for which `changed` holds; one pixel where it never does, as films know no empty frames.
    pub(super) fn around([width, height]: [usize; 2], changed: impl Fn(usize) -> bool) -> Self {
        let row_changed = |y: &usize| (y * width..(y + 1) * width).any(&changed);
        let Some(top) = (0..height).find(row_changed) else {
            return Self { left: 0, top: 0, width: 1, height: 1 };
        };
        let bottom = (0..height).rev().find(row_changed).unwrap_or(top);
        let column_changed = |x: &usize| (top..=bottom).any(|y| changed(y * width + x));
        let left = (0..width).find(column_changed).unwrap_or(0);
        let right = (0..width).rev().find(column_changed).unwrap_or(left);
        Self { left, top, width: right + 1 - left, height: bottom + 1 - top }
    }

    /// The indices of its pixels in a picture that is `width` pixels wide.
    pub(super) fn pixels(self, width: usize) -> impl Iterator<Item = usize> {
        let row = move |y: usize| (self.left..self.left + self.width).map(move |x| y * width + x);
        (self.top..self.top + self.height).flat_map(row)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_is_the_smallest_around_what_changed() {
        let changed = |i: usize| [2 * 10 + 3, 4 * 10 + 1].contains(&i);
        let window = Window::around([10, 6], changed);
        assert_eq!(window, Window { left: 1, top: 2, width: 3, height: 3 });
        let inside: Vec<usize> = window.pixels(10).collect();
        assert_eq!((inside.len(), inside[0], inside[8]), (9, 21, 43));
        assert_eq!(Window::around([10, 6], |_| false).pixels(10).count(), 1);
        assert_eq!(Window::around([10, 6], |_| true), Window::whole([10, 6]));
    }
}
