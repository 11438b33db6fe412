//! File selection through the system's dialog, or the built-in one where the system has none.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError};

use std::time::{Duration, Instant};

use egui::Context;

use super::browser::{Browser, home};
use super::modal::modal;
use super::request::{Dialogs, PickRequest, PickResult, Purpose, with_ending};
use crate::editor::key_queue::Taker;

/// Time after which it is said that the system's dialog is open, or still to come.
const PATIENCE: Duration = Duration::from_millis(400);
/// Most recent folders.
const MOST_RECENT: usize = 20;

/// A file picker with at most one open dialog.
pub struct Picker {
    dialogs: Arc<dyn Dialogs>,
    state: PickerState,
    /// Folders used of late, newest first.
    recent: Vec<PathBuf>,
}

enum PickerState {
    Idle,
    /// The system's dialog is open.
    Asked(PickRequest, Receiver<PickResult>, Meanwhile),
    /// The built-in dialog is open.
    Browsing(PickRequest, Box<Browser>),
}

/// What happens until the system's dialog answers.
struct Meanwhile {
    since: Instant,
}

/// What the user does while the system's dialog is open.
enum Waiting {
    On,
    BuiltIn,
    Cancel,
}

impl Picker {
    /// A picker that uses these dialogs.
    pub fn new(dialogs: Arc<dyn Dialogs>) -> Self {
        Self { dialogs, state: PickerState::Idle, recent: Vec::new() }
    }

    /// Remembers a folder that was used.
    pub fn remember(&mut self, folder: &std::path::Path) {
        self.recent.retain(|known| known != folder);
        self.recent.insert(0, folder.to_owned());
        self.recent.truncate(MOST_RECENT);
    }

    /// Opens a dialog; one that is already open is dropped.
    pub fn ask(&mut self, request: PickRequest, ctx: &Context) {
        let folder = Some(begins_in(request.folder.clone(), &self.recent));
        let request = PickRequest { folder, ..request };
        let answer = self.dialogs.pick(&request, ctx.clone());
        // What is typed from now on is meant for the dialog.
        ctx.memory_mut(|memory| memory.focused().map(|id| memory.surrender_focus(id)));
        self.state = PickerState::Asked(request, answer, Meanwhile { since: Instant::now() });
        // An answer may be there already.
        ctx.request_repaint();
    }

    /// Whether a dialog is open.
    pub fn is_open(&self) -> bool {
        !matches!(self.state, PickerState::Idle)
    }

    /// Whether it is not known yet whose dialog it will be, or the system's is open.
    pub(in crate::editor) fn is_waiting(&self) -> bool {
        matches!(self.state, PickerState::Asked(..))
    }

    /// Who takes the keys, as far as the dialog goes.
    pub(in crate::editor) fn taker(&self, ctx: &Context) -> Taker {
        match &self.state {
            PickerState::Asked(_, _, meanwhile) if meanwhile.is_long() => Taker::Doubtful,
            PickerState::Asked(..) => Taker::Coming,
            PickerState::Browsing(_, browser) if !browser.takes_keys(ctx) => Taker::Coming,
            PickerState::Browsing(..) | PickerState::Idle => Taker::Shown,
        }
    }

    /// Shows the built-in dialog where it is needed; returns the chosen file.
    pub fn show(&mut self, ctx: &Context) -> Option<(Purpose, PathBuf)> {
        match std::mem::replace(&mut self.state, PickerState::Idle) {
            PickerState::Idle => None,
            PickerState::Asked(request, answer, meanwhile) => match answer.try_recv() {
                Ok(PickResult::Picked(path)) => Some(self.picked(request.purpose, path)),
                Ok(PickResult::Cancelled) => None,
                Err(TryRecvError::Empty) => {
                    match meanwhile.show(ctx) {
                        Waiting::On => self.state = PickerState::Asked(request, answer, meanwhile),
                        Waiting::BuiltIn => self.browse(request, ctx),
                        Waiting::Cancel => (),
                    }
                    None
                }
                Ok(PickResult::Unavailable) | Err(TryRecvError::Disconnected) => {
                    self.browse(request, ctx);
                    None
                }
            },
            PickerState::Browsing(request, mut browser) => match browser.show(ctx) {
                None => {
                    self.state = PickerState::Browsing(request, browser);
                    None
                }
                Some(None) => None,
                Some(Some(path)) => Some(self.picked(request.purpose, path)),
            },
        }
    }

    fn browse(&mut self, request: PickRequest, ctx: &Context) {
        let browser = Box::new(Browser::new(&request, &self.recent, ctx));
        self.state = PickerState::Browsing(request, browser);
        ctx.request_repaint();
    }

    fn picked(&mut self, purpose: Purpose, path: PathBuf) -> (Purpose, PathBuf) {
        let path = with_ending(&purpose, path);
        let folder = if purpose.files().1.is_empty() { Some(&*path) } else { path.parent() };
        if let Some(folder) = folder.map(ToOwned::to_owned) {
            self.remember(&folder);
        }
        (purpose, path)
    }
}

/// The folder in which a dialog begins: the wanted one, the last used, or Home.
fn begins_in(wanted: Option<PathBuf>, recent: &[PathBuf]) -> PathBuf {
    wanted.or_else(|| recent.first().cloned()).unwrap_or_else(|| home("~"))
}

impl Meanwhile {
    /// Whether it is said that the system's dialog is open.
    fn is_long(&self) -> bool {
        self.since.elapsed() >= PATIENCE
    }

    /// Says that the system's dialog is open, where it is not over the window, and what else can be done.
    fn show(&self, ctx: &Context) -> Waiting {
        let waited = self.since.elapsed();
        if waited < PATIENCE {
            ctx.request_repaint_after(PATIENCE - waited);
            return Waiting::On;
        }
        let mut does = Waiting::On;
        let shown = modal(ctx, "system dialog").show(ctx, |ui| {
            ui.set_width(340.0);
            ui.heading("The system's file dialog is open");
            ui.label("It may lie behind this window.");
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                if ui.button("Use Lightloom's own").clicked() {
                    does = Waiting::BuiltIn;
                }
                if ui.button("Cancel").clicked() {
                    does = Waiting::Cancel;
                }
            });
        });
        if shown.should_close() { Waiting::Cancel } else { does }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dialog_begins_where_it_is_wanted_else_where_the_last_one_ended_else_at_home() {
        let [wanted, last] = ["/a", "/b"].map(PathBuf::from);
        assert_eq!(begins_in(Some(wanted.clone()), std::slice::from_ref(&last)), wanted);
        assert_eq!(begins_in(None, std::slice::from_ref(&last)), last);
        assert_eq!(begins_in(None, &[]), home("~"));
    }
}
