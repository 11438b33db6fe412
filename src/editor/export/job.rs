//! One export: a frozen project, rendered by the same code as `lightloom render`.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicI32, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use lightloom_core::engine::{
    Client, Existing, Output, Plan, RenderObserver, Summary, prepare_film, prepare_folder, write_report,
};
use lightloom_core::progress::Snapshot;
use lightloom_core::project::Project;
use lightloom_core::render::Image;
use lightloom_core::{Error, Progress, Result};

use super::convergence::{Convergence, Point};
use crate::editor::access::Access;
use crate::editor::engine::SharedEngine;
use crate::editor::guard::Guard;

/// Longest side of the growing picture, pixels.
const PICTURE: usize = 480;
/// How often the window is told that something may have changed, and the time limit is looked at.
const TICK: Duration = Duration::from_millis(100);

/// The place of the error where frames of another render are in the folder.
const OCCUPIED: &str = "--out";

/// What to export. Later changes of the document do not touch it.
#[derive(Clone, Debug)]
pub struct ExportSettings {
    /// The project as it shall be rendered.
    pub project: Arc<Project>,
    /// The project file, whose folder the project's paths are relative to.
    pub file: PathBuf,
    /// Which files outside of that folder it may read.
    pub access: Access,
    /// The folder for the frames; made if it is not there.
    pub folder: PathBuf,
    /// The file of a film of all frames, where one is wanted.
    pub film: Option<PathBuf>,
    /// Working time after which no further pass is begun; the first is always completed. None for all passes.
    pub limit: Option<Duration>,
    /// The frame that is shown while it grows.
    pub shown: i32,
    /// What becomes of frames of other renders that are in the folder.
    pub existing: Existing,
}

/// How an export stands.
#[derive(Clone, Debug, PartialEq)]
pub enum Status {
    /// It waits for those before it.
    Waiting,
    /// It is being rendered.
    Running,
    /// All frames are there, with all passes or those that the time allowed.
    Done(Outcome),
    /// The user broke it off.
    Cancelled,
    /// It could not be done, and why.
    Failed(String),
    /// Frames of another render are in the folder, and nothing was done: the user decides what becomes of them.
    Occupied(String),
}

/// What was exported.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Frames.
    pub frames: usize,
    /// Passes of each.
    pub passes: usize,
    /// Passes that were planned.
    pub planned: usize,
    /// Frames that hold values which had to be replaced.
    pub bad: bool,
}

/// What it will cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Passes that are planned.
    pub passes: usize,
    /// Expected peak memory in MiB: it does not grow with the number of frames.
    pub memory_mib: f64,
    /// Expected size of the file on the disk that holds the unfinished frames, in MiB.
    pub scratch_mib: f64,
}

/// A frame as it stands.
#[derive(Clone, Debug)]
pub struct Growing {
    /// Its number.
    pub frame: i32,
    /// The passes that are in it.
    pub passes: usize,
    /// Screen values, at most 480 pixels on the longer side.
    pub image: Arc<Image>,
}

/// An export, as the window sees it.
pub struct ExportJob {
    settings: ExportSettings,
    engine: SharedEngine,
    progress: Progress,
    stop_asked: AtomicBool,
    /// Whether it is offered again at the next start: the window is closed while it works.
    left: AtomicBool,
    shown: AtomicI32,
    state: Mutex<State>,
}

struct State {
    status: Status,
    cost: Option<Cost>,
    passes: usize,
    files: usize,
    picture: Option<Growing>,
    convergence: Convergence,
    /// When the work was planned and began.
    begun: Option<Instant>,
}

impl ExportJob {
    pub(super) fn new(settings: ExportSettings, engine: SharedEngine) -> Self {
        let state = State {
            status: Status::Waiting,
            cost: None,
            passes: 0,
            files: 0,
            picture: None,
            convergence: Convergence::default(),
            begun: None,
        };
        Self {
            shown: AtomicI32::new(settings.shown),
            settings,
            engine,
            progress: Progress::new(),
            stop_asked: AtomicBool::new(false),
            left: AtomicBool::new(false),
            state: Mutex::new(state),
        }
    }

