//! The target picture towards which the light flows at the playhead.

use lightloom_core::project::{KeyFrame, Project, Shows};
use lightloom_core::targets::{ImageTarget, Placement};

use super::session::Session;

/// A target picture, with the key frame and caustic that show it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TargetImage<'a> {
    /// Index of the key frame.
    key: usize,
    /// The caustic with a target of its own; none where the key frame's target serves all.
    caustic: Option<&'a str>,
    /// The picture.
    pub(super) image: &'a ImageTarget,
}

impl<'a> TargetImage<'a> {
    /// The picture of the first key frame at or after the playhead: that of the caustic in focus if it has one of its
    /// own. None where that key frame shows no picture.
    pub(super) fn at_playhead(project: &'a Project, session: &Session) -> Option<Self> {
        let after = project.keys.iter().position(|key| key.frame >= session.playhead);
        let key = after.or_else(|| project.keys.len().checked_sub(1))?;
        let name =
            session.focus.caustic.and_then(|i| project.caustics.get(i)).map(|caustic| caustic.name.as_str());
        let caustic =
            name.filter(|name| project.keys[key].caustics.get(*name).is_some_and(|own| own.shows.is_some()));
        match project.keys[key].shown_by(caustic) {
            Shows::Image(image) => Some(Self { key, caustic, image }),
            Shows::PhysicalCaustic | Shows::Points(_) => None,
        }
    }

    /// The project's key frames with this picture at another placement.
    pub(super) fn placed(&self, project: &Project, placement: &Placement) -> Vec<KeyFrame> {
        let mut keys = project.keys.clone();
        let shows = match self.caustic {
            Some(name) => keys[self.key].caustics.get_mut(name).and_then(|own| own.shows.as_mut()),
            None => Some(&mut keys[self.key].shows),
        };
        if let Some(Shows::Image(image)) = shows {
            image.placement = placement.clone();
        }
        keys
    }
}
