//! Requests to the workers, sent once for each change.

use std::sync::Arc;

use lightloom_core::engine::Preview;
use lightloom_core::project::{CausticKey, KeyFrame, Project, Shows};
use lightloom_core::render::PlaneMaterial;

use super::orbit_worker::OrbitRequest;
use super::picture_worker::{Moment, PictureRequest};
use super::requested::{BackgroundKey, FrameLight, PictureKey, Requests, Same, Wanted};
use super::{LivePreview, Subject};
use crate::editor::session::Session;

impl LivePreview {
    /// Sends the requests that were not sent yet.
    pub(super) fn request(&mut self, subject: &Subject, session: &Session, wanted: &Wanted) {
        self.request_shot(subject, wanted);
        // Where the scene is put right, the light of what it was would mislead.
        let is_lit = wanted.look.is_none() || !self.veil();
        let preview = self.preview().filter(|_| is_lit).cloned();
        let moment = |preview: Arc<Preview>| {
            let shown = (0..preview.groups().len()).map(|group| session.shows_group(group)).collect();
            Moment { preview, frame: session.playhead, shown }
        };
        let other = self.other_preview();
        let shot = wanted.shot.and_then(|_| self.shot());
        let painting = PictureKey {
            lights: [preview.clone(), other.clone()]
                .map(|preview| FrameLight { preview, frame: session.playhead }),
            shot: Same(shot.clone()),
            shown: preview
                .iter()
                .flat_map(|s| (0..s.groups().len()).map(|g| session.shows_group(g)))
                .collect(),
            view: subject.project.render.view.clone(),
            paper: paper(&subject.project),
            plane: wanted.plane,
            false_colour: session.overlays.false_colour,
        };
        if let Some((camera, size)) = &wanted.look {
            let asked = (painting, Same(Some(subject.project.clone())), camera.clone(), *size);
            if self.requests.looked.as_ref() != Some(&asked) {
                self.orbit.ask(OrbitRequest {
                    subject: subject.clone(),
                    camera: camera.clone(),
                    size: *size,
                    moment: preview.map(moment),
                    view: subject.project.render.view.clone(),
                });
                self.requests.looked = Some(asked);
            }
        } else if let Some(preview) = preview
            && self.requests.painted.as_ref() != Some(&painting)
        {
            self.pictures.ask(PictureRequest {
                moment: moment(preview),
                other: other.map(moment),
                view: subject.project.render.view.clone(),
                paper: paper(&subject.project),
                plane: wanted.plane,
                shot,
                false_colour: session.overlays.false_colour,
            });
            self.requests.painted = Some(painting);
        }
    }

    fn request_shot(&mut self, subject: &Subject, wanted: &Wanted) {
        self.shows_shot = wanted.shot.is_some();
        let Some(size) = wanted.shot else { return };
        let asked = background_key(subject, size);
        if self.requests.staged.as_ref() != Some(&asked) {
            self.background.ask(subject.clone(), size);
            self.requests.staged = Some(asked);
        }
    }
}

impl Requests {
    /// What was asked for of a project that is saved elsewhere now.
    pub(super) fn relocated(&mut self, subject: &Subject) {
        if let Some(staged) = &mut self.staged {
            *staged = background_key(subject, staged.size);
        }
        if let Some((_, project, ..)) = &mut self.looked {
            *project = Same(Some(subject.project.clone()));
        }
    }
}

fn background_key(subject: &Subject, size: [u32; 2]) -> BackgroundKey {
    let Project { scene, plane, seed, caustics, render, .. } = &*subject.project;
    BackgroundKey {
        scene: scene.clone(),
        aspect: plane.aspect,
        size,
        seed: *seed,
        caustics: caustics.clone(),
        physical: physical(&subject.project),
        kept_in_glass: render.kept_in_glass,
        plate: render.plate.clone(),
        files: (subject.base.clone(), subject.access.clone()),
    }
}

/// By key frame: what each caustic, and the rest, has of its physical light.
fn physical(Project { keys, caustics, flow, .. }: &Project) -> Vec<Vec<Option<[f32; 3]>>> {
    let of_key = |(i, key): (usize, &KeyFrame)| {
        let names = caustics.iter().map(|caustic| Some(caustic.name.as_str())).chain([None]);
        let of_caustic = |name: Option<&str>| {
            let gain = name.and_then(|name| key.caustics.get(name)).map_or([1.0; 3], CausticKey::gain);
            let rho = if i == 0 { 1.0 } else { flow.rho };
            (*key.shown_by(name) == Shows::PhysicalCaustic).then(|| gain.map(|channel| channel * rho))
        };
        names.map(of_caustic).collect()
    };
    keys.iter().enumerate().map(of_key).collect()
}

/// How light on the plane becomes visible.
pub(super) fn paper(project: &Project) -> PlaneMaterial {
    let receiver = project.scene.as_ref().and_then(|scene| scene.camera_and_receiver().ok());
    receiver.map_or(PlaneMaterial::WHITE, |(_, receiver)| PlaneMaterial::of(&receiver))
}

impl LivePreview {
    /// How light on the plane becomes visible.
    pub fn paper(&self) -> PlaneMaterial {
        self.subject.as_ref().map_or(PlaneMaterial::WHITE, |subject| paper(&subject.project))
    }
}