    /// How the noise of the shown frame falls, from pass to pass.
    pub fn noise(&self) -> Vec<Point> {
        self.state().convergence.points().to_vec()
    }

    /// What is exported.
    pub fn settings(&self) -> &ExportSettings {
        &self.settings
    }

    /// How it stands.
    pub fn status(&self) -> Status {
        self.state().status.clone()
    }

    /// What it will cost, once that is known.
    pub fn cost(&self) -> Option<Cost> {
        self.state().cost
    }

    /// Passes that are complete.
    pub fn passes(&self) -> usize {
        self.state().passes
    }

    /// Files that are complete.
    pub fn files(&self) -> usize {
        self.state().files
    }

    /// The frame that is looked at, as it stood after the last pass.
    pub fn picture(&self) -> Option<Growing> {
        self.state().picture.clone()
    }

    /// How far it is.
    pub fn progress(&self) -> Snapshot {
        self.progress.snapshot()
    }

    /// Whether it waits or is being rendered.
    pub fn is_open(&self) -> bool {
        matches!(self.state().status, Status::Waiting | Status::Running)
    }

    /// Whether it rests.
    pub fn is_paused(&self) -> bool {
        self.progress.is_paused()
    }

    /// Lets it rest, within a fraction of a second.
    pub fn pause(&self) {
        self.progress.pause();
    }

    /// Lets it go on.
    pub fn resume(&self) {
        self.progress.resume();
    }

    /// Cancels the export; nothing more is written. Frames that are complete already stay.
    pub fn cancel(&self) {
        self.progress.abandon();
        let mut state = self.state();
        if state.status == Status::Waiting {
            state.status = Status::Cancelled;
        }
    }

    /// Breaks it off because the window closes; it is offered again at the next start.
    pub(super) fn leave(&self) {
        self.left.store(true, Relaxed);
        self.cancel();
    }

    /// Whether nothing is left to do of it, so that it is not offered again.
    pub(super) fn is_settled(&self) -> bool {
        let settled = matches!(self.status(), Status::Done(_) | Status::Cancelled | Status::Occupied(_));
        settled && !self.left.load(Relaxed)
    }

    /// Ends it with the passes that are complete; before the first it goes on until that is.
    pub fn stop(&self) {
        self.stop_asked.store(true, Relaxed);
        self.progress.resume();
        self.end_passes();
    }

    /// Lets no further pass begin once the first is complete; what is being written is completed.
    fn end_passes(&self) {
        if self.passes() > 0 && self.progress.snapshot().stage == Some("render") {
            self.progress.cancel();
        }
    }

    /// Looks at another frame from the next pass on; one that is not rendered changes nothing.
    pub fn show(&self, frame: i32) {
        self.shown.store(frame, Relaxed);
    }

