//! Playback: moves the playhead with time.

use std::ops::RangeInclusive;

use lightloom_core::project::Project;

use super::session::Session;

/// Longest time step, seconds: after a pause of the window the animation continues where it was.
const LONGEST_STEP: f64 = 0.25;

/// The playback clock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Playback {
    /// Elapsed fraction of the current frame, 0 to 1.
    passed: f64,
}

impl Playback {
    /// Advances the playhead of a playing session by `seconds` at `fps` frames per second within `frames`; at the end
    /// it loops or stops. Returns the seconds until the next frame; none while paused.
    pub fn advance(
        &mut self,
        session: &mut Session,
        frames: &RangeInclusive<i32>,
        fps: f64,
        seconds: f64,
    ) -> Option<f64> {
        if !session.playing {
            self.passed = 0.0;
            return None;
        }
        let usable = seconds.is_finite() && fps.is_finite() && fps > 0.0;
        self.passed += if usable { seconds.clamp(0.0, LONGEST_STEP) * fps } else { 0.0 };
        let steps = self.passed.floor();
        self.passed -= steps;
        let (first, last) = (*frames.start(), *frames.end());
        let count = i64::from(last) - i64::from(first) + 1;
        // Outside of the frames playback starts at the first.
        let at = if frames.contains(&session.playhead) { session.playhead } else { first };
        let next = i64::from(at) - i64::from(first) + steps as i64;
        if next >= count && !session.looping {
            session.playing = false;
            session.playhead = last;
            return None;
        }
        session.playhead = (i64::from(first) + next.rem_euclid(count.max(1))) as i32;
        Some((1.0 - self.passed) / fps.max(1e-3))
    }
}

/// The played frames: between the marks, or from the first key frame to the last.
pub fn played(project: &Project, session: &Session) -> RangeInclusive<i32> {
    let all = whole(project);
    let from = session.marks[0].unwrap_or(*all.start());
    let to = session.marks[1].unwrap_or(*all.end());
    from.min(to)..=to.max(from)
}

/// The frames of the animation: from the first key frame to the last.
pub fn whole(project: &Project) -> RangeInclusive<i32> {
    let first = project.keys.first().map_or(1, |key| key.frame);
    first..=project.keys.last().map_or(first, |key| key.frame)
}

/// Frames per second of a project.
pub fn fps(project: &Project) -> f64 {
    let [count, seconds] = project.output.fps;
    f64::from(count) / f64::from(seconds.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn playing(playhead: i32, looping: bool) -> Session {
        Session { playhead, looping, playing: true, ..Session::default() }
    }

    #[test]
    fn a_second_in_small_steps_is_as_many_frames_as_the_rate_says() {
        let (mut clock, mut session) = (Playback::default(), playing(1, true));
        // Steps that no frame rate divides, together a second and a hair.
        for _ in 0..64 {
            clock.advance(&mut session, &(1..=1000), 24.0, 1.0 / 63.9);
        }
        assert_eq!(session.playhead, 25);
    }

    #[test]
    fn at_the_end_it_begins_anew_or_stops() {
        let mut session = playing(10, true);
        Playback::default().advance(&mut session, &(5..=10), 24.0, 1.5 / 24.0);
        assert_eq!((session.playhead, session.playing), (5, true));
        let mut session = playing(10, false);
        Playback::default().advance(&mut session, &(5..=10), 24.0, 1.5 / 24.0);
        assert_eq!((session.playhead, session.playing), (10, false));
    }

    #[test]
    fn a_long_pause_is_not_made_up_for() {
        let (mut clock, mut session) = (Playback::default(), playing(1, false));
        clock.advance(&mut session, &(1..=1000), 24.0, 3600.0);
        assert_eq!(session.playhead, 1 + (LONGEST_STEP * 24.0) as i32);
    }

    #[test]
    fn what_does_not_play_does_not_move_and_keeps_no_time() {
        let (mut clock, mut session) = (Playback { passed: 0.9 }, Session::default());
        assert_eq!(clock.advance(&mut session, &(1..=9), 24.0, 0.2), None);
        assert_eq!((session.playhead, clock), (1, Playback::default()));
    }

    #[test]
    fn one_frame_and_broken_clocks_do_no_harm() {
        for (fps, seconds) in [(24.0, f64::NAN), (0.0, 1.0), (f64::INFINITY, 1.0), (1e6, -1.0), (1e6, 1.0)] {
            let mut session = playing(7, true);
            Playback::default().advance(&mut session, &(7..=7), fps, seconds);
            assert_eq!(session.playhead, 7);
        }
    }
}
