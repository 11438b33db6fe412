//! The size of parallel tasks. It is fixed by the data alone, so that sums do not depend on the number of threads.

/// Operations of a task at least, some ten microseconds: for less, the help of another thread costs more than it is worth.
const OPERATIONS: usize = 32_768;

/// Rows of `len` numbers in a parallel task, where each number takes so many `operations`.
pub fn rows_per_task(len: usize, operations: usize) -> usize {
    OPERATIONS.div_ceil((len * operations).max(1))
}
