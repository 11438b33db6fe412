//! Sums of long columns.

use glam::DVec3;
use rayon::prelude::*;

/// Items summed by one thread.
const CHUNK: usize = 1 << 14;

/// The sum of `value` over all items: each chunk in its order, then the chunks in theirs, so that it is the same for any
/// number of threads.
pub fn ordered_sum<T: Sync>(items: &[T], value: impl Fn(&T) -> DVec3 + Sync) -> DVec3 {
    let of_chunk = |chunk: &[T]| chunk.iter().map(&value).sum::<DVec3>();
    let sums: Vec<DVec3> = items.par_chunks(CHUNK).map(of_chunk).collect();
    sums.into_iter().sum()
}
