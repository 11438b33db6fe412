//! The workers' results as the window shows them. Nothing here waits: the window asks, and shows what there is.

mod background_worker;
mod coverage;
pub mod false_colour;
mod figures;
mod flow;
pub mod gpu;
mod lamp_worker;
mod orbit_worker;
mod picture_worker;
mod preview_worker;
mod requested;
mod requests;
mod subject;
mod target;
pub mod worker;

use std::sync::Arc;

pub use coverage::{Coverage, State};
pub use flow::{FlowPicture, Followed, HeatMap};
use lightloom_core::Note;
use lightloom_core::engine::{Client, Preview, SegmentContinuity, Shot};
use lightloom_core::import::awaits_glass;
use lightloom_core::photon::LampLight;
use lightloom_core::project::Project;
pub use orbit_worker::Seen;
pub use picture_worker::{Painted, Plane};
pub use requested::Wanted;
pub use subject::Subject;
pub use target::TargetPicture;

use super::engine::SharedEngine;
use super::look::object::SceneObject;
use super::session::{Comparison, Panel, Session, ViewLayout};
use super::target_image::TargetImage;
use background_worker::BackgroundWorker;
use figures::FigureTaker;
use flow::FlowViewer;
use lamp_worker::LampWorker;
use orbit_worker::OrbitWorker;
use picture_worker::PictureWorker;
use preview_worker::{Found, PreviewWorker};
use requested::Requests;
use target::Targets;
use worker::Share;

/// The newest results, and what is still being worked on.
pub struct LivePreview {
    previews: PreviewWorker,
    /// What the wipe compares with.
    other: PreviewWorker,
    compared: Option<(Subject, Comparison)>,
    pictures: PictureWorker,
    background: BackgroundWorker,
    orbit: OrbitWorker,
    lamps: LampWorker,
    targets: Targets,
    flow: FlowViewer,
    figures: FigureTaker,
    requests: Requests,
    /// Whether the graphics card draws the photons.
    by_card: bool,
    /// Whether the shot is seen.
    shows_shot: bool,
    subject: Option<Subject>,
    frame: i32,
    found: Found,
    /// The light of the last version, shown until there is new one.
    last: Option<Arc<Preview>>,
    coverage: Coverage,
    problem: Option<String>,
    /// What a panic said, until the next edit.
    fault: Option<String>,
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

impl LivePreview {
    /// Nothing is worked on yet. `wake` is called from other threads whenever there is something new to see.
    pub fn new(engine: SharedEngine, wake: impl Fn() + Clone + Send + 'static) -> Self {
        Self {
            previews: PreviewWorker::new(engine.clone(), Client::Main, Share::Whole, wake.clone()),
            other: PreviewWorker::new(engine.clone(), Client::Comparison, Share::Half, wake.clone()),
            compared: None,
            pictures: PictureWorker::new(wake.clone()),
            background: BackgroundWorker::new(engine.clone(), wake.clone()),
            orbit: OrbitWorker::new(engine.clone(), wake.clone()),
            lamps: LampWorker::new(engine, wake.clone()),
            targets: Targets::new(wake.clone()),
            flow: FlowViewer::new(wake.clone()),
            figures: FigureTaker::new(wake),
            requests: Requests::default(),
            by_card: false,
            shows_shot: false,
            subject: None,
            frame: 0,
            found: Found::default(),
            last: None,
            coverage: Coverage::default(),
            problem: None,
            fault: None,
            activity: None,
        }
    }

    /// Whether the graphics card shall draw the photons of the plane, or the processor.
    pub fn draw_by_card(&mut self, by_card: bool) {
        self.by_card = by_card;
    }

    /// Whether the graphics card draws the photons of the plane.
    pub fn draws_photons(&self) -> bool {
        self.by_card
    }

