//! What is wanted of the painters, asked once for each change.

use std::path::PathBuf;
use std::sync::Arc;

use lightloom_core::engine::{Shot, Sketch};
use lightloom_core::project::Project;
use lightloom_core::render::{Paper, ViewSettings};
use lightloom_core::scene::{CameraDesc, SceneDesc};

use super::looker::Stand;
use super::painter::{Moment, Plane, Wish};
use super::{Preview, Subject};
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
pub(super) struct Wishes {
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
    sketches: [Same<Sketch>; 2],
    shot: Same<Shot>,
    frame: i32,
    shown: Vec<bool>,
    view: ViewSettings,
    paper: Paper,
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

impl Preview {
    /// Asks the painters for what is wanted and not asked for yet.
    pub(super) fn wish(&mut self, subject: &Subject, session: &Session, wanted: &Wanted) {
        self.wish_stage(subject, wanted);
        let sketch = self.sketch().cloned();
        let moment = |sketch: Arc<Sketch>| {
            let shown = (0..sketch.groups().len()).map(|group| session.shows_group(group)).collect();
            Moment { sketch, frame: session.playhead, shown }
        };
        let other = self.other_sketch();
        let shot = wanted.shot.and_then(|_| self.shot());
        let painting = Painting {
            sketches: [Same(sketch.clone()), Same(other.clone())],
            shot: Same(shot.clone()),
            frame: session.playhead,
            shown: sketch
                .iter()
                .flat_map(|s| (0..s.groups().len()).map(|g| session.shows_group(g)))
                .collect(),
            view: subject.project.render.view.clone(),
            paper: paper(&subject.project),
            plane: wanted.plane,
        };
        if let Some((camera, size)) = &wanted.look {
            let asked = (painting, Same(Some(subject.project.clone())), camera.clone(), *size);
            if self.wishes.looked.as_ref() != Some(&asked) {
                self.looker.ask(Stand {
                    subject: subject.clone(),
                    camera: camera.clone(),
                    size: *size,
                    moment: sketch.map(moment),
                    view: subject.project.render.view.clone(),
                });
                self.wishes.looked = Some(asked);
            }
        } else if let Some(sketch) = sketch
            && self.wishes.painted.as_ref() != Some(&painting)
        {
            self.painter.ask(Wish {
                moment: moment(sketch),
                other: other.map(moment),
                view: subject.project.render.view.clone(),
                paper: paper(&subject.project),
                plane: wanted.plane,
                shot,
            });
            self.wishes.painted = Some(painting);
        }
    }

    fn wish_stage(&mut self, subject: &Subject, wanted: &Wanted) {
        let Some(size) = wanted.shot else { return };
        let Project { scene, plane, seed, .. } = &*subject.project;
        let files = (subject.base.clone(), subject.external);
        let asked = Staging { scene: scene.clone(), aspect: plane.aspect, size, seed: *seed, files };
        if self.wishes.staged.as_ref() != Some(&asked) {
            self.stager.ask(subject.clone(), size);
            self.wishes.staged = Some(asked);
        }
    }
}

/// How light on the plane becomes visible.
pub(super) fn paper(project: &Project) -> Paper {
    let receiver = project.scene.as_ref().and_then(|scene| scene.camera_and_receiver().ok());
    receiver.map_or(Paper::WHITE, |(_, receiver)| Paper::of(&receiver))
}

impl Preview {
    /// How light on the plane becomes visible.
    pub fn paper(&self) -> Paper {
        self.subject.as_ref().map_or(Paper::WHITE, |subject| paper(&subject.project))
    }
}
