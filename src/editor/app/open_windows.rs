//! The secondary windows, and which of them are open.

use crate::editor::export::ExportWindow;
use crate::editor::palette::Palette;
use crate::editor::player::Player;
use crate::editor::shortcuts::ShortcutSheet;
use crate::editor::tour::{Anchors, Tour};
use crate::editor::welcome::Welcome;

/// The secondary windows, and which of them are open.
#[derive(Default)]
pub(super) struct Windows {
    pub(super) export: ExportWindow,
    pub(super) player: Player,
    pub(super) palette: Palette,
    pub(super) shortcuts: ShortcutSheet,
    pub(super) preferences: bool,
    pub(super) welcome: Welcome,
    pub(super) tour: Tour,
    /// The rectangles that the tour points at.
    pub(super) anchors: Option<Anchors>,
}
