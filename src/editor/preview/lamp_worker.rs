//! The worker that finds out where the light of the selected lamp goes.

use std::sync::{Arc, Mutex, PoisonError};

use lightloom_core::photon::LampLight;
use lightloom_core::scene::SceneDesc;

use super::subject::Subject;
use super::worker::{Share, Turn, Worker};
use crate::editor::access::Access;
use crate::editor::engine::SharedEngine;

/// What the light of a lamp depends on: the scene, its files, the lamp's index, the seed.
type Input = (Option<SceneDesc>, Access, usize, u64);

/// Follows the light of the newest lamp that is selected.
pub(super) struct LampWorker {
    worker: Worker<(Subject, Input)>,
    asked: Option<Input>,
    found: Arc<Mutex<Option<(Input, LampLight)>>>,
}

impl LampWorker {
    /// `wake` is called when the light was followed.
    pub(super) fn new(engine: SharedEngine, wake: impl Fn() + Clone + Send + 'static) -> Self {
        let found: Arc<Mutex<Option<(Input, LampLight)>>> = Arc::default();
        let theirs = found.clone();
        let tell = wake.clone();
        let worker = Worker::new("lamp", Share::Half, wake, move || {
            let (engine, found, tell) = (engine.clone(), theirs.clone(), tell.clone());
            move |(subject, input): (Subject, Input), turn: &Turn| {
                let engine = subject.engine(&engine);
                let light = engine.and_then(|e| e.lamp_light(&subject.project, input.2, &turn.progress));
                // What is wrong with the scene is told by the animation.
                let Ok(Some(light)) = light else { return };
                *found.lock().unwrap_or_else(PoisonError::into_inner) = Some((input, light));
                tell();
            }
        });
        Self { worker, asked: None, found }
    }

    /// Asks for the light of the lamp of index `lamp`; none asks for nothing.
    pub(super) fn follow(&mut self, subject: &Subject, lamp: Option<usize>) {
        let Some(lamp) = lamp else { return };
        let input = (subject.project.scene.clone(), subject.access.clone(), lamp, subject.project.seed);
        if self.asked.as_ref() != Some(&input) {
            self.worker.ask((subject.clone(), input.clone()));
            self.asked = Some(input);
        }
    }

    /// The light of a lamp as it is now; none while it is not known.
    pub(super) fn found(&self, subject: &Subject, lamp: usize) -> Option<LampLight> {
        let found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        let ((scene, access, of, seed), light) = found.as_ref()?;
        let is_of_files = *access == subject.access && *scene == subject.project.scene;
        let is_current = is_of_files && *of == lamp && *seed == subject.project.seed;
        is_current.then_some(*light)
    }

    /// Lets the next call ask, even if it is for the same.
    pub(super) fn ask_anew(&mut self) {
        self.asked = None;
    }

    /// What a panic of the worker said, once.
    pub(super) fn panicked(&self) -> Option<String> {
        self.worker.panicked()
    }
}
