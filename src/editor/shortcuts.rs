//! Shortcuts in words, and the window that lists them.

use egui::{Context, Grid, Key, KeyboardShortcut, ModifierNames, RichText, ScrollArea, TextEdit};

use super::command::{COMMANDS, CommandInfo, Menu};

/// A key and its effect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShortcutLine {
    /// The group it is listed in.
    pub group: &'static str,
    /// Its effect.
    pub name: String,
    /// The key, such as "Ctrl+S".
    pub key: String,
}

/// The shortcuts window.
#[derive(Clone, Debug, Default)]
pub struct ShortcutSheet {
    /// Whether it is open.
    pub open: bool,
    filter: String,
}

/// A shortcut in words, such as "Ctrl+Shift+S".
pub fn words(shortcut: &KeyboardShortcut) -> String {
    shortcut.format(&ModifierNames::NAMES, cfg!(target_os = "macos"))
}

/// The name of a command with its shortcut, for tooltips.
pub fn with_key(entry: &CommandInfo) -> String {
    entry
        .shortcut
        .as_ref()
        .map_or_else(|| entry.name.to_owned(), |s| format!("{} ({})", entry.name, words(s)))
}

/// The group of the keys that count over the orbit view.
const OVER_ORBIT_VIEW: &str = "Scene (over the orbit view)";

/// What else the orbit view knows.
const TRANSFORMS: [(&str, &str); 6] = [
    ("Select", "Click"),
    ("Lock to an axis", "X, Y, Z"),
    ("Lock across an axis", "Shift+X, Y, Z"),
    ("Type the amount", "Digits"),
    ("Confirm", "Enter, click"),
    ("Cancel", "Escape, right click"),
];

/// Mouse gestures and modifier keys, which are not commands.
const GESTURES: [(&str, &str); 11] = [
    ("Zoom at the pointer", "Wheel"),
    ("Pan", "Middle button, drag"),
    ("Add to the selection", "Shift+Click"),
    ("Straight lines, steps of 15°", "Hold Shift"),
    ("Draw without snapping", "Hold Ctrl"),
    ("Finish the line", "Enter"),
    ("Cancel the line or drag", "Escape"),
    ("Close a window", "Escape"),
    ("Remove the last point", "Backspace"),
    ("Nudge the selection", "Arrow keys"),
    ("Reset a setting to its default", "Double click its name"),
];

/// All shortcuts: of the tools, of the commands, and the gestures.
pub fn lines(tools: &[(&'static str, Key)]) -> Vec<ShortcutLine> {
    let tool = |(name, key): &(&'static str, Key)| ShortcutLine {
        group: "Tools",
        name: (*name).into(),
        key: key.name().into(),
    };
    let command = |entry: &CommandInfo| {
        let shortcut = entry.shortcut.as_ref()?;
        let group = if entry.menu == Menu::Scene { OVER_ORBIT_VIEW } else { group(entry.menu) };
        Some(ShortcutLine { group, name: entry.name.into(), key: words(shortcut) })
    };
    let gesture = |group| {
        move |(name, key): &(&str, &str)| ShortcutLine { group, name: (*name).into(), key: (*key).into() }
    };
    let (scene, others): (Vec<_>, Vec<_>) = COMMANDS.iter().partition(|entry| entry.menu == Menu::Scene);
    tools
        .iter()
        .map(tool)
        .chain(others.into_iter().filter_map(command))
        .chain(GESTURES.iter().map(gesture("Mouse and keys")))
        .chain(scene.into_iter().filter_map(command))
        .chain(TRANSFORMS.iter().map(gesture(OVER_ORBIT_VIEW)))
        .collect()
}

/// The name of a menu.
pub fn group(menu: Menu) -> &'static str {
    match menu {
        Menu::File => "File",
        Menu::Edit => "Edit",
        Menu::Scene => "Scene",
        Menu::Play => "Play",
        Menu::View => "View",
        Menu::Help => "Help",
    }
}

impl ShortcutSheet {
    /// Shows the window if it is open.
    pub fn show(&mut self, ctx: &Context, tools: &[(&'static str, Key)]) {
        if !self.open {
            return;
        }
        let filter = self.filter.to_lowercase();
        let found = |line: &ShortcutLine| {
            format!("{} {} {}", line.group, line.name, line.key).to_lowercase().contains(&filter)
        };
        let lines: Vec<ShortcutLine> = lines(tools).into_iter().filter(found).collect();
        let window = egui::Window::new("Shortcuts")
            .id(egui::Id::unique("Shortcuts"))
            .open(&mut self.open)
            .collapsible(false)
            .resizable([false, true]);
        let placed = window
            .default_size([700.0, 560.0])
            .default_pos(ctx.content_rect().center() - egui::vec2(360.0, 320.0));
        placed.show(ctx, |ui| {
            let field =
                TextEdit::singleline(&mut self.filter).hint_text("Search").desired_width(f32::INFINITY);
            ui.add(field).accessible_name("Search shortcuts");
            ui.add_space(6.0);
            ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
                if lines.is_empty() {
                    ui.weak("No matches.");
                }
                ui.columns(2, |columns| {
                    let half = halves(&lines);
                    list(&mut columns[0], &lines[..half]);
                    list(&mut columns[1], &lines[half..]);
                });
            });
        });
    }
}

/// Index of the second column: the start of the group that balances the columns.
fn halves(lines: &[ShortcutLine]) -> usize {
    let begins =
        (0..=lines.len()).filter(|&i| i == lines.len() || i == 0 || lines[i].group != lines[i - 1].group);
    begins.min_by_key(|i| i.abs_diff(lines.len().div_ceil(2))).unwrap_or(0)
}

fn list(ui: &mut egui::Ui, lines: &[ShortcutLine]) {
    for group in lines.chunk_by(|a, b| a.group == b.group) {
        ui.add_space(4.0);
        ui.strong(group[0].group);
        Grid::new(group[0].group).num_columns(2).min_col_width(130.0).spacing([12.0, 3.0]).show(ui, |ui| {
            for line in group {
                ui.label(&line.name);
                ui.label(
                    RichText::new(format!(" {} ", line.key))
                        .monospace()
                        .background_color(ui.visuals().extreme_bg_color),
                );
                ui.end_row();
            }
        });
    }
}
