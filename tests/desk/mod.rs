//! A document with a window around one part of the editor, for tests.
#![allow(dead_code, reason = "each test file uses a part of it")]

use std::path::Path;

use lightloom::editor::action::Action;
use lightloom::editor::context::EditorContext;
use lightloom::editor::document::Document;
use lightloom::editor::preview::Preview;
use lightloom::editor::session::Session;
use lightloom::editor::{theme, timeline};
use lightloom_core::project::Project;

/// What the parts of the window see, and what they asked for.
pub(crate) struct Table {
    pub(crate) document: Document,
    pub(crate) session: Session,
    pub(crate) preview: Preview,
    /// All that was asked for, in order.
    pub(crate) asked: Vec<Action>,
    themed: bool,
}

impl Table {
    /// The project of this text, not saved yet.
    pub(crate) fn of(text: &str) -> Self {
        let project = Project::parse(text.as_bytes(), Path::new("test.json")).unwrap();
        Self::new(Document::new(project, None))
    }

    pub(crate) fn new(document: Document) -> Self {
        Self {
            document,
            session: Session::default(),
            preview: Preview::new(|| ()),
            asked: Vec::new(),
            themed: false,
        }
    }

    /// One frame: shows a part, then carries out what it asked for.
    pub(crate) fn frame<R>(&mut self, ctx: &egui::Context, show: impl FnOnce(&mut EditorContext) -> R) -> R {
        if !std::mem::replace(&mut self.themed, true) {
            theme::apply(ctx);
        }
        let mut actions = Vec::new();
        let shown = show(&mut EditorContext {
            document: &self.document,
            session: &mut self.session,
            preview: &self.preview,
            actions: &mut actions,
        });
        self.asked.extend(actions.iter().cloned());
        for action in actions {
            self.carry_out(action);
        }
        shown
    }

    fn carry_out(&mut self, action: Action) {
        match action {
            Action::Edit(edit) => self.document.edit(edit).unwrap(),
            Action::Settle => self.document.settle(),
            Action::Abort => self.document.abort(),
            Action::Playhead(frame) => self.session.playhead = frame,
            Action::Select(selection) => self.session.selection = selection,
            Action::Command(command) => {
                let mut actions = Vec::new();
                timeline::carry_out(
                    command,
                    &mut EditorContext {
                        document: &self.document,
                        session: &mut self.session,
                        preview: &self.preview,
                        actions: &mut actions,
                    },
                );
                actions.into_iter().for_each(|action| self.carry_out(action));
            }
            _ => (),
        }
    }

    /// Frames of the keys.
    pub(crate) fn keys(&self) -> Vec<i32> {
        self.document.project().keys.iter().map(|key| key.frame).collect()
    }
}
