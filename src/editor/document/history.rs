//! Undo and redo: one snapshot of the project per gesture.

use std::collections::VecDeque;
use std::sync::Arc;

use lightloom_core::project::Project;

/// Maximum number of undo steps.
pub const STEPS: usize = 200;

/// One undo step: the project before it, and its name.
#[derive(Clone, Debug)]
struct Step {
    before: Arc<Project>,
    name: &'static str,
}

/// The undo and redo stacks.
#[derive(Clone, Debug, Default)]
pub struct History {
    past: VecDeque<Step>,
    future: Vec<Step>,
    /// Whether the last step of `past` belongs to a gesture in progress.
    open: bool,
}

impl History {
    /// Records the project before a change called `name`. Within one gesture only the first is recorded.
    pub(super) fn push(&mut self, before: &Arc<Project>, name: &'static str) {
        self.future.clear();
        if std::mem::replace(&mut self.open, true) {
            return;
        }
        if self.past.len() == STEPS {
            self.past.pop_front();
        }
        self.past.push_back(Step { before: before.clone(), name });
    }

    /// Ends the gesture: the next change is a new step. `now` is the current project: a gesture without effect
    /// leaves no step.
    pub(super) fn settle(&mut self, now: &Arc<Project>) {
        if std::mem::take(&mut self.open) && self.past.back().is_some_and(|step| step.before == *now) {
            self.past.pop_back();
        }
    }

    /// Cancels the gesture; returns the project before it.
    pub(super) fn abort(&mut self) -> Option<Arc<Project>> {
        std::mem::take(&mut self.open).then(|| self.past.pop_back().map(|step| step.before)).flatten()
    }

    /// Undoes the last step; returns the project before it.
    pub(super) fn undo(&mut self, now: &Arc<Project>) -> Option<Arc<Project>> {
        self.settle(now);
        let step = self.past.pop_back()?;
        self.future.push(Step { before: now.clone(), name: step.name });
        Some(step.before)
    }

    /// Redoes the last undone step; returns the project after it.
    pub(super) fn redo(&mut self, now: &Arc<Project>) -> Option<Arc<Project>> {
        self.settle(now);
        let step = self.future.pop()?;
        self.past.push_back(Step { before: now.clone(), name: step.name });
        Some(step.before)
    }

    /// Applies a change to every snapshot.
    pub(super) fn change_all(&mut self, change: impl Fn(&Arc<Project>) -> Arc<Project>) {
        for step in self.past.iter_mut().chain(&mut self.future) {
            step.before = change(&step.before);
        }
    }

    /// Name of the step that undo would revert.
    pub fn undoes(&self) -> Option<&'static str> {
        self.past.back().map(|step| step.name)
    }

    /// Name of the step that redo would repeat.
    pub fn redoes(&self) -> Option<&'static str> {
        self.future.last().map(|step| step.name)
    }
}
