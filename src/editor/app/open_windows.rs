//! The windows over the window, and which of them are open.

use crate::editor::export::ExportWindow;
use crate::editor::palette::Palette;
use crate::editor::shortcuts::ShortcutSheet;
use crate::editor::tour::{Anchors, Tour};
use crate::editor::welcome::Welcome;

/// The windows, and which of them are open.
#[derive(Default)]
pub(super) struct Windows {
    pub(super) export: ExportWindow,
    pub(super) palette: Palette,
    pub(super) shortcuts: ShortcutSheet,
    pub(super) preferences: bool,
    pub(super) welcome: Welcome,
    pub(super) tour: Tour,
    /// Where the things are that the first steps speak of.
    pub(super) anchors: Option<Anchors>,
}
