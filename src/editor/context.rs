//! What every part of the window reads, and where it puts the actions it asks for.

use super::action::Action;
use super::document::Document;
use super::preview::LivePreview;
use super::session::Session;

/// The editor as one part of the window sees it for one frame.
pub struct EditorContext<'a> {
    /// The document, read only: changes are actions.
    pub document: &'a Document,
    /// The unsaved state of the window.
    pub session: &'a mut Session,
    /// The newest results of the preview's workers.
    pub preview: &'a LivePreview,
    /// The message in the status bar.
    pub status: &'a str,
    /// The actions asked for so far, in order.
    pub actions: &'a mut Vec<Action>,
}

impl EditorContext<'_> {
    /// Asks for an action.
    pub fn ask(&mut self, action: impl Into<Action>) {
        self.actions.push(action.into());
    }
}
