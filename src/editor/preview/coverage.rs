//! Which frames are worked out, for the stripe of the timeline.

use std::ops::RangeInclusive;

/// How far a frame is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum State {
    /// Nothing is there yet.
    #[default]
    Missing,
    /// The light of an older project.
    Stale,
    /// A first, coarse answer.
    Draft,
    /// The preview's own photons and grid.
    Preview,
    /// Many photons.
    Fine,
    /// It could not be worked out.
    Failed,
}

/// How far each frame of the animation is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coverage {
    first: i32,
    states: Vec<State>,
}

impl Coverage {
    /// All frames in one state.
    pub fn new(frames: RangeInclusive<i32>, state: State) -> Self {
        let count = (frames.end() - frames.start() + 1).max(0) as usize;
        Self { first: *frames.start(), states: vec![state; count] }
    }

    /// How far a frame is.
    pub fn of(&self, frame: i32) -> State {
        let index = usize::try_from(i64::from(frame) - i64::from(self.first)).ok();
        index.and_then(|i| self.states.get(i)).copied().unwrap_or_default()
    }

    /// Notes that a frame is this far.
    pub fn set(&mut self, frame: i32, state: State) {
        let index = usize::try_from(i64::from(frame) - i64::from(self.first)).ok();
        if let Some(slot) = index.and_then(|i| self.states.get_mut(i)) {
            *slot = state;
        }
    }

    /// All frames in one state now.
    pub fn fill(&mut self, state: State) {
        self.states.fill(state);
    }

    /// Runs of frames in one state, in order: first frame, last frame, state.
    pub fn runs(&self) -> Vec<(i32, i32, State)> {
        let mut runs: Vec<(i32, i32, State)> = Vec::new();
        for (frame, &state) in (self.first..).zip(&self.states) {
            match runs.last_mut() {
                Some((_, last, of)) if *of == state => *last = frame,
                _ => runs.push((frame, frame, state)),
            }
        }
        runs
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_cover_every_frame_once() {
        let mut coverage = Coverage::new(1..=10, State::Stale);
        coverage.set(4, State::Draft);
        coverage.set(5, State::Draft);
        coverage.set(99, State::Failed);
        assert_eq!(coverage.runs(), [(1, 3, State::Stale), (4, 5, State::Draft), (6, 10, State::Stale)]);
        assert_eq!(
            (coverage.of(4), coverage.of(0), coverage.of(11)),
            (State::Draft, State::Missing, State::Missing)
        );
    }
}
