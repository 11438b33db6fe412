//! Drags along the time axis: one undo step from press to release, none after Escape.

use egui::{Key, Modifiers, Response, Ui};

use super::edits::BarPart;
use super::scale::Scale;
use crate::editor::action::Action;
use crate::editor::context::EditorContext;
use lightloom_core::constraint::Span;

/// A draggable element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Drag {
    /// A key frame, by index.
    Key(usize),
    /// A part of the bar of a constraint, by index.
    Bar(usize, BarPart),
}

/// The drag in progress.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Dragging {
    what: Option<Drag>,
    /// Time under the pointer when the button went down, frames.
    pressed: f64,
    /// Frame of the dragged element then.
    from: i32,
    span: Option<Span>,
}

impl Dragging {
    /// Starts a drag; all changes until its end are one undo step.
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

    /// As [`Self::begin`], for a bar with the span `span`.
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

    /// Whether this element is dragged.
    pub(super) fn holds(&self, what: Drag) -> bool {
        self.what == Some(what)
    }

    /// Initial frame of a dragged key.
    pub(super) fn from(&self) -> i32 {
        self.from
    }

    /// Initial span of a dragged bar.
    pub(super) fn span(&self) -> Option<Span> {
        self.span
    }

    /// Frames by which `what` was dragged so far; ends the drag on release and Escape.
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
