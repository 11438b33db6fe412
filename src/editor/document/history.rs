//! Undo and redo: snapshots of the project, one for each gesture.

use std::collections::VecDeque;
use std::sync::Arc;

use lightloom_core::project::Project;

/// Most steps that can be undone.
pub const STEPS: usize = 200;

/// One step: what the project was before it, and what undo calls it.
#[derive(Clone, Debug)]
struct Step {
    before: Arc<Project>,
    name: &'static str,
}

/// What was, and what was undone.
#[derive(Clone, Debug, Default)]
pub struct History {
    past: VecDeque<Step>,
    future: Vec<Step>,
    /// Whether a gesture is going on whose step is already in `past`.
    open: bool,
}

impl History {
    /// Notes that the project was `before` until a change called `name`. Within one gesture only the first counts.
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

    /// The gesture is over: the next change is a step of its own. `now` is the project as it is: a gesture that led back
    /// to where it began leaves no step.
    pub(super) fn settle(&mut self, now: &Arc<Project>) {
        if std::mem::take(&mut self.open) && self.past.back().is_some_and(|step| step.before == *now) {
            self.past.pop_back();
        }
    }

    /// The gesture is broken off: what the project was before it.
    pub(super) fn abort(&mut self) -> Option<Arc<Project>> {
        std::mem::take(&mut self.open).then(|| self.past.pop_back().map(|step| step.before)).flatten()
    }

    /// What the project was before the last step, in exchange for what it is `now`.
    pub(super) fn undo(&mut self, now: &Arc<Project>) -> Option<Arc<Project>> {
        self.settle(now);
        let step = self.past.pop_back()?;
        self.future.push(Step { before: now.clone(), name: step.name });
        Some(step.before)
    }

    /// What the project was before the last undo, in exchange for what it is `now`.
    pub(super) fn redo(&mut self, now: &Arc<Project>) -> Option<Arc<Project>> {
        self.settle(now);
        let step = self.future.pop()?;
        self.past.push_back(Step { before: now.clone(), name: step.name });
        Some(step.before)
    }

    /// Changes what every step leads to.
    pub(super) fn change_all(&mut self, change: impl Fn(&Arc<Project>) -> Arc<Project>) {
        for step in self.past.iter_mut().chain(&mut self.future) {
            step.before = change(&step.before);
        }
    }

    /// What undo would take back.
    pub fn undoes(&self) -> Option<&'static str> {
        self.past.back().map(|step| step.name)
    }

    /// What redo would do again.
    pub fn redoes(&self) -> Option<&'static str> {
        self.future.last().map(|step| step.name)
    }
}
