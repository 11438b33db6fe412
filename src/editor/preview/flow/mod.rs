//! The worker that looks at the field at the playhead: what arrows, streamlines, maps and trails are drawn from.

mod followed;
mod picture;
mod sample;
mod tears;

use std::sync::{Arc, Mutex, PoisonError};

use lightloom_core::engine::Preview;
use lightloom_core::project::Project;

use super::worker::{Share, Turn, Worker};
use crate::editor::session::{FieldMap, Overlays, Session};
use followed::WallGraph;
use picture::Request;
pub use picture::{FlowPicture, Followed, HeatMap};
use tears::TearFinder;

/// Looks at the newest field.
pub(super) struct FlowViewer {
    worker: Worker<Request>,
    asked: Option<Request>,
    found: Arc<Mutex<Arc<FlowPicture>>>,
}

impl FlowViewer {
    /// `wake` is called whenever there is something new to see.
    pub(super) fn new(wake: impl Fn() + Clone + Send + 'static) -> Self {
        let found: Arc<Mutex<Arc<FlowPicture>>> = Arc::default();
        let theirs = found.clone();
        let seen = wake.clone();
        let worker = Worker::new("flow view", Share::Half, wake, move || {
            let (found, seen) = (theirs.clone(), seen.clone());
            let (mut graph, mut tears) = (WallGraph::default(), TearFinder::default());
            move |request: Request, turn: &Turn| {
                let publish = |picture: &FlowPicture| {
                    *found.lock().unwrap_or_else(PoisonError::into_inner) = Arc::new(picture.clone());
                    seen();
                };
                answer(&request, turn, (&mut graph, &mut tears), &publish);
            }
        });
        Self { worker, asked: None, found }
    }

    /// Looks at a preview as the session wants it, unless nothing is wanted or that is what was asked for last.
    pub(super) fn follow(
        &mut self,
        preview: Option<&Arc<Preview>>,
        project: &Arc<Project>,
        session: &Session,
    ) {
        let show = session.overlays;
        let wanted = show.arrows || show.streamlines || show.trails || show.map.is_some();
        let request = preview.filter(|_| wanted || session.probe.is_some()).map(|preview| Request {
            preview: preview.clone(),
            project: project.clone(),
            frame: session.playhead,
            show: Overlays { drawn: false, target: false, grid: false, ..show },
            caustic: session.focus.caustic,
            probe: session.probe,
            arrows: sample::lattice(session.plane.zoom),
        });
        if request == self.asked {
            return;
        }
        match &request {
            Some(request) => self.worker.ask(request.clone()),
            None => *self.found.lock().unwrap_or_else(PoisonError::into_inner) = Arc::default(),
        }
        self.asked = request;
    }

    /// What was seen last; empty where nothing is wanted.
    pub(super) fn found(&self) -> Arc<FlowPicture> {
        if self.asked.is_none() {
            return Arc::default();
        }
        self.found.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Lets the next call ask, even if it is for the same.
    pub(super) fn ask_anew(&mut self) {
        self.asked = None;
    }

    /// What a panic said, once.
    pub(super) fn panicked(&self) -> Option<String> {
        self.worker.panicked()
    }
}

fn answer(
    request: &Request,
    turn: &Turn,
    (graph, tears): (&mut WallGraph, &mut TearFinder),
    publish: &dyn Fn(&FlowPicture),
) {
    let mut picture = turn.shielded(|_| sample::quickly(request));
    publish(&picture);
    // These take their time; the residual does around walls.
    let map = match request.show.map {
        Some(FieldMap::Residual) => sample::residual(request, &turn.progress),
        Some(FieldMap::Tears) => tears.map(request, &turn.progress),
        _ => None,
    };
    let followed = request.probe.and_then(|row| graph.follow(request, row, &turn.progress));
    if turn.progress.is_cancelled() || (map.is_none() && followed.is_none()) {
        return;
    }
    picture.map = map.or(picture.map);
    picture.followed = followed;
    publish(&picture);
}
