//! SMPTE time codes of frames.

use exr::meta::attribute::TimeCode;

/// The time code of a frame, non-drop, counted from 00:00:00:00 at frame 0 and modulo a day. None above 30 frames a second:
/// SMPTE 12M has no numbers for them.
pub(super) fn time_code(frame: i32, (frames, seconds): (i32, u32)) -> Option<TimeCode> {
    let rate = (f64::from(frames) / f64::from(seconds.max(1))).round() as i64;
    if !(1..=30).contains(&rate) {
        return None;
    }
    let count = i64::from(frame).rem_euclid(24 * 3600 * rate);
    let part = |unit: i64, modulus: i64| (count / unit % modulus) as u8;
    Some(TimeCode {
        hours: part(3600 * rate, 24),
        minutes: part(60 * rate, 60),
        seconds: part(rate, 60),
        frame: part(1, rate),
        ..TimeCode::default()
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn shown(frame: i32, rate: (i32, u32)) -> Option<[u8; 4]> {
        time_code(frame, rate).map(|code| [code.hours, code.minutes, code.seconds, code.frame])
    }

    #[test]
    fn time_codes_count_frames_of_the_nominal_rate() {
        assert_eq!(shown(0, (24, 1)), Some([0, 0, 0, 0]));
        assert_eq!(shown(24 * 3661 + 5, (24, 1)), Some([1, 1, 1, 5]));
        assert_eq!(shown(24, (24_000, 1001)), Some([0, 0, 1, 0]));
        assert_eq!(shown(-1, (25, 1)), Some([23, 59, 59, 24]));
        assert_eq!(shown(7, (60, 1)), None);
    }
}