    pub(super) fn fail(&self, why: &str) {
        self.state().status = Status::Failed(why.to_owned());
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Renders, and notes what came of it. A panic is a failure like another.
    pub(super) fn run(&self, guard: &Guard, wake: &(dyn Fn() + Sync)) {
        if self.progress.is_abandoned() {
            return;
        }
        tracing::info!("export into '{}' begins", self.settings.folder.display());
        self.state().status = Status::Running;
        let finished = AtomicBool::new(false);
        let done = thread::scope(|scope| {
            let ticker = scope.spawn(|| self.tick(&finished, wake));
            let done = status_of(guard.run(|| self.render()));
            finished.store(true, Relaxed);
            ticker.thread().unpark();
            done
        });
        tracing::info!("export into '{}': {done:?}", self.settings.folder.display());
        self.state().status = done;
        wake();
    }

    fn render(&self) -> Result<Summary> {
        let ExportSettings { project, file, access, folder, film, existing, .. } = &self.settings;
        let engine = self.engine.of(file, access)?.on_behalf_of(Client::Export);
        prepare_folder(folder, file, project, "folder")?;
        if let Some(film) = film {
            prepare_film(film, file, project, "film")?;
        }
        let saved = |_: &Path| self.state().files += 1;
        let (film, progress) = (film.as_deref(), &self.progress);
        let output =
            Output { film, observer: self, existing: *existing, ..Output::new(folder, progress, &saved) };
        // Threads of its own, one less than the machine has: they may rest without those of the preview, and leave
        // the window one to answer with.
        let threads = thread::available_parallelism().map_or(1, |n| n.get().saturating_sub(1).max(1));
        let pool =
            rayon::ThreadPoolBuilder::new().num_threads(threads).thread_name(|i| format!("export {i}"));
        let pool = pool
            .build()
            .map_err(|e| Error::value("threads", format!("the system does not start them: {e}")))?;
        let summary = pool.install(|| engine.render_to(project, &output))?;
        if summary.is_of_all() {
            write_report(folder, "summary.json", &summary.to_json())?;
        }
        Ok(summary)
    }

    /// Wakes the window now and then, and ends the work when its time is over.
    fn tick(&self, finished: &AtomicBool, wake: &(dyn Fn() + Sync)) {
        let begun = Instant::now();
        while !finished.load(Relaxed) {
            let worked = begun.elapsed().saturating_sub(self.progress.rested());
            let over =
                self.settings.limit.is_some_and(|limit| worked >= limit) || self.stop_asked.load(Relaxed);
            if over {
                self.end_passes();
            }
            wake();
            thread::park_timeout(TICK);
        }
    }
}

impl RenderObserver for ExportJob {
    fn keeps_unfinished(&self) -> bool {
        self.left.load(Relaxed)
    }

    fn planned(&self, plan: &Plan) {
        let Plan { passes, memory_mib, scratch_mib, .. } = *plan;
        let mut state = self.state();
        state.cost = Some(Cost { passes, memory_mib, scratch_mib });
        state.begun.get_or_insert_with(Instant::now);
    }

    fn passed(&self, passes: usize, picture: &dyn Fn(i32) -> Result<Option<Image>>) {
        // A picture that cannot be made now is no reason to break off; what is wrong shows when frames are written.
        let frame = self.shown.load(Relaxed);
        let seen = picture(frame).ok().flatten();
        let mut state = self.state();
        state.passes = passes;
        if let Some(image) = seen {
            let begun = *state.begun.get_or_insert_with(Instant::now);
            let worked = begun.elapsed().saturating_sub(self.progress.rested());
            state.convergence.add((frame, passes), worked, &image);
            let image = small(image);
            state.picture = Some(Growing { frame, passes, image: Arc::new(image) });
        }
    }
}

/// What came of the work.
fn status_of(done: Result<Result<Summary>, String>) -> Status {
    match done {
        Ok(Ok(summary)) => Status::Done(outcome(&summary)),
        Ok(Err(Error::Cancelled)) => Status::Cancelled,
        Ok(Err(Error::Value { place, what })) if place == OCCUPIED => Status::Occupied(what),
        Ok(Err(error)) => Status::Failed(error.to_string()),
        Err(words) => Status::Failed(format!(
            "a fault of the program: {words}; what is finished is kept, export again to go on from there"
        )),
    }
}

fn small(image: Image) -> Image {
    let side = image.width.max(image.height);
    if side <= PICTURE {
        return image;
    }
    let fit = |pixels: usize| (pixels * PICTURE / side).max(1);
    image.resized(fit(image.width), fit(image.height))
}

fn outcome(summary: &Summary) -> Outcome {
    Outcome {
        frames: summary.frames,
        passes: summary.passes,
        planned: summary.passes_planned,
        bad: summary.has_bad_frames(),
    }
}
