//! The time of a player.

/// Longest time step, seconds: after a pause of the window playback continues where it was.
const LONGEST_STEP: f64 = 0.25;

/// Where a player is in its sequence, by time.
#[derive(Clone, Debug, Default)]
pub struct Clock {
    /// For how many frames each picture is shown.
    holds: Vec<u32>,
    /// Elapsed frames.
    at: f64,
    /// Whether it runs.
    pub playing: bool,
    /// Whether it begins anew at the end.
    pub looping: bool,
}

impl Clock {
    /// A clock at the first of some pictures, which runs over and over.
    pub fn new(holds: Vec<u32>) -> Self {
        Self { holds, at: 0.0, playing: true, looping: true }
    }

    /// The index of the picture that is shown.
    pub fn index(&self) -> usize {
        let mut end = 0.0;
        let shown = self.holds.iter().position(|hold| {
            end += f64::from(*hold);
            self.at < end
        });
        shown.unwrap_or(self.holds.len().saturating_sub(1))
    }

    /// Goes to the begin of a picture.
    pub fn go(&mut self, index: usize) {
        let before = &self.holds[..index.min(self.holds.len().saturating_sub(1))];
        self.at = before.iter().map(|hold| f64::from(*hold)).sum();
    }

    /// Plays or rests; at the end it begins anew.
    pub fn toggle(&mut self) {
        if !self.playing && self.index() + 1 == self.holds.len() {
            self.go(0);
        }
        self.playing = !self.playing;
    }

    /// Rests at a picture so many before or after.
    pub fn step(&mut self, by: isize) {
        self.playing = false;
        self.go(self.index().saturating_add_signed(by));
    }

    /// Goes on by `seconds` at `rate` frames a second, and returns the seconds until the next picture; none at rest.
    pub fn advance(&mut self, seconds: f64, rate: f64) -> Option<f64> {
        let length: f64 = self.holds.iter().map(|hold| f64::from(*hold)).sum();
        if !self.playing || length <= 0.0 || !(rate.is_finite() && rate > 0.0) {
            return None;
        }
        self.at += if seconds.is_finite() { seconds.clamp(0.0, LONGEST_STEP) * rate } else { 0.0 };
        if self.at >= length && !self.looping {
            self.at = length;
            self.playing = false;
            return None;
        }
        self.at %= length;
        let ends: f64 = self.holds[..=self.index()].iter().map(|hold| f64::from(*hold)).sum();
        Some((ends - self.at) / rate)
    }
}
