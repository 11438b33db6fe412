//! What is dragged along the time axis: one undo step from press to release, none after Escape.

use egui::{Key, Modifiers, Response, Ui};

use super::edits::BarPart;
use super::scale::Scale;
use crate::editor::action::Action;
use crate::editor::context::EditorContext;
use lightloom_core::constraint::Span;

/// What can be dragged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Drag {
    /// A key frame, by index.
    Key(usize),
    /// A part of the bar of a constraint, by index.
    Bar(usize, BarPart),
}

/// What is being dragged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Dragging {
    what: Option<Drag>,
    /// The moment under the pointer when the button went down, frames.
    pressed: f64,
    /// Where the dragged stood then.
    from: i32,
    span: Option<Span>,
}

impl Dragging {
    /// Takes hold of something; the change until it is let go is one step.
    pub(super) fn begin(&mut self, editor: &mut EditorContext, what: Drag, scale: &Scale, ui: &Ui) {
        let Some(at) = ui.input(|i| i.pointer.press_origin()) else { return };
        editor.session.playing = false;
        editor.ask(Action::Settle);
        let project = editor.document.project();
        let from = match what {
            Drag::Key(index) => project.keys.get(index).map_or(0, |key| key.frame),
            Drag::Bar(..) => 0,
        };
        *self = Self { what: Some(what), pressed: scale.moment(at.x), from, span: None };
    }

    /// As [`Self::begin`], for a bar that stood at `span`.
    pub(super) fn begin_bar(
        &mut self,
        editor: &mut EditorContext,
        what: Drag,
        span: Span,
        scale: &Scale,
        ui: &Ui,
    ) {
        self.begin(editor, what, scale, ui);
        self.span = Some(span);
    }

    /// Whether this is dragged.
    pub(super) fn holds(&self, what: Drag) -> bool {
        self.what == Some(what)
    }

    /// Where a key stood when it was taken hold of.
    pub(super) fn from(&self) -> i32 {
        self.from
    }

    /// Where a bar stood when it was taken hold of.
    pub(super) fn span(&self) -> Option<Span> {
        self.span
    }

    /// By how many frames `what` was dragged so far; ends the drag at release and at Escape.
    pub(super) fn frames(
        &mut self,
        ui: &Ui,
        response: &Response,
        what: Drag,
        scale: &Scale,
        editor: &mut EditorContext,
    ) -> Option<i32> {
        if !self.holds(what) {
            return None;
        }
        if ui.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape)) {
            *self = Self::default();
            editor.ask(Action::Abort);
            return None;
        }
        if !response.dragged() {
            *self = Self::default();
            editor.ask(Action::Settle);
            return None;
        }
        let at = response.interact_pointer_pos()?;
        Some((scale.moment(at.x) - self.pressed).round() as i32)
    }
}
