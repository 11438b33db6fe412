//! Requests to the workers, sent once for each change.

use std::path::PathBuf;
use std::sync::Arc;

use lightloom_core::engine::{Preview, Shot};
use lightloom_core::project::Project;
use lightloom_core::render::{PlaneMaterial, ViewSettings};
use lightloom_core::scene::{CameraDesc, SceneDesc};

use super::orbit_worker::OrbitRequest;
use super::picture_worker::{Moment, PictureRequest, Plane};
use super::{LivePreview, Subject};
use crate::editor::session::Session;

/// Which pictures the views want.
#[derive(Clone, Debug, PartialEq)]
pub struct Wanted {
    /// How the plane is wanted.
    pub plane: Plane,
    /// Pixels of the shot, where it is wanted.
    pub shot: Option<[u32; 2]>,
    /// From where, and in how many pixels, a free look is wanted.
    pub look: Option<(CameraDesc, [u32; 2])>,
}

impl Default for Wanted {
    fn default() -> Self {
        Self { plane: Plane::Hidden, shot: None, look: None }
    }
}

/// What was asked for last.
#[derive(Default)]
pub(super) struct Requests {
    painted: Option<Painting>,
    staged: Option<Staging>,
    looked: Option<(Painting, Same<Project>, CameraDesc, [u32; 2])>,
}

/// An object by identity. It is kept, so that no other takes its address meanwhile.
struct Same<T>(Option<Arc<T>>);

impl<T> PartialEq for Same<T> {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        }
    }
}

/// All that a picture of a moment depends on.
#[derive(PartialEq)]
struct Painting {
    previews: [Same<Preview>; 2],
    shot: Same<Shot>,
    frame: i32,
    shown: Vec<bool>,
    view: ViewSettings,
    paper: PlaneMaterial,
    plane: Plane,
}

/// All that the picture without caustics depends on.
#[derive(Clone, PartialEq)]
struct Staging {
    scene: Option<SceneDesc>,
    aspect: f32,
    size: [u32; 2],
    seed: u64,
    /// Where its files are found, and whether from anywhere.
    files: (PathBuf, bool),
}

impl LivePreview {
    /// Sends the requests that were not sent yet.
    pub(super) fn request(&mut self, subject: &Subject, session: &Session, wanted: &Wanted) {
        self.request_shot(subject, wanted);
        let preview = self.preview().cloned();
        let moment = |preview: Arc<Preview>| {
            let shown = (0..preview.groups().len()).map(|group| session.shows_group(group)).collect();
            Moment { preview, frame: session.playhead, shown }
        };
        let other = self.other_preview();
        let shot = wanted.shot.and_then(|_| self.shot());
        let painting = Painting {
            previews: [Same(preview.clone()), Same(other.clone())],
            shot: Same(shot.clone()),
            frame: session.playhead,
            shown: preview
                .iter()
                .flat_map(|s| (0..s.groups().len()).map(|g| session.shows_group(g)))
                .collect(),
            view: subject.project.render.view.clone(),
            paper: paper(&subject.project),
            plane: wanted.plane,
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
            });
            self.requests.painted = Some(painting);
        }
    }

    fn request_shot(&mut self, subject: &Subject, wanted: &Wanted) {
        let Some(size) = wanted.shot else { return };
        let Project { scene, plane, seed, .. } = &*subject.project;
        let files = (subject.base.clone(), subject.external);
        let asked = Staging { scene: scene.clone(), aspect: plane.aspect, size, seed: *seed, files };
        if self.requests.staged.as_ref() != Some(&asked) {
            self.background.ask(subject.clone(), size);
            self.requests.staged = Some(asked);
        }
    }
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
