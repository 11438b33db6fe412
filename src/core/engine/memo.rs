//! A stage remembers the input it was made from, so that a new gamma refits but traces nothing.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

/// An input that equals only itself: the result of the stage before, which stays the very same while nothing before it
/// changes.
pub(super) struct Same<T: ?Sized>(Arc<T>);

impl<T: ?Sized> Same<T> {
    pub(super) fn of(result: &Arc<T>) -> Self {
        Self(result.clone())
    }
}

impl<T: ?Sized> PartialEq for Same<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<T: ?Sized> Clone for Same<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

/// By what a file is known to be the same as before.
#[derive(Clone, PartialEq)]
pub(super) struct Stamp {
    path: PathBuf,
    /// Time of the last change and bytes, where the system tells.
    state: Option<(SystemTime, u64)>,
}

impl Stamp {
    /// Of the file at `path`, as it is now.
    pub(super) fn of(path: &Path) -> Self {
        let state = path.metadata().ok().and_then(|file| Some((file.modified().ok()?, file.len())));
        Self { path: path.to_owned(), state }
    }
}

/// The last result of a stage, with the input that led to it.
pub(super) struct Stage<I, O> {
    made: Option<(I, O)>,
}

impl<I, O> Default for Stage<I, O> {
    fn default() -> Self {
        Self { made: None }
    }
}

impl<I: PartialEq, O: Clone> Stage<I, O> {
    /// The remembered result where `input` is the one it was made from, otherwise a new one by `make`.
    ///
    /// A failed `make` leaves the stage empty.
    pub(super) fn get<E>(&mut self, input: I, make: impl FnOnce(&I) -> Result<O, E>) -> Result<O, E> {
        if let Some((from, output)) = &self.made
            && *from == input
        {
            return Ok(output.clone());
        }
        self.made = None;
        let output = make(&input)?;
        self.made = Some((input, output.clone()));
        Ok(output)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_input_is_worked_out_once() {
        let mut stage = Stage::default();
        let mut runs = 0;
        for input in [1, 1, 2, 2, 1] {
            let made: Result<i32, ()> = stage.get(input, |i| {
                runs += 1;
                Ok(10 * i)
            });
            assert_eq!(made, Ok(10 * input));
        }
        assert_eq!(runs, 3);
    }

    #[test]
    fn a_failure_is_not_remembered() {
        let mut stage = Stage::default();
        assert_eq!(stage.get(1, |_| Err::<i32, _>("no")), Err("no"));
        assert_eq!(stage.get(1, |i| Ok::<_, &str>(*i)), Ok(1));
    }
}
