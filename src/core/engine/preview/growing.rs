//! A sketch while it is worked out: frames come in, and snapshots go out.

use std::ops::Range;
use std::sync::Arc;

use glam::Vec2;

use super::outcome::{Course, Sketch};
use crate::engine::light::KeyPhotons;
use crate::engine::motion::Segment;

/// Snapshots of one sketch at most, about: each holds one pointer per frame.
const SNAPSHOTS: usize = 400;

/// Gathers the frames of a sketch and shows it as it grows.
pub(super) struct Growing<'a> {
    sketch: Sketch,
    /// The frame that is waited for.
    first: i32,
    ready: &'a mut dyn FnMut(&Arc<Sketch>),
    /// Frames since the last snapshot.
    unseen: usize,
}

impl<'a> Growing<'a> {
    /// Knows the photons at the keys, and shows them. `first` is the frame that is waited for.
    pub(super) fn new(course: Course, first: i32, ready: &'a mut dyn FnMut(&Arc<Sketch>)) -> Self {
        let (frames, segments) = (course.moments.len(), course.stops.len() - 1);
        let at_key = |moment: &crate::project::Moment| {
            let key = moment.segment + usize::from(moment.time >= 1.0);
            (moment.time <= 0.0 || moment.time >= 1.0).then(|| course.stops[key].positions.clone())
        };
        let sketch = Sketch {
            frames: course.moments.iter().map(at_key).collect(),
            segments: vec![None; segments],
            numbers: None,
            stages: Vec::new(),
            notes: Vec::new(),
            course: Arc::new(course),
        };
        debug_assert_eq!(sketch.frames.len(), frames);
        let mut growing = Self { sketch, first, ready, unseen: 0 };
        growing.show();
        growing
    }

    /// The flow's times of the frames between the keys of a segment, in order, and their slots.
    pub(super) fn between_keys(&self, segment: usize) -> (Vec<usize>, Vec<f64>) {
        let inside =
            |(_, m): &(usize, &crate::project::Moment)| m.segment == segment && m.time > 0.0 && m.time < 1.0;
        let moments = self.sketch.course.moments.iter().enumerate();
        moments.filter(inside).map(|(slot, moment)| (slot, moment.time)).unzip()
    }

    /// The segment of the frame that is waited for.
    pub(super) fn first_segment(&self) -> usize {
        self.sketch.moment(self.first).segment
    }

    /// Takes the photons at the frame of a slot.
    pub(super) fn add(&mut self, slot: usize, positions: &Arc<[Vec2]>) {
        if self.sketch.frames[slot].is_some() {
            return;
        }
        self.sketch.frames[slot] = Some(positions.clone());
        self.unseen += 1;
        let all = self.sketch.frames.len();
        if slot == self.sketch.slot(self.first) || self.unseen >= all.div_ceil(SNAPSHOTS) {
            self.show();
        }
    }

    /// Takes what moves the photons of a segment.
    pub(super) fn fitted(&mut self, number: usize, segment: &Arc<Segment>) {
        self.sketch.segments[number] = Some(segment.clone());
        self.show();
    }

    /// The sketch with all there is.
    pub(super) fn finish(self) -> Sketch {
        self.sketch
    }

    fn show(&mut self) {
        self.unseen = 0;
        (self.ready)(&Arc::new(self.sketch.clone()));
    }
}

/// The photons of all groups at some moments of one segment, put together as layer after layer is fitted.
pub(super) struct Composition {
    ranges: Vec<Range<usize>>,
    /// Layers that are still to come at each moment.
    missing: Vec<usize>,
    moments: Vec<Vec<Vec2>>,
}

impl Composition {
    /// `moments` moments of photons that start `at` a key; what no layer moves stays there. None where nothing moves.
    pub(super) fn new(at: &[KeyPhotons], layers: usize, moments: usize) -> Option<Self> {
        let mut end = 0;
        let range = |group: &KeyPhotons| {
            let start = end;
            end += group.positions.len();
            start..end
        };
        let ranges = at.iter().map(range).collect();
        let start: Vec<Vec2> = at.iter().flat_map(|group| &group.positions).copied().collect();
        let composition = Self { ranges, missing: vec![layers; moments], moments: vec![start; moments] };
        (layers > 0).then_some(composition)
    }

    /// Takes where the photons of some groups are at a moment; returns all photons once all layers are there.
    pub(super) fn take(
        &mut self,
        groups: &[usize],
        moment: usize,
        positions: &[Vec2],
    ) -> Option<Arc<[Vec2]>> {
        let mut rest = positions;
        for range in groups.iter().map(|&group| self.ranges[group].clone()) {
            let (own, others) = rest.split_at(range.len());
            self.moments[moment][range].copy_from_slice(own);
            rest = others;
        }
        self.missing[moment] -= 1;
        (self.missing[moment] == 0).then(|| std::mem::take(&mut self.moments[moment]).into())
    }
}
