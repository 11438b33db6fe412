//! What the workers find out, and what the window shows of it. Nothing here waits: the window asks, and shows what there is.

mod animator;
mod coverage;
pub mod gpu;
mod subject;
pub mod worker;

use std::sync::Arc;

pub use coverage::{Coverage, State};
use lightloom_core::pipeline::Sketch;
pub use subject::Subject;

use animator::{Animator, Found};

/// The newest results, and what is still being worked on.
pub struct Preview {
    animator: Animator,
    subject: Option<Subject>,
    frame: i32,
    found: Found,
    /// The light of the last version, shown until there is new one.
    last: Option<Arc<Sketch>>,
    coverage: Coverage,
    problem: Option<String>,
    activity: Option<Activity>,
}

/// What the worker does now.
#[derive(Clone, Debug, PartialEq)]
pub struct Activity {
    /// The stage, such as "fit".
    pub stage: &'static str,
    /// Share of it that is done, 0..=1.
    pub fraction: f32,
}

impl Preview {
    /// Nothing is worked on yet. `wake` is called from other threads whenever there is something new to see.
    pub fn new(wake: impl Fn() + Clone + Send + 'static) -> Self {
        Self {
            animator: Animator::new(wake),
            subject: None,
            frame: 0,
            found: Found::default(),
            last: None,
            coverage: Coverage::default(),
            problem: None,
            activity: None,
        }
    }

    /// Shows this subject at this frame from now on: to be called in every frame of the window.
    pub fn follow(&mut self, subject: &Subject, frame: i32) {
        self.frame = frame;
        if self.subject.as_ref().is_none_or(|last| !last.is(subject)) {
            self.last = self.sketch().cloned();
            self.found = Found::default();
            self.subject = Some(subject.clone());
            self.animator.ask(subject.clone(), frame);
            self.age(subject);
        }
        self.receive();
    }

    /// The frames of a new version show the old light, where there is any.
    fn age(&mut self, subject: &Subject) {
        let keys = &subject.project.keys;
        let (Some(first), Some(last)) = (keys.first(), keys.last()) else { return };
        let mut coverage = Coverage::new(first.frame..=last.frame, State::Missing);
        if let Some(old) = &self.last {
            (first.frame..=last.frame)
                .filter(|&frame| old.frames().contains(&frame) && old.is_ready(frame))
                .for_each(|frame| coverage.set(frame, State::Stale));
        }
        self.coverage = coverage;
    }

    /// Takes what was found out since the last time.
    fn receive(&mut self) {
        if let Some(words) = self.animator.panicked() {
            self.problem = Some(format!(
                "the preview failed ({words}); the project is unharmed, and the next edit tries again"
            ));
            self.coverage.fill(State::Failed);
        }
        self.activity = self.animator.progress().and_then(|seen| {
            let fraction = seen.fraction as f32;
            Some(Activity { stage: seen.stage?, fraction })
        });
        let Some(found) = self.animator.found() else { return };
        for (detail, sketch) in found.sketches.iter().enumerate() {
            let Some(sketch) = sketch else { continue };
            let is_seen = |seen: &Arc<Sketch>| Arc::ptr_eq(seen, sketch);
            if self.found.sketches[detail].as_ref().is_some_and(is_seen) {
                continue;
            }
            let state = [State::Draft, State::Preview, State::Fine][detail];
            for frame in sketch.frames().filter(|&frame| sketch.is_ready(frame)) {
                if self.coverage.of(frame) < state {
                    self.coverage.set(frame, state);
                }
            }
        }
        self.problem = found.problem.clone();
        if found.problem.is_some() {
            self.coverage.fill(State::Failed);
        }
        self.found = found;
    }

    /// The best light there is for the frame that is shown; it may be of an older version while a newer one is worked on.
    pub fn sketch(&self) -> Option<&Arc<Sketch>> {
        let ready =
            |sketch: &&Arc<Sketch>| sketch.frames().contains(&self.frame) && sketch.is_ready(self.frame);
        let new = self.found.sketches.iter().rev().flatten();
        new.clone().find(ready).or(self.last.as_ref()).or_else(|| new.clone().next())
    }

    /// Whether what is shown is of the newest version.
    pub fn is_current(&self) -> bool {
        self.found.sketches.iter().any(Option::is_some)
    }

    /// How far each frame is.
    pub fn coverage(&self) -> &Coverage {
        &self.coverage
    }

    /// What is wrong with the project or its files.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// What the worker does now; none while it waits.
    pub fn activity(&self) -> Option<&Activity> {
        self.activity.as_ref()
    }
}
