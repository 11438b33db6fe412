//! The command palette: fuzzy search over commands, tools, panels, parameters, preferences, presets and examples.

use egui::text::LayoutJob;
use egui::{
    Align2, Area, Context, Frame, Id, Key, KeyboardShortcut, Modifiers, Order, Role, ScrollArea, Sense,
    TextEdit, TextFormat, TextStyle, Ui, WidgetInfo, vec2,
};

use super::action::Action;
use super::command::{COMMANDS, Command};
use super::panels::{self, PANELS};
use super::templates::TEMPLATES;
use super::{menu, preferences, shortcuts};
use crate::editor::context::EditorContext;

/// Height of a row, points.
const ROW: f32 = 26.0;

/// An entry of the palette.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// Its name.
    pub name: String,
    /// Its kind, such as "Tool".
    pub kind: &'static str,
    /// Its shortcut.
    pub key: Option<String>,
    /// The action it asks for.
    pub action: Action,
    /// Whether it has an effect now.
    pub enabled: bool,
}

/// The command palette.
#[derive(Clone, Debug, Default)]
pub struct Palette {
    open: bool,
    typed: String,
    /// Index of the row that Enter chooses.
    at: usize,
}

/// All entries: commands, tools, panels, parameters by label with their panel, preferences, examples, and `presets` by name.
pub fn items(
    editor: &EditorContext,
    tools: &[(&'static str, Key)],
    presets: &[(String, Action)],
) -> Vec<Item> {
    let item = |name: String, kind, key, action| Item { name, kind, key, action, enabled: true };
    let commands = COMMANDS.iter().map(|entry| Item {
        key: entry.shortcut.as_ref().map(shortcuts::words),
        enabled: menu::is_enabled(entry.command, editor.document, editor.session),
        ..item(entry.name.into(), shortcuts::group(entry.menu), None, entry.command.into())
    });
    let tools = tools.iter().enumerate().map(|(index, (name, key))| {
        let key = shortcuts::words(&KeyboardShortcut::new(Modifiers::NONE, *key));
        item((*name).into(), "Tool", Some(key), Action::Tool(index))
    });
    let panels =
        PANELS.iter().map(|entry| item(entry.name.into(), "Panel", None, Action::Panel(entry.panel)));
    let parameters = panels::controls_by_panel().map(|(entry, control)| {
        item(format!("{}: {}", entry.name, control.label), "Parameter", None, Action::Panel(entry.panel))
    });
    // By the names of the window that they stand in.
    let preferences = preferences::NAMES
        .iter()
        .map(|name| item(format!("Preferences: {name}"), "Preference", None, Command::Preferences.into()));
    let presets = presets.iter().map(|(name, action)| item(name.clone(), "Preset", None, action.clone()));
    let examples = TEMPLATES.iter().enumerate();
    let examples = examples.map(|(index, t)| item(t.name.into(), "Example", None, Action::New(index)));
    commands
        .chain(tools)
        .chain(panels)
        .chain(presets)
        .chain(examples)
        .chain(parameters)
        .chain(preferences)
        .collect()
}

impl Palette {
    /// Opens the palette, empty.
    pub fn open(&mut self) {
        *self = Self { open: true, ..Self::default() };
    }

    /// Whether it is open.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Shows the palette if it is open; returns the chosen action.
    pub fn show(&mut self, ctx: &Context, items: impl FnOnce() -> Vec<Item>) -> Option<Action> {
        if !self.open {
            return None;
        }
        let steer = |i: &mut egui::InputState| {
            let mut hit = |key| i.consume_key(Modifiers::NONE, key);
            [Key::ArrowDown, Key::ArrowUp, Key::Enter, Key::Escape].map(&mut hit)
        };
        let [down, up, enter, escape] = ctx.input_mut(steer);
        let before = self.typed.clone();
        let mut chosen = None;
        let place = Area::new(Id::unique("palette"))
            .order(Order::Foreground)
            .anchor(Align2::CENTER_TOP, vec2(0.0, 64.0));
        let shown = place.show(ctx, |ui| {
            Frame::popup(ui.style()).inner_margin(8.0).show(ui, |ui| {
                ui.set_width(520.0);
                let field = TextEdit::singleline(&mut self.typed)
                    .hint_text("Find a command, tool, parameter or example")
                    .font(TextStyle::Heading)
                    .desired_width(f32::INFINITY);
                ui.add(field).accessible_name("Find a command").request_focus();
                ui.add_space(4.0);
                let found = matching(items(), &self.typed);
                self.at = if self.typed == before { self.at.min(found.len().saturating_sub(1)) } else { 0 };
                let last = found.len().saturating_sub(1);
                self.at =
                    if down { (self.at + 1).min(last) } else { self.at.saturating_sub(usize::from(up)) };
                if let Some(index) = list(ui, &found, self.at, down || up) {
                    self.at = index;
                    chosen = found.get(index).map(|(item, _)| item.action.clone());
                }
                if enter {
                    chosen = found
                        .get(self.at)
                        .filter(|(item, _)| item.enabled)
                        .map(|(item, _)| item.action.clone());
                }
            });
        });
        let beside = ctx.input(|i| {
            i.pointer.any_pressed()
                && i.pointer.interact_pos().is_some_and(|p| !shown.response.rect.contains(p))
        });
        if chosen.is_some() || escape || beside {
            self.open = false;
        }
        chosen
    }
}

/// Shows the rows; returns the index of the clicked one.
fn list(ui: &mut Ui, found: &[(Item, Vec<usize>)], at: usize, moved: bool) -> Option<usize> {
    let mut clicked = None;
    if found.is_empty() {
        ui.weak("No matches.");
    }
    ScrollArea::vertical().max_height(12.0 * ROW).auto_shrink([false, true]).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for (index, (item, letters)) in found.iter().enumerate() {
            let sense = if item.enabled { Sense::click() } else { Sense::hover() };
            let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), sense);
            let name = format!("{}, {}", item.name, item.kind);
            response
                .widget_info(|| WidgetInfo::selected(Role::ListBoxOption, item.enabled, index == at, &name));
            if index == at {
                ui.painter().rect_filled(rect, 4.0, ui.visuals().selection.bg_fill);
                if moved {
                    response.scroll_to_me(None);
                }
            } else if response.hovered() {
                ui.painter().rect_filled(rect, 4.0, ui.visuals().widgets.hovered.weak_bg_fill);
            }
            line(ui, rect.shrink2(vec2(8.0, 0.0)), item, letters);
            if response.clicked() {
                clicked = Some(index);
            }
        }
    });
    clicked
}

