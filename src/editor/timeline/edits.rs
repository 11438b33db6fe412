//! Edits of key frames and spans.

use lightloom_core::constraint::{Constraint, Span};
use lightloom_core::project::{KeyFrame, Project};

use crate::editor::document::Edit;

/// Range of frames of a project.
const FRAMES: std::ops::RangeInclusive<i32> = -1_000_000..=1_000_000;

/// Moves key `index` to `frame`, clamped between its neighbours; none where nothing changes.
pub(super) fn retime(keys: &[KeyFrame], index: usize, frame: i32) -> Option<Edit> {
    let lowest = index.checked_sub(1).map_or(*FRAMES.start(), |before| keys[before].frame + 1);
    let highest = keys.get(index + 1).map_or(*FRAMES.end(), |after| after.frame - 1);
    let frame = frame.clamp(lowest, highest.max(lowest));
    let mut keys = keys.to_vec();
    let key = keys.get_mut(index).filter(|key| key.frame != frame)?;
    key.frame = frame;
    Some(Edit::Keys(keys))
}

/// Adds a key at `frame` with the target of the key before; none where one exists.
pub(super) fn add_key(project: &Project, frame: i32) -> Option<Edit> {
    let keys = &project.keys;
    let after = keys.partition_point(|key| key.frame < frame);
    let taken = keys.get(after).is_some_and(|key| key.frame == frame);
    let model = keys.get(after.saturating_sub(1)).filter(|_| !taken && FRAMES.contains(&frame))?;
    let mut keys = keys.clone();
    keys.insert(after, KeyFrame { frame, ..model.clone() });
    Some(Edit::Keys(keys))
}

/// Duplicates key `index` halfway to the next one, or ten frames after the last.
pub(super) fn duplicate(project: &Project, index: usize) -> Option<Edit> {
    let keys = &project.keys;
    let key = keys.get(index)?;
    let frame = match keys.get(index + 1) {
        Some(next) => key.frame + (next.frame - key.frame) / 2,
        None => key.frame + 10,
    };
    // Between neighbours without a frame between them there is no room.
    let copy = KeyFrame { frame, ..key.clone() };
    let room = frame != key.frame && FRAMES.contains(&frame);
    room.then(|| {
        Edit::Keys(
            keys[..=index].iter().cloned().chain([copy]).chain(keys[index + 1..].iter().cloned()).collect(),
        )
    })
}

/// Removes a key; none where it is the only one.
pub(super) fn remove_key(project: &Project, index: usize) -> Option<Edit> {
    let keys = &project.keys;
    (keys.len() > 1 && index < keys.len()).then(|| {
        let mut keys = keys.clone();
        keys.remove(index);
        Edit::Keys(keys)
    })
}

/// Sets or removes the span of a constraint.
pub(super) fn span(project: &Project, index: usize, span: Option<Span>) -> Option<Edit> {
    let mut constraint = project.constraints.get(index)?.clone();
    let own = match &mut constraint {
        Constraint::DirectedLine(line) => &mut line.span,
        Constraint::Wall(wall) => &mut wall.span,
    };
    let changes = std::mem::replace(own, span) != span;
    changes.then(|| Edit::Change(vec![(index, constraint)]))
}

/// A part of the bar of a span.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BarPart {
    /// Its first frame.
    From,
    /// Its last.
    To,
    /// Both at once.
    Middle,
}

impl BarPart {
    /// The span after dragging this part by `frames`; its ends do not cross.
    pub(super) fn dragged(self, span: Span, frames: i32) -> Span {
        let fit = |frame: i32| frame.clamp(*FRAMES.start(), *FRAMES.end());
        match self {
            Self::From => Span { from: fit(span.from.saturating_add(frames)).min(span.to), ..span },
            Self::To => Span { to: fit(span.to.saturating_add(frames)).max(span.from), ..span },
            Self::Middle => {
                let by = frames.clamp(FRAMES.start() - span.from, FRAMES.end() - span.to);
                Span { from: span.from + by, to: span.to + by, ..span }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::path::Path;

    use super::*;

    fn project(frames: &[i32]) -> Project {
        let key =
            |frame: &i32| format!(r#"{{"frame":{frame},"shows":{{"image":{{"file":"{frame}.png"}}}}}}"#);
        let keys: Vec<_> = frames.iter().map(key).collect();
        let text = format!(r#"{{"lightloom":1,"keys":[{}]}}"#, keys.join(","));
        Project::parse(text.as_bytes(), Path::new("test.json")).unwrap()
    }

    fn frames(edit: Option<Edit>) -> Vec<i32> {
        let Some(Edit::Keys(keys)) = edit else { panic!("an edit of the keys") };
        keys.iter().map(|key| key.frame).collect()
    }

    #[test]
    fn a_key_stops_beside_its_neighbours() {
        let keys = project(&[1, 20, 40]).keys;
        assert_eq!(frames(retime(&keys, 1, 30)), [1, 30, 40]);
        assert_eq!(frames(retime(&keys, 1, 99)), [1, 39, 40]);
        assert_eq!(frames(retime(&keys, 1, -99)), [1, 2, 40]);
        assert_eq!(frames(retime(&keys, 2, i32::MAX)), [1, 20, 1_000_000]);
        assert_eq!(retime(&keys, 1, 20), None);
    }

    #[test]
    fn a_new_key_shows_what_the_one_before_it_shows() {
        let project = project(&[1, 20]);
        let Some(Edit::Keys(keys)) = add_key(&project, 7) else { panic!("a new key") };
        assert_eq!((keys[1].frame, &keys[1].shows), (7, &project.keys[0].shows));
        assert_eq!(frames(add_key(&project, -5)), [-5, 1, 20]);
        assert_eq!(frames(add_key(&project, 30)), [1, 20, 30]);
        assert_eq!(add_key(&project, 20), None);
    }

    #[test]
    fn copies_stand_after_their_key_and_need_room() {
        assert_eq!(frames(duplicate(&project(&[1, 21]), 0)), [1, 11, 21]);
        assert_eq!(frames(duplicate(&project(&[1, 21]), 1)), [1, 21, 31]);
        assert_eq!(duplicate(&project(&[1, 2]), 0), None);
    }

    #[test]
    fn the_last_key_stays() {
        assert_eq!(frames(remove_key(&project(&[1, 21]), 0)), [21]);
        assert_eq!(remove_key(&project(&[1]), 0), None);
    }

    #[test]
    fn ends_of_a_span_do_not_pass_each_other() {
        let span = Span { from: 10, to: 20, fade: 2 };
        assert_eq!(BarPart::From.dragged(span, 50), Span { from: 20, ..span });
        assert_eq!(BarPart::To.dragged(span, -50), Span { to: 10, ..span });
        assert_eq!(BarPart::Middle.dragged(span, -15), Span { from: -5, to: 5, ..span });
        assert_eq!(BarPart::Middle.dragged(span, i32::MAX).to, 1_000_000);
    }
}
