//! The commands of time: what the transport buttons, the menu Play and its keys do.

use lightloom_core::project::Project;

use super::moves;
use crate::editor::action::Action;
use crate::editor::command::Command;
use crate::editor::panels::Desk;
use crate::editor::playback;

/// Carries a command of time out; tells whether it was one.
pub fn carry_out(command: Command, desk: &mut Desk) -> bool {
    let project = desk.document.project().clone();
    let frames = playback::played(&project, desk.session);
    let at = desk.session.playhead;
    match command {
        Command::PlayPause => play_or_pause(desk, &project),
        Command::NextFrame => go(desk, at.saturating_add(1)),
        Command::PreviousFrame => go(desk, at.saturating_sub(1)),
        Command::NextKey => go_to_key(desk, project.keys.iter().map(|k| k.frame).find(|frame| *frame > at)),
        Command::PreviousKey => {
            go_to_key(desk, project.keys.iter().rev().map(|k| k.frame).find(|frame| *frame < at));
        }
        Command::FirstFrame => go(desk, *frames.start()),
        Command::LastFrame => go(desk, *frames.end()),
        Command::MarkIn => mark(desk, 0),
        Command::MarkOut => mark(desk, 1),
        Command::ClearMarks => desk.session.marks = [None; 2],
        Command::ToggleLoop => desk.session.looping = !desk.session.looping,
        Command::AddKey => add_key(desk, &project, at),
        Command::Delete => return remove_key(desk, &project),
        _ => return false,
    }
    true
}

/// Asks for a key at `frame` as a step of its own.
pub(super) fn add_key(desk: &mut Desk, project: &Project, frame: i32) {
    match moves::add_key(project, frame) {
        Some(edit) => {
            desk.session.focus.key = Some(project.keys.partition_point(|key| key.frame < frame));
            step(desk, edit);
        }
        None => desk.ask(Action::Say(format!("A key frame stands at frame {frame} already"))),
    }
}

/// Asks for one change as a step of its own.
pub(super) fn step(desk: &mut Desk, edit: impl Into<Action>) {
    desk.ask(Action::Settle);
    desk.ask(edit);
    desk.ask(Action::Settle);
}

/// Goes to a frame and stops.
pub(super) fn go(desk: &mut Desk, frame: i32) {
    desk.session.playing = false;
    desk.ask(Action::Playhead(frame));
}

fn go_to_key(desk: &mut Desk, frame: Option<i32>) {
    if let Some(frame) = frame {
        go(desk, frame);
    }
}

/// At the end of what is played it begins at the first frame.
fn play_or_pause(desk: &mut Desk, project: &Project) {
    let frames = playback::played(project, desk.session);
    desk.session.playing = !desk.session.playing;
    if desk.session.playing && desk.session.playhead >= *frames.end() {
        desk.ask(Action::Playhead(*frames.start()));
    }
}

/// A mark at the playhead; the other one goes where it would stand on the wrong side.
fn mark(desk: &mut Desk, end: usize) {
    let session = &mut *desk.session;
    session.marks[end] = Some(session.playhead);
    if let [Some(from), Some(to)] = session.marks
        && from > to
    {
        session.marks[1 - end] = None;
    }
}

/// Deletes the key in focus where nothing that was drawn is selected.
fn remove_key(desk: &mut Desk, project: &Project) -> bool {
    if !desk.session.selection.is_empty() {
        return false;
    }
    let Some(edit) = desk.session.focus.key.and_then(|index| moves::remove_key(project, index)) else {
        return false;
    };
    desk.session.focus.key = None;
    step(desk, edit);
    true
}
