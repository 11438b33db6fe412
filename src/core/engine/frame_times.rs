//! The moments of the requested frames. Frames that show the same moment share one.

use crate::project::{KeyFrame, SegmentTime, segment_time};

/// The distinct moments of a list of frames, in the order in which photons pass them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FrameTimes {
    /// The segment times, in rising order.
    pub(super) moments: Vec<SegmentTime>,
    /// For each requested frame, in the requested order: its number and the index of its moment.
    pub(super) frames: Vec<(i32, usize)>,
}

impl FrameTimes {
    pub(super) fn new(keys: &[KeyFrame], frames: &[i32]) -> Self {
        let mut moments: Vec<SegmentTime> = frames.iter().map(|&frame| segment_time(keys, frame)).collect();
        let order =
            |a: &SegmentTime, b: &SegmentTime| a.segment.cmp(&b.segment).then(a.time.total_cmp(&b.time));
        moments.sort_by(order);
        moments.dedup();
        let slot = |frame: i32| {
            let wanted = segment_time(keys, frame);
            moments.binary_search_by(|m| order(m, &wanted)).unwrap_or(0)
        };
        let frames = frames.iter().map(|&frame| (frame, slot(frame))).collect();
        Self { moments, frames }
    }

    /// The first requested frame that shows the moment of this index.
    pub(super) fn frame_of(&self, slot: usize) -> Option<i32> {
        self.frames.iter().find(|(_, own)| *own == slot).map(|(frame, _)| *frame)
    }

    /// The moments of one segment with their indices.
    pub(super) fn of_segment(&self, segment: usize) -> impl Iterator<Item = (usize, f64)> {
        let at = move |(slot, m): (usize, &SegmentTime)| (m.segment == segment).then_some((slot, m.time));
        self.moments.iter().enumerate().filter_map(at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::project::{Ease, Shows};

    #[test]
    fn frames_at_rest_share_a_moment_and_times_rise() {
        let key = |frame| KeyFrame {
            frame,
            shows: Shows::PhysicalCaustic,
            caustics: Default::default(),
            ease: Ease::Linear,
        };
        let slots = FrameTimes::new(&[key(1), key(3), key(5)], &[9, 4, 2, 0, 1, 7]);
        let times: Vec<_> = slots.moments.iter().map(|m| (m.segment, m.time)).collect();
        assert_eq!(times, [(0, 0.0), (0, 0.5), (1, 0.5), (1, 1.0)]);
        assert_eq!(slots.frames, [(9, 3), (4, 2), (2, 1), (0, 0), (1, 0), (7, 3)]);
        assert_eq!(slots.of_segment(1).collect::<Vec<_>>(), [(2, 0.5), (3, 1.0)]);
    }
}
