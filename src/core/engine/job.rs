//! The context of one piece of work: a prepared project, the stages, progress and costs.

use std::sync::Arc;

use glam::Vec2;

use super::bake::{Bake, baked};
use super::key_photons::PassLight;
use super::key_sources::KeySources;
use super::memo::{Client, Same, Slot};
use super::memo_keys::GuideInput;
use super::meter::Meter;
use super::stages::Stages;
use super::{Quality, prepare::Prepared};
use crate::photon::{EmissionGuide, Photons, Tracer};
use crate::project::Project;
use crate::scene::Scene;
use crate::{Progress, Result};

/// The context of all stages of one piece of work.
pub(super) struct Job<'a> {
    pub(super) stages: &'a Stages,
    pub(super) client: Client,
    pub(super) quality: Quality,
    pub(super) meter: &'a Meter,
    pub(super) progress: &'a Progress,
    pub(super) project: &'a Project,
    pub(super) extent: Vec2,
    pub(super) sources: &'a KeySources,
    pub(super) scene: Option<&'a Arc<Scene>>,
    /// Absent where no photons are traced.
    pub(super) guide: Option<Arc<EmissionGuide>>,
    /// Photons of one pass.
    pub(super) photons: usize,
    /// Most anchors of a map around walls.
    pub(super) anchors: usize,
    /// Whether photons and matching of pass 0 are remembered.
    pub(super) remembers: bool,
    /// Whether the flow may come from a bake, so that pass 0 is matched by its maps, as all others are.
    pub(super) baked: bool,
}

impl<'a> Job<'a> {
    /// Work on a prepared project; the emission guide is learnt if photons must be traced.
    ///
    /// # Errors
    /// No caustic falls on the receiver; cancelled.
    pub(super) fn new(
        stages: &'a Stages,
        client: Client,
        prepared: &'a Prepared,
        meter: &'a Meter,
        progress: &'a Progress,
    ) -> Result<Self> {
        let Prepared { project, extent, sources, quality, photons, .. } = prepared;
        let scene = prepared.scene.as_ref();
        let mut job = Self {
            stages,
            client,
            quality: *quality,
            meter,
            progress,
            project,
            extent: *extent,
            sources,
            scene,
            guide: None,
            photons: *photons,
            anchors: quality.anchors(),
            remembers: true,
            baked: prepared.bake.is_some(),
        };
        job.guide = match scene.filter(|_| sources.traces()) {
            Some(scene) => Some(job.learn_guide(scene, prepared.bake.as_deref())?),
            None => None,
        };
        Ok(job)
    }

    /// The emission guide of the scene, remembered.
    fn learn_guide(&self, scene: &Arc<Scene>, bake: Option<&Bake>) -> Result<Arc<EmissionGuide>> {
        let learn = || {
            let learn = || Tracer::new(scene, self.sources.seed(), self.progress);
            let learn = || baked(bake, "guide", || learn().map(|tracer| tracer.guide().clone()));
            self.meter.measure("trace", learn).map(Arc::new)
        };
        let Some(desc) = &self.project.scene else { return learn() };
        let input = GuideInput {
            geometry: Same::of(scene.geometry()),
            lights: desc.lights.iter().map(|light| light.casts_caustics().then(|| light.clone())).collect(),
            receiver: desc.receiver.clone(),
            seed: self.sources.seed(),
        };
        let slot = Slot { quality: Quality::Final, ..self.slot(0) };
        self.stages.guides.get(slot, input, self.progress, |_| learn())
    }

    /// The slot of a segment or key frame in a memo.
    pub(super) fn slot(&self, index: usize) -> Slot {
        Slot { client: self.client, quality: self.quality, index }
    }

    /// The tracer of the scene; none where no photons are traced.
    pub(super) fn tracer(&self) -> Option<Tracer<'a>> {
        self.scene.zip(self.guide.as_ref()).map(|(scene, guide)| Tracer::with_guide(scene, (**guide).clone()))
    }

    /// The light of the photons of `pass`; they are traced where a key frame shows them, or caustics are told apart.
    ///
    /// # Errors
    /// Far fewer photons land than were promised; cancelled.
    pub(super) fn light(&self, pass: u64) -> Result<PassLight> {
        let trace = |tracer: Tracer| Ok(tracer.trace(pass, self.photons, &self.progress.inner())?.0);
        let photons: Option<Photons> = match (self.tracer(), &self.guide) {
            (Some(tracer), Some(guide)) if pass == 0 && self.remembers => {
                let input = (Same::of(guide), self.photons);
                let traced = self.stages.photons.get(self.slot(0), input, self.progress, |_| {
                    self.meter.measure("trace", || trace(tracer).map(Arc::new))
                })?;
                Some((*traced).clone())
            }
            (Some(tracer), _) => Some(trace(tracer)?),
            (None, _) => None,
        };
        Ok(self.sources.light_of(photons, self.photons))
    }
}
