//! A stage remembers the input it was made from, so that a new gamma refits but traces nothing.

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
