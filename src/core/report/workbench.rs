//! What the sections measure with.

use std::sync::Arc;
use std::time::Instant;

use crate::pipeline::{FirstMove, Pipeline, Quality};
use crate::project::Project;
use crate::{Progress, Result};

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// At preview size, within a minute.
    Quick,
    /// At the project's own size; minutes to an hour.
    Full,
}

/// A project on the bench.
pub(super) struct Workbench<'a> {
    pub(super) pipeline: &'a mut Pipeline,
    /// As it is to be measured: at preview size when quick.
    pub(super) project: Project,
    pub(super) effort: Effort,
    first_move: Option<Arc<FirstMove>>,
}

impl<'a> Workbench<'a> {
    /// Puts a project on the bench, and looks whether all its files are in order.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; cancelled.
    pub(super) fn new(
        pipeline: &'a mut Pipeline,
        project: &Project,
        effort: Effort,
        progress: &Progress,
    ) -> Result<Self> {
        progress.check()?;
        pipeline.check(project)?;
        let quality = match effort {
            Effort::Quick => Quality::Preview,
            Effort::Full => Quality::Final,
        };
        Ok(Self { pipeline, project: quality.apply(project), effort, first_move: None })
    }

    /// `quick` or `full`, whichever is asked for.
    pub(super) fn pick<T>(&self, quick: T, full: T) -> T {
        match self.effort {
            Effort::Quick => quick,
            Effort::Full => full,
        }
    }

    /// The photons of the project's first pass at the first keys between which they move, matched. Made once.
    ///
    /// # Errors
    /// Nothing that moves; cancelled.
    pub(super) fn first_move(&mut self, progress: &Progress) -> Result<Arc<FirstMove>> {
        if let Some(known) = &self.first_move {
            return Ok(known.clone());
        }
        let made = Arc::new(self.pipeline.first_move(&self.project, &progress.inner())?);
        Ok(self.first_move.insert(made).clone())
    }
}

/// What `work` returns, and the seconds it took.
pub(super) fn timed<T>(work: impl FnOnce() -> Result<T>) -> Result<(T, f64)> {
    let start = Instant::now();
    Ok((work()?, start.elapsed().as_secs_f64()))
}
