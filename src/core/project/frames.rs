//! Frame lists as render farms write them: `1-100`, `1-100x5`, `1,5-10,47-327`, `-10--1`.

use crate::{Error, Result};

/// Most frames of one run.
pub const MAX_FRAMES: usize = 100_000;

/// The frames of a list such as `1-100x5, 120`, in its order, without duplicates. `x` or `:` precedes the step.
///
/// # Errors
/// Names `place` for a list that is empty, reversed, malformed or longer than [`MAX_FRAMES`].
pub fn parse(text: &str, place: &str) -> Result<Vec<i32>> {
    let mut frames = Vec::new();
    let mut seen = std::collections::BTreeSet::new();
    for part in text.split(',').map(str::trim) {
        let (first, last, step) = range(part, place)?;
        let count = (i64::from(last) - i64::from(first)) / step + 1;
        if frames.len() as i64 + count > MAX_FRAMES as i64 {
            let what = format!("'{text}' asks for more than {MAX_FRAMES} frames; render it in parts");
            return Err(Error::value(place, what));
        }
        for i in 0..count {
            // Cannot overflow: it lies between `first` and `last`, both i32.
            let frame = (i64::from(first) + i * step) as i32;
            if seen.insert(frame) {
                frames.push(frame);
            }
        }
    }
    Ok(frames)
}

/// First, last and step of one part of the list.
fn range(part: &str, place: &str) -> Result<(i32, i32, i64)> {
    let wrong = |why: &str| {
        Error::value(place, format!("'{part}' {why}; write frames like 1-100, 1-100x5 or 1,5-10"))
    };
    let (span, step) = match part.split_once(['x', ':']) {
        Some((span, step)) => {
            let step: i64 =
                step.trim().parse().map_err(|_| wrong("has a step that is not a whole number"))?;
            (span.trim(), step)
        }
        None => (part, 1),
    };
    if span.is_empty() {
        return Err(wrong("names no frame"));
    }
    if step < 1 {
        return Err(wrong("has a step below 1"));
    }
    // A minus sign at the front belongs to the first number.
    let dash = span.char_indices().skip(1).find(|(_, c)| *c == '-');
    let (first, last) = dash.map_or((span, span), |(at, _)| (&span[..at], &span[at + 1..]));
    let number = |s: &str| {
        s.trim()
            .parse::<i32>()
            .ok()
            .filter(|n| (-1_000_000..=1_000_000).contains(n))
            .ok_or_else(|| wrong("is not a frame number between -1000000 and 1000000"))
    };
    let (first, last) = (number(first)?, number(last)?);
    if last < first {
        return Err(wrong("runs backwards"));
    }
    Ok((first, last, step))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(text: &str) -> Vec<i32> {
        parse(text, "--frames").expect("a good list")
    }

    #[test]
    fn lists_ranges_and_steps_are_read() {
        assert_eq!(frames("1-5"), [1, 2, 3, 4, 5]);
        assert_eq!(frames("1-10x4"), [1, 5, 9]);
        assert_eq!(frames("1-10:4"), [1, 5, 9]);
        assert_eq!(frames("-2--1, 7"), [-2, -1, 7]);
        assert_eq!(frames("-3-1x2"), [-3, -1, 1]);
    }

    #[test]
    fn a_frame_named_twice_is_rendered_once_and_order_is_kept() {
        assert_eq!(frames("5,1-6x2,5"), [5, 1, 3]);
    }

    #[test]
    fn bad_lists_are_refused_with_their_place() {
        for bad in [
            "",
            ",",
            "9-1",
            "1-1000000000",
            "1-100001",
            "a",
            "1-5x0",
            "1-5x-1",
            "1-",
            "-",
            "é",
            "1.5",
            "99999999999",
        ] {
            let error = parse(bad, "--frames").expect_err(bad).to_string();
            assert!(error.starts_with("--frames: "), "{bad}: {error}");
        }
    }
}