    /// Shows this subject as the session and the views want it from now on: to be called in every frame of the window.
    pub fn follow(&mut self, subject: &Subject, session: &Session, wanted: &Wanted) {
        self.frame = session.playhead;
        if self.subject.as_ref().is_none_or(|last| !last.is(subject)) {
            if self.subject.as_ref().is_some_and(|last| last.base != subject.base) {
                self.figures.forget();
            }
            self.last = self.preview().cloned();
            self.found = Found::default();
            self.subject = Some(subject.clone());
            if self.fault.take().is_some() {
                self.ask_anew();
            }
            self.previews.ask(subject.clone(), self.frame);
            self.age(subject);
        }
        self.compare(subject, session);
        self.receive();
        let shown = TargetImage::at_playhead(&subject.project, session).map(|target| target.image);
        self.targets.follow(subject, shown);
        let preview = self.preview().cloned();
        self.flow.follow(preview.as_ref(), &subject.project, session);
        self.figures.follow(preview.as_ref(), session.panel == Panel::Numbers);
        let shown = session.panel == Panel::Scene || session.layout == ViewLayout::Orbit;
        self.lamps.follow(subject, session.focus.object.filter(|_| shown).and_then(SceneObject::light));
        self.request(subject, session, wanted);
    }

    /// Takes a subject for the one that is shown: a project saved elsewhere, whose files are the same.
    pub fn relocated(&mut self, subject: &Subject) {
        let Some(old) = self.subject.replace(subject.clone()) else { return };
        if let Some((compared, with)) = self.compared.take() {
            self.compared = compared.is(&old).then(|| (subject.clone(), with));
        }
        self.requests.relocated(subject);
    }

    /// Lets all workers do again what one of them may not have done.
    fn ask_anew(&mut self) {
        self.requests = Requests::default();
        self.lamps.ask_anew();
        self.targets.ask_anew();
        self.flow.ask_anew();
    }

    /// Works out the other side of the wipe.
    fn compare(&mut self, subject: &Subject, session: &Session) {
        let Some(wipe) = session.compare else {
            self.compared = None;
            return;
        };
        if self.compared.as_ref().is_some_and(|(of, with)| of.is(subject) && *with == wipe.with) {
            return;
        }
        self.compared = Some((subject.clone(), wipe.with));
        let project = Arc::new(other(&subject.project, wipe.with));
        self.other.ask(Subject { project, ..subject.clone() }, self.frame);
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
        let panics = [
            self.pictures.panicked(),
            self.background.panicked(),
            self.orbit.panicked(),
            self.lamps.panicked(),
            self.other.panicked(),
            self.flow.panicked(),
            self.figures.panicked(),
            self.targets.panicked(),
        ];
        if let Some(words) = self.previews.panicked().or_else(|| panics.into_iter().flatten().next()) {
            self.fault = Some(format!(
                "a fault of the program in the preview: {words}; the project is unharmed, and the next edit tries again"
            ));
            self.coverage.fill(State::Failed);
        }
        let background = || self.background.progress().filter(|_| self.shows_shot);
        self.activity = self.previews.progress().or_else(background).and_then(|seen| {
            let fraction = seen.fraction as f32;
            Some(Activity { stage: seen.stage?, fraction })
        });
        let Some(found) = self.previews.found() else {
            // While edits come quickly, as from a slider, the light of the last but one is better than that of long ago.
            self.last = self.previews.last().best(self.frame).or(self.last.as_ref()).cloned();
            return;
        };
        for (level, preview) in found.previews.iter().enumerate() {
            let Some(preview) = preview else { continue };
            let is_seen = |seen: &Arc<Preview>| Arc::ptr_eq(seen, preview);
            if self.found.previews[level].as_ref().is_some_and(is_seen) {
                continue;
            }
            let state = [State::Draft, State::Preview, State::Fine][level];
            for frame in preview.frames().filter(|&frame| preview.is_ready(frame)) {
                if self.coverage.of(frame) < state {
                    self.coverage.set(frame, state);
                }
            }
        }
        let awaits = self.subject.as_ref().is_some_and(|subject| awaits_glass(&subject.project));
        // That there is no glass yet is no fault: the window invites to bring one.
        self.problem = found.problem.clone().filter(|_| !awaits);
        if self.problem.is_some() {
            self.coverage.fill(State::Failed);
        }
        self.found = found;
    }

