//! What the sections measure with.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use lightloom_core::engine::{Engine, MovingSegment, Quality, Summary};
use lightloom_core::project::Project;
use lightloom_core::{Error, Progress, Result};

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
    pub(super) engine: &'a Engine,
    /// As it is to be measured: at preview size when quick.
    pub(super) project: Project,
    pub(super) effort: Effort,
    /// A folder with room for the frames of a render.
    pub(super) scratch: &'a Path,
    first_move: Option<Arc<MovingSegment>>,
}

impl<'a> Workbench<'a> {
    /// Puts a project on the bench, and looks whether all its files are in order.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; cancelled.
    pub(super) fn new(
        engine: &'a Engine,
        project: &Project,
        effort: Effort,
        scratch: &'a Path,
        progress: &Progress,
    ) -> Result<Self> {
        progress.check()?;
        engine.check(project)?;
        let quality = match effort {
            Effort::Quick => Quality::Preview,
            Effort::Full => Quality::Final,
        };
        Ok(Self { engine, project: quality.apply(project), effort, scratch, first_move: None })
    }

    /// `quick` or `full`, whichever is asked for.
    pub(super) fn pick<T>(&self, quick: T, full: T) -> T {
        match self.effort {
            Effort::Quick => quick,
            Effort::Full => full,
        }
    }

    /// Renders a project into a folder that goes again, by a engine that remembers nothing of before.
    ///
    /// # Errors
    /// Anything wrong with the project or its files; input and output; cancelled.
    pub(super) fn render(&self, project: &Project, progress: &Progress) -> Result<Summary> {
        let folder =
            tempfile::tempdir_in(self.scratch).map_err(Error::io("make a folder in", self.scratch))?;
        self.engine.afresh().render(project, folder.path(), &progress.inner(), &|_| {})
    }

    /// The photons of the project's first pass at the first keys between which they move, matched. Made once.
    ///
    /// # Errors
    /// Nothing that moves; cancelled.
    pub(super) fn first_move(&mut self, progress: &Progress) -> Result<Arc<MovingSegment>> {
        if let Some(known) = &self.first_move {
            return Ok(known.clone());
        }
        let made = Arc::new(self.engine.moving_segment(&self.project, None, &progress.inner())?);
        Ok(self.first_move.insert(made).clone())
    }
}

/// What `work` returns, and the seconds of the fastest of some runs: others on the machine only ever make it slower. Ends early
/// once `enough` seconds are spent.
pub(super) fn fastest<T>(runs: usize, enough: f64, mut work: impl FnMut() -> Result<T>) -> Result<(T, f64)> {
    let (mut made, mut best) = timed(&mut work)?;
    let mut spent = best;
    for _ in 1..runs {
        if spent >= enough {
            break;
        }
        let seconds;
        (made, seconds) = timed(&mut work)?;
        best = best.min(seconds);
        spent += seconds;
    }
    Ok((made, best))
}

/// What `work` returns, and the seconds it took.
pub(super) fn timed<T>(work: impl FnOnce() -> Result<T>) -> Result<(T, f64)> {
    let start = Instant::now();
    Ok((work()?, start.elapsed().as_secs_f64()))
}
