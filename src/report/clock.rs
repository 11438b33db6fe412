//! The clock of all sections.

use std::time::Instant;

use lightloom_core::Result;

/// The result of `work`, and the seconds of the fastest of at most `runs` runs: other load only ever makes one slower. No
/// run begins once `enough` seconds are spent.
pub(crate) fn fastest<T>(runs: usize, enough: f64, mut work: impl FnMut() -> Result<T>) -> Result<(T, f64)> {
    let (mut made, mut best) = timed(&mut work)?;
    let mut spent = best;
    for _ in 1..runs {
        if spent >= enough {
            break;
        }
        let seconds;
        (made, seconds) = timed(&mut work)?;
        best = best.min(seconds);
        spent += seconds;
    }
    Ok((made, best))
}

fn timed<T>(work: impl FnOnce() -> Result<T>) -> Result<(T, f64)> {
    let start = Instant::now();
    Ok((work()?, start.elapsed().as_secs_f64()))
}
