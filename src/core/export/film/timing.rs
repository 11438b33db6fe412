//! For how long frames are shown.

/// For each of the numbered frames the frames of the project during which it is shown: until the next one, so that a film
/// of every fifth frame moves as fast as that of all. One each where the numbers do not rise.
pub fn holds(frames: &[i32]) -> Vec<u32> {
    if !frames.windows(2).all(|pair| pair[0] < pair[1]) {
        return vec![1; frames.len()];
    }
    let mut holds: Vec<u32> = frames.windows(2).map(|pair| pair[1].abs_diff(pair[0])).collect();
    holds.extend(frames.last().map(|_| holds.last().copied().unwrap_or(1)));
    holds
}

/// Shortest delay in a GIF (1/100 s): browsers slow down those that are shorter.
const LEAST: u64 = 2;

/// The frames that a GIF shows, by index, with their delays in 1/100 s. Delays differ by one so that the whole keeps its
/// pace; of a faster film frames are left out.
pub(super) fn gif_delays(holds: &[u32], [frames, seconds]: [u32; 2]) -> Vec<(usize, u16)> {
    let mut delays: Vec<(usize, u16)> = Vec::new();
    let (mut held, mut shown) = (0, 0);
    let mut first = 0;
    for (index, hold) in holds.iter().enumerate() {
        held += u64::from(*hold);
        // To the nearest.
        let (time, rate) = (held * u64::from(seconds) * 100, u64::from(frames.max(1)));
        let end = (time + rate / 2) / rate;
        let last = index + 1 == holds.len();
        if end - shown >= LEAST || (last && delays.is_empty()) {
            delays.push((first, (end - shown).clamp(LEAST, u64::from(u16::MAX)) as u16));
            shown = end;
            first = index + 1;
        }
    }
    delays
}

/// A delay of `hold` frames as a fraction of a second, of 16 bits each.
pub(super) fn fraction(hold: u32, [frames, seconds]: [u32; 2]) -> (u16, u16) {
    let (mut above, mut below) = (u64::from(hold) * u64::from(seconds), u64::from(frames));
    let common = greatest_common_divisor(above, below).max(1);
    (above, below) = (above / common, below / common);
    while above.max(below) > u64::from(u16::MAX) {
        (above, below) = (above.div_ceil(2), below.div_ceil(2));
    }
    (above as u16, below as u16)
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_held_until_the_next() {
        assert_eq!(holds(&[1, 2, 3]), [1, 1, 1]);
        assert_eq!(holds(&[1, 6, 11, 12]), [5, 5, 1, 1]);
        assert_eq!(holds(&[5, 1, 2]), [1, 1, 1]);
        assert_eq!(holds(&[7]), [1]);
        assert!(holds(&[]).is_empty());
    }

    #[test]
    fn delays_of_a_gif_keep_the_pace_in_sum() {
        for (fps, seconds) in
            [([24, 1], 100.0 / 24.0), ([24_000, 1001], 100.1 / 24.0), ([60, 1], 100.0 / 60.0)]
        {
            let delays = gif_delays(&[1; 100], fps);
            let sum: u64 = delays.iter().map(|(_, delay)| u64::from(*delay)).sum();
            // Rounded to the nearest 1/100 s; a last frame of less than the shortest delay is left out.
            assert!((sum as f64 / 100.0 - seconds).abs() < 0.03, "{fps:?}: {sum}");
            assert!(delays.iter().all(|(_, delay)| *delay >= 2));
            assert!(delays.windows(2).all(|pair| pair[0].0 < pair[1].0));
        }
        assert_eq!(gif_delays(&[1], [1000, 1]), [(0, 2)]);
        assert_eq!(gif_delays(&[48, 24], [24, 1]), [(0, 200), (1, 100)]);
    }

    #[test]
    fn a_delay_is_an_exact_fraction_where_it_fits() {
        assert_eq!(fraction(1, [24, 1]), (1, 24));
        assert_eq!(fraction(2, [24_000, 1001]), (1001, 12_000));
        let (above, below) = fraction(3, [1_000_000, 999_999]);
        assert!((f64::from(above) / f64::from(below) - 2.999_997).abs() < 1e-3);
    }
}
