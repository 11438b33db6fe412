//! The scale of the time axis: from frames to screen positions.

use std::ops::RangeInclusive;

use egui::Rangef;

/// Minimum number of visible frames.
const FEWEST: f64 = 4.0;
/// Maximum number of visible frames; projects hold frames from -1000000 to 1000000.
const MOST: f64 = 2_100_000.0;
/// Margin at both ends when all frames are visible, points.
const MARGIN: f64 = 34.0;
/// Minimum distance of two numbers on the ruler, points.
const LABEL: f64 = 58.0;

/// The time axis on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    left: f64,
    width: f64,
    /// The frame at the left end.
    first: f64,
    /// Points per frame.
    per_frame: f64,
}

/// The visible part of the time axis: first frame and number of frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct VisibleRange {
    pub(super) first: f64,
    pub(super) frames: f64,
}

impl Scale {
    /// The scale that maps `seen` to the screen range `x`.
    pub(super) fn new(x: Rangef, seen: VisibleRange) -> Self {
        let width = f64::from(x.span()).max(1.0);
        Self { left: f64::from(x.min), width, first: seen.first, per_frame: width / seen.frames.max(1e-6) }
    }

    /// Screen position of a frame, points; fractions are times between frames.
    pub(super) fn x(&self, frame: f64) -> f32 {
        (self.left + (frame - self.first) * self.per_frame) as f32
    }

    /// Time at a screen position, frames.
    pub(super) fn moment(&self, x: f32) -> f64 {
        self.first + (f64::from(x) - self.left) / self.per_frame
    }

    /// The frame nearest to a screen position.
    pub(super) fn frame(&self, x: f32) -> i32 {
        self.moment(x).round() as i32
    }

    /// Points per frame.
    pub(super) fn per_frame(&self) -> f32 {
        self.per_frame as f32
    }

    /// The visible range after zooming by `factor` about a fixed screen position.
    pub(super) fn zoomed(&self, factor: f64, about: f32) -> VisibleRange {
        let now = self.width / self.per_frame;
        let frames = (now / factor.max(1e-6)).clamp(FEWEST, MOST);
        let fixed = self.moment(about);
        VisibleRange { first: fixed - (fixed - self.first) * frames / now, frames }
    }

    /// The visible range after panning by points.
    pub(super) fn panned(&self, points: f32) -> VisibleRange {
        VisibleRange {
            first: self.first - f64::from(points) / self.per_frame,
            frames: self.width / self.per_frame,
        }
    }

    /// Frames between two numbers on the ruler, and between two ticks.
    pub(super) fn steps(&self) -> [i64; 2] {
        let wanted = LABEL / self.per_frame;
        let mut decade = 1_i64;
        loop {
            for [step, tick] in [[1, 1], [2, 1], [5, 1], [10, 2]] {
                if (step * decade) as f64 >= wanted || decade >= 1_000_000 {
                    return [step * decade, (tick * decade).max(1)];
                }
            }
            decade *= 10;
        }
    }

    /// The visible multiples of `step`.
    pub(super) fn multiples(&self, step: i64) -> impl Iterator<Item = i64> {
        let (from, to) = (self.first, self.first + self.width / self.per_frame);
        let first = (from / step as f64).ceil() as i64;
        let last = (to / step as f64).floor() as i64;
        (first..=last).map(move |i| i * step)
    }
}

impl VisibleRange {
    /// The range of all `frames` with margins, on an axis of this width in points.
    pub(super) fn all(frames: &RangeInclusive<i32>, width: f32) -> Self {
        let count = (f64::from(*frames.end()) - f64::from(*frames.start())).max(FEWEST);
        let room = (f64::from(width) - 2.0 * MARGIN).max(1.0);
        let per_frame = room / count;
        Self {
            first: f64::from(*frames.start()) - MARGIN / per_frame,
            frames: count + 2.0 * MARGIN / per_frame,
        }
    }

    /// The range moved so that it overlaps `frames`.
    pub(super) fn kept_near(self, frames: &RangeInclusive<i32>) -> Self {
        let (from, to) = (f64::from(*frames.start()), f64::from(*frames.end()));
        Self { first: self.first.clamp(from - 0.9 * self.frames, to - 0.1 * self.frames), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale() -> Scale {
        Scale::new(Rangef::new(100.0, 900.0), VisibleRange { first: -3.5, frames: 160.0 })
    }

    #[test]
    fn places_and_frames_lead_back_to_each_other() {
        for frame in [-3, 0, 1, 77, 156] {
            assert_eq!(scale().frame(scale().x(f64::from(frame))), frame);
        }
    }

    #[test]
    fn zooming_keeps_the_frame_under_the_pointer() {
        let closer = Scale::new(Rangef::new(100.0, 900.0), scale().zoomed(3.0, 640.0));
        // f32 on a screen of a thousand points, 15 points per frame.
        assert!((closer.moment(640.0) - scale().moment(640.0)).abs() < 1e-4);
        assert!((closer.per_frame() / scale().per_frame() - 3.0).abs() < 1e-4);
    }

    #[test]
    fn numbers_on_the_ruler_never_touch() {
        for frames in [4.0, 30.0, 60.0, 240.0, 1e4, 2e6] {
            let scale = Scale::new(Rangef::new(0.0, 800.0), VisibleRange { first: 0.0, frames });
            let [step, tick] = scale.steps();
            assert!(step as f64 * f64::from(scale.per_frame()) >= LABEL * 0.999, "{frames}");
            assert_eq!(step % tick, 0);
        }
    }

    #[test]
    fn all_frames_fit_with_room_for_a_thumbnail() {
        let scale = Scale::new(Rangef::new(0.0, 800.0), VisibleRange::all(&(1..=60), 800.0));
        assert!(scale.x(1.0) >= 30.0 && scale.x(60.0) <= 770.0);
    }
}
