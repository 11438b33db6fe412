//! The playback commands of transport buttons, the menu Play and its shortcuts.

use lightloom_core::project::Project;

use super::edits;
use crate::editor::action::Action;
use crate::editor::command::Command;
use crate::editor::context::EditorContext;
use crate::editor::playback;

/// Carries out a playback command; returns whether it was one.
pub fn carry_out(command: Command, editor: &mut EditorContext) -> bool {
    let project = editor.document.project().clone();
    let frames = playback::played(&project, editor.session);
    let at = editor.session.playhead;
    match command {
        Command::PlayPause => play_or_pause(editor, &project),
        Command::NextFrame => go(editor, at.saturating_add(1)),
        Command::PreviousFrame => go(editor, at.saturating_sub(1)),
        Command::NextKey => go_to_key(editor, project.keys.iter().map(|k| k.frame).find(|frame| *frame > at)),
        Command::PreviousKey => {
            go_to_key(editor, project.keys.iter().rev().map(|k| k.frame).find(|frame| *frame < at));
        }
        Command::FirstFrame => go(editor, *frames.start()),
        Command::LastFrame => go(editor, *frames.end()),
        Command::MarkIn => mark(editor, 0),
        Command::MarkOut => mark(editor, 1),
        Command::ClearMarks => editor.session.marks = [None; 2],
        Command::ToggleLoop => editor.session.looping = !editor.session.looping,
        Command::AddKey => add_key(editor, &project, at),
        Command::Delete => return remove_key(editor, &project),
        _ => return false,
    }
    true
}

/// Asks for a key frame at `frame` as one undo step.
pub(super) fn add_key(editor: &mut EditorContext, project: &Project, frame: i32) {
    match edits::add_key(project, frame) {
        Some(edit) => {
            editor.session.focus.key = Some(project.keys.partition_point(|key| key.frame < frame));
            step(editor, edit);
        }
        None => editor.ask(Action::Say(format!("There is already a key frame at frame {frame}"))),
    }
}

/// Asks for one edit as one undo step.
pub(super) fn step(editor: &mut EditorContext, edit: impl Into<Action>) {
    editor.ask(Action::Settle);
    editor.ask(edit);
    editor.ask(Action::Settle);
}

/// Moves the playhead to a frame and pauses.
pub(super) fn go(editor: &mut EditorContext, frame: i32) {
    editor.session.playing = false;
    editor.ask(Action::Playhead(frame));
}

fn go_to_key(editor: &mut EditorContext, frame: Option<i32>) {
    if let Some(frame) = frame {
        go(editor, frame);
    }
}

/// Toggles playback; from the end it restarts at the first frame.
fn play_or_pause(editor: &mut EditorContext, project: &Project) {
    let frames = playback::played(project, editor.session);
    editor.session.playing = !editor.session.playing;
    if editor.session.playing && editor.session.playhead >= *frames.end() {
        editor.ask(Action::Playhead(*frames.start()));
    }
}

/// Sets a mark at the playhead; removes the other one if they would cross.
fn mark(editor: &mut EditorContext, end: usize) {
    let session = &mut *editor.session;
    session.marks[end] = Some(session.playhead);
    if let [Some(from), Some(to)] = session.marks
        && from > to
    {
        session.marks[1 - end] = None;
    }
}

/// Deletes the key frame in focus, unless constraints are selected.
fn remove_key(editor: &mut EditorContext, project: &Project) -> bool {
    if !editor.session.selection.is_empty() {
        return false;
    }
    let Some(edit) = editor.session.focus.key.and_then(|index| edits::remove_key(project, index)) else {
        return false;
    };
    editor.session.focus.key = None;
    step(editor, edit);
    true
}