    /// The best light there is for the frame that is shown; it may be of an older version while a newer one is worked on.
    pub fn preview(&self) -> Option<&Arc<Preview>> {
        let any = || self.found.previews.iter().rev().flatten().next();
        self.found.best(self.frame).or(self.last.as_ref()).or_else(any)
    }

    /// The other side of the wipe at the frame that is shown.
    fn other_preview(&self) -> Option<Arc<Preview>> {
        self.compared.as_ref()?;
        self.other.found()?.best(self.frame).cloned()
    }

    /// The newest pictures of the plane and the shot.
    pub fn painted(&self) -> Painted {
        self.pictures.painted()
    }

    /// The last picture of the orbit view.
    pub fn look(&self) -> Seen {
        self.orbit.seen()
    }

    /// Where the light of the selected lamp goes; none while it is not known.
    pub fn lamp(&self, lamp: usize) -> Option<LampLight> {
        self.lamps.found(self.subject.as_ref()?, lamp)
    }

    /// The shot's camera with the picture without caustics, as far as it is worked out.
    pub fn shot(&self) -> Option<Arc<Shot>> {
        self.background.shot()
    }

    /// The picture towards which the light flows at the playhead.
    pub fn target(&self) -> Option<TargetPicture> {
        self.targets.found()
    }

    /// Notes on the project, all that are known by now; those of its last version while there are none of the newest.
    pub fn notes(&self) -> &[Note] {
        let newest = self.found.previews.iter().flatten().max_by_key(|preview| preview.notes().len());
        newest.or(self.last.as_ref()).map_or(&[], |preview| preview.notes())
    }

    /// Whether what is shown is of the newest version.
    pub fn is_current(&self) -> bool {
        self.found.previews.iter().any(Option::is_some)
    }

    /// Whether the pictures that are shown are those of the project as it is: light, paintings and what the camera sees besides are of
    /// its newest version.
    pub fn is_shown(&self) -> bool {
        let is_newest = |light: &Arc<Preview>| {
            self.found.previews.iter().flatten().any(|newest| newest.has_light_of(light, self.frame))
        };
        let shown = [self.pictures.painted().light, self.orbit.seen().light];
        let camera = !self.shows_shot || self.background.is_newest();
        self.problem.is_none() && camera && shown.iter().flatten().any(is_newest)
    }

    /// Whether a veil belongs over the pictures: the project is wrong, and they show what it was.
    pub fn veil(&self) -> bool {
        self.problem.is_some() && !self.is_current()
    }

    /// What is seen of the flow at the playhead; empty where nothing is shown of it.
    pub fn flow(&self) -> Arc<FlowPicture> {
        self.flow.found()
    }

    /// How well the light holds together in each segment, measured while the numbers are shown; none before.
    pub fn continuity(&self) -> Option<Arc<Vec<SegmentContinuity>>> {
        self.figures.found()
    }

    /// How far each frame is.
    pub fn coverage(&self) -> &Coverage {
        &self.coverage
    }

    /// What is wrong with the project or its files.
    pub fn problem(&self) -> Option<&str> {
        self.fault.as_deref().or(self.problem.as_deref())
    }

    /// What the worker does now; none while it waits.
    pub fn activity(&self) -> Option<&Activity> {
        self.activity.as_ref()
    }
}

/// The project as it is compared with.
fn other(project: &Project, with: Comparison) -> Project {
    match with {
        Comparison::Method(method) => Project { method, ..project.clone() },
        Comparison::NothingDrawn => Project { constraints: Vec::new(), ..project.clone() },
    }
}

#[cfg(test)]
mod tests;
