//! The secondary windows, and which of them are open.

use eframe::egui::{Context, Id, Key, LayerId, Modifiers, Order};

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

impl Windows {
    /// Passes keys that nobody else has a use for to the window on top: Escape closes it, or the last of those that are open.
    pub(super) fn take_keys(&mut self, ctx: &Context) {
        if is_top(ctx, "Player") {
            self.player.take_keys(ctx);
        }
        if !ctx.input(|input| input.key_pressed(Key::Escape)) {
            return;
        }
        let Self { export, player, shortcuts, preferences, .. } = self;
        let windows = [
            ("Export", &mut export.open),
            ("Player", &mut player.open),
            ("Preferences", preferences),
            ("Shortcuts", &mut shortcuts.open),
        ];
        let open = windows.into_iter().filter(|(_, open)| **open);
        if let Some((_, open)) = open.max_by_key(|(title, _)| is_top(ctx, title)) {
            *open = false;
            ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape));
        }
    }
}

/// Whether the window of this title is above the others.
fn is_top(ctx: &Context, title: &str) -> bool {
    let top = ctx.memory(|memory| memory.areas().top_layer_id(Order::Middle));
    top == Some(LayerId::new(Order::Middle, Id::unique(title)))
}
