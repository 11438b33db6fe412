//! The panels: they read the document and answer with actions.

use super::action::Action;
use super::document::Document;
use super::preview::Preview;
use super::session::Session;

/// What a panel sees, and where it puts what it asks for.
pub struct Desk<'a> {
    /// The document, to read.
    pub document: &'a Document,
    /// The state of the window, to change.
    pub session: &'a mut Session,
    /// What the worker found out last.
    pub preview: &'a Preview,
    /// What is asked for.
    pub actions: &'a mut Vec<Action>,
}

impl Desk<'_> {
    /// Asks for something.
    pub fn ask(&mut self, action: impl Into<Action>) {
        self.actions.push(action.into());
    }
}
