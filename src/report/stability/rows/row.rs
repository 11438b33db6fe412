//! A row of the table, and the builder that makes a case of it.

use super::super::case::{Bound, Case, Input, Limits};
use super::super::flow_case::FlowCase;
use super::super::scene_case::SceneCase;
use crate::effort::Effort;

/// One extreme input and what must become of it.
pub(in crate::stability) struct Row {
    name: String,
    expected: Expected,
    input: Box<dyn FnOnce(Effort) -> Box<dyn Input>>,
    limits: Box<dyn FnOnce(&mut Limits)>,
}

/// The outcome that a row must have.
#[derive(Clone, Copy)]
pub(super) enum Expected {
    /// It comes through within the limits of its kind, for this reason.
    Holds(&'static str),
    /// The check of the project format refuses it: words of the message, and the reason.
    Refused(&'static str, &'static str),
    /// The computation refuses it: words of the message, and the reason.
    Fails(&'static str, &'static str),
}

impl Row {
    /// Any input.
    pub(super) fn new<I: Input + 'static>(
        name: impl Into<String>,
        expected: Expected,
        input: impl FnOnce(Effort) -> I + 'static,
    ) -> Self {
        let input = Box::new(|effort| Box::new(input(effort)) as Box<dyn Input>);
        Self { name: name.into(), expected, input, limits: Box::new(|_| ()) }
    }

    /// The plain flow with a change.
    pub(super) fn flow(
        name: impl Into<String>,
        expected: Expected,
        change: impl FnOnce(&mut FlowCase) + 'static,
    ) -> Self {
        Self::new(name, expected, |effort| {
            let mut flow = FlowCase::new(effort);
            change(&mut flow);
            flow
        })
    }

    /// The plain scene with a change.
    pub(super) fn scene(
        name: impl Into<String>,
        expected: Expected,
        change: impl FnOnce(&mut SceneCase) + 'static,
    ) -> Self {
        Self::new(name, expected, |effort| {
            let mut scene = SceneCase::new(effort);
            change(&mut scene);
            scene
        })
    }

    /// The row with limits that differ from those of its kind.
    pub(super) fn limited(self, change: impl FnOnce(&mut Limits) + 'static) -> Self {
        Self { limits: Box::new(change), ..self }
    }

    /// The input and its bound, ready to run.
    pub(in crate::stability) fn build(self, effort: Effort) -> Case {
        let input = (self.input)(effort);
        let is_checked = matches!(self.expected, Expected::Refused(..));
        let bound = match self.expected {
            Expected::Holds(why) => {
                let mut limits = Limits { why, ..input.limits() };
                (self.limits)(&mut limits);
                Bound::Holds(limits)
            }
            Expected::Refused(words, why) | Expected::Fails(words, why) => Bound::Refused { words, why },
        };
        Case::new(self.name, bound, move |progress| {
            if is_checked {
                input.check()?;
            }
            input.run(progress)
        })
    }
}