fn line(ui: &Ui, rect: egui::Rect, item: &Item, letters: &[usize]) {
    let visuals = ui.visuals();
    let (text, weak) = (visuals.text_color(), visuals.weak_text_color());
    let text = if item.enabled { text } else { weak };
    let strong = visuals.strong_text_color();
    let font = TextStyle::Body.resolve(ui.style());
    let mut job = LayoutJob::default();
    for (i, letter) in item.name.chars().enumerate() {
        let mut format = TextFormat::simple(font.clone(), text);
        if letters.contains(&i) {
            format = TextFormat { underline: egui::Stroke::new(1.0, strong), color: strong, ..format };
        }
        job.append(letter.encode_utf8(&mut [0; 4]), 0.0, format);
    }
    let painter = ui.painter();
    let galley = painter.layout_job(job);
    painter.galley(rect.left_center() - vec2(0.0, galley.size().y / 2.0), galley, text);
    let small = TextStyle::Small.resolve(ui.style());
    painter.text(rect.right_center() - vec2(116.0, 0.0), Align2::LEFT_CENTER, item.kind, small, weak);
    if let Some(key) = &item.key {
        painter.text(
            rect.right_center(),
            Align2::RIGHT_CENTER,
            key,
            TextStyle::Monospace.resolve(ui.style()),
            weak,
        );
    }
}

/// The items that contain the typed letters in order, best first, with the indices of the letters.
fn matching(items: Vec<Item>, typed: &str) -> Vec<(Item, Vec<usize>)> {
    let mut found: Vec<(i32, Item, Vec<usize>)> = items
        .into_iter()
        .filter_map(|item| {
            let (score, letters) = fit(&item.name, typed)?;
            Some((score, item, letters))
        })
        .collect();
    // The sort is stable: equal scores keep their order.
    found.sort_by_key(|(score, ..)| -score);
    found.into_iter().map(|(_, item, letters)| (item, letters)).collect()
}

/// Score of a name for typed letters, and the matching indices; none where it does not contain them in order.
/// Starts of words and consecutive letters score higher.
fn fit(name: &str, typed: &str) -> Option<(i32, Vec<usize>)> {
    let lower = |text: &str| text.chars().flat_map(char::to_lowercase).collect::<Vec<_>>();
    let (name, typed) = (lower(name), lower(typed.trim()));
    let wanted: Vec<char> = typed.into_iter().filter(|c| !c.is_whitespace()).collect();
    let begins = |i: usize| i == 0 || !name[i - 1].is_alphanumeric();
    if wanted.is_empty() {
        return Some((0, Vec::new()));
    }
    let from = |start: usize| {
        let (mut score, mut letters, mut next) = (0, Vec::new(), start);
        for &letter in &wanted {
            let at = (next..name.len()).find(|&i| name[i] == letter)?;
            let beside = letters.last().is_some_and(|&last| last + 1 == at);
            score += 1 + 4 * i32::from(beside) + 3 * i32::from(begins(at));
            letters.push(at);
            next = at + 1;
        }
        Some((score - (name.len() as i32 - wanted.len() as i32).min(30) / 10, letters))
    };
    (0..=name.len())
        .filter_map(from)
        .max_by_key(|(score, letters)| (*score, -(letters.first().map_or(0, |i| *i as i32))))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn letters_must_stand_in_their_order() {
        assert!(fit("Play or pause", "pp").is_some());
        assert!(fit("Play or pause", "esp").is_none());
        assert!(fit("Save as…", "SAVE").is_some());
        assert!(fit("Anything", "").is_some());
    }

    #[test]
    fn begins_of_words_win() {
        let best = |typed: &str| {
            let names = ["Show all", "Split at points", "Save as…", "Preferences", "Play or pause"];
            let mut fits: Vec<_> = names.iter().filter_map(|n| Some((fit(n, typed)?.0, *n))).collect();
            fits.sort_by_key(|(score, _)| -score);
            fits[0].1
        };
        assert_eq!(best("sa"), "Save as…");
        assert_eq!(best("pop"), "Play or pause");
        assert_eq!(best("pref"), "Preferences");
    }
}
