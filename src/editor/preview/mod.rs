//! What the worker finds out, and what the window shows of it.

mod coverage;
pub mod gpu;
pub mod worker;

pub use coverage::{Coverage, State};

/// The newest results, and what is still being worked on.
#[derive(Default)]
pub struct Preview {
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
