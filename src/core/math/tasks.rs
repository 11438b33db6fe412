//! Parallel tasks, of which one alone stays on its thread.

use rayon::iter::IndexedParallelIterator;
use rayon::iter::plumbing::{Producer, ProducerCallback};

/// Work in tasks.
pub trait Tasks: IndexedParallelIterator {
    /// As `for_each`; a single task runs at once on this thread. From outside of the thread pool, `for_each` hands it to the pool and
    /// sleeps until it is done, which takes some 50 us: more than the small grids of solvers and plans need.
    fn for_each_task(self, work: impl Fn(Self::Item) + Sync + Send) {
        match self.len() {
            0..=1 => self.with_producer(Here(work)),
            _ => self.for_each(work),
        }
    }
}

impl<I: IndexedParallelIterator> Tasks for I {}

struct Here<F>(F);

impl<T, F: Fn(T)> ProducerCallback<T> for Here<F> {
    type Output = ();

    fn callback<P: Producer<Item = T>>(self, tasks: P) {
        tasks.into_iter().for_each(self.0);
    }
}

#[cfg(test)]
mod tests {
    use rayon::prelude::*;

    use super::*;

    #[test]
    fn every_task_is_done_once_and_one_alone_on_this_thread() {
        let here = std::thread::current().id();
        for size in [0, 1, 2, 5] {
            let mut values = vec![0; 3 * size];
            values.par_chunks_mut(3).enumerate().for_each_task(|(task, values)| {
                assert!(size > 1 || std::thread::current().id() == here);
                values.iter_mut().for_each(|value| *value += task + 1);
            });
            let expected: Vec<usize> = (0..3 * size).map(|i| i / 3 + 1).collect();
            assert_eq!(values, expected);
        }
    }
}
