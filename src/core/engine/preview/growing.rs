//! A preview while it is made: frames come in, and snapshots go out.

use std::ops::Range;
use std::sync::Arc;

use glam::Vec2;

use super::frames::{Keys, Preview};
use crate::Note;
use crate::engine::fitted_segment::FittedSegment;
use crate::engine::key_photons::{KeyPhotons, all_positions};
use crate::engine::segment_photons::SegmentPhotons;

/// Snapshots of one preview at most, about: each holds one pointer per frame.
const SNAPSHOTS: usize = 400;

/// A preview that gathers frames and is shown as it grows.
pub(super) struct Growing<'a> {
    preview: Preview,
    /// The frame on screen.
    first: i32,
    ready: &'a mut dyn FnMut(&Arc<Preview>),
    /// Frames since the last snapshot.
    unseen: usize,
}

impl<'a> Growing<'a> {
    /// A preview of the key frames alone, which is shown, with the notes that are known by then. `first` is the frame on screen.
    pub(super) fn new(
        notes: Vec<Note>,
        keys: Keys,
        first: i32,
        ready: &'a mut dyn FnMut(&Arc<Preview>),
    ) -> Self {
        let (frames, segments) = (keys.moments.len(), keys.lights.len() - 1);
        let at_key = |moment: &crate::project::SegmentTime| {
            let key = moment.segment + usize::from(moment.time >= 1.0);
            (moment.time <= 0.0 || moment.time >= 1.0).then(|| keys.lights[key].positions.clone())
        };
        let preview = Preview {
            frames: keys.moments.iter().map(at_key).collect(),
            segments: vec![None; segments],
            ends: vec![None; segments],
            numbers: None,
            stages: Vec::new(),
            notes,
            keys: Arc::new(keys),
        };
        debug_assert_eq!(preview.frames.len(), frames);
        let mut growing = Self { preview, first, ready, unseen: 0 };
        growing.show();
        growing
    }

    /// The flow's times of the frames between the keys of a segment, in order, and their slots.
    pub(super) fn between_keys(&self, segment: usize) -> (Vec<usize>, Vec<f64>) {
        let inside = |(_, m): &(usize, &crate::project::SegmentTime)| {
            m.segment == segment && m.time > 0.0 && m.time < 1.0
        };
        let moments = self.preview.keys.moments.iter().enumerate();
        moments.filter(inside).map(|(slot, moment)| (slot, moment.time)).unzip()
    }

    /// The segment of the frame on screen.
    pub(super) fn first_segment(&self) -> usize {
        self.preview.moment(self.first).segment
    }

    /// Which of these slots has the frame on screen.
    pub(super) fn first_of(&self, slots: &[usize]) -> Option<usize> {
        let first = self.preview.slot(self.first);
        slots.iter().position(|&slot| slot == first)
    }

    /// Adds the photons at the frame of a slot.
    pub(super) fn add(&mut self, slot: usize, positions: &Arc<[Vec2]>) {
        if self.preview.frames[slot].is_some() {
            return;
        }
        self.preview.frames[slot] = Some(positions.clone());
        self.unseen += 1;
        let all = self.preview.frames.len();
        if slot == self.preview.slot(self.first) || self.unseen >= all.div_ceil(SNAPSHOTS) {
            self.show();
        }
    }

    /// Adds the flow of the segment of some photons.
    pub(super) fn fitted(&mut self, photons: &SegmentPhotons, segment: &Arc<FittedSegment>) {
        self.preview.segments[photons.number] = Some(segment.clone());
        self.preview.ends[photons.number] = Some([photons.from.clone(), photons.to.clone()]);
        self.show();
    }

    /// The preview.
    pub(super) fn finish(self) -> Preview {
        self.preview
    }

    fn show(&mut self) {
        self.unseen = 0;
        (self.ready)(&Arc::new(self.preview.clone()));
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
        let start: Vec<Vec2> = all_positions(at).collect();
        let composition = Self { ranges, missing: vec![layers; moments], moments: vec![start; moments] };
        (layers > 0).then_some(composition)
    }

    /// Adds the positions of some groups at a moment; returns those of all groups once all layers are there.
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
