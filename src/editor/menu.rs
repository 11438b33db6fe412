//! The menu bar: all commands, from one list.

use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::{Atom, Button, IdSalt, MenuBar, Rect, Stroke, ThemePreference, Ui, pos2, vec2};

use super::action::Action;
use super::command::{COMMANDS, Command, CommandInfo, Menu};
use super::document::Document;
use super::look::commands;
use super::session::{FieldMap, Session, ViewLayout};
use super::shortcuts;
use super::store::Backup;
use super::templates::TEMPLATES;
use crate::editor::context::EditorContext;

/// The menus in order.
const MENUS: [Menu; 6] = [Menu::File, Menu::Edit, Menu::Scene, Menu::Play, Menu::View, Menu::Help];

/// Commands that follow a separator.
const PARTED: [Command; 19] = [
    Command::Save,
    Command::Export,
    Command::Preferences,
    Command::Cut,
    Command::SelectAll,
    Command::Reverse,
    Command::Group,
    Command::Snapping,
    Command::SnapToTable,
    Command::DuplicateObject,
    Command::FrameSelected,
    Command::NextFrame,
    Command::MarkIn,
    Command::AddKey,
    Command::BothViews,
    Command::ShowDrawn,
    Command::Compare,
    Command::Larger,
    Command::DarkTheme,
];

/// A recently opened file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recent {
    /// Its path.
    pub path: PathBuf,
    /// Whether it still exists; missing files are disabled.
    pub is_there: bool,
}

/// Shows the menu bar and asks for the chosen command.
pub fn show(ui: &mut Ui, editor: &mut EditorContext, recent: &[Recent], kept: &[Backup]) {
    MenuBar::new().ui(ui, |ui| {
        for menu in MENUS {
            ui.menu_button(shortcuts::group(menu), |ui| {
                ui.set_min_width(220.0);
                for entry in COMMANDS.iter().filter(|entry| entry.menu == menu) {
                    if PARTED.contains(&entry.command) {
                        ui.separator();
                    }
                    item(ui, editor, entry);
                    match entry.command {
                        Command::New => templates(ui, editor),
                        Command::Open => {
                            recents(ui, editor, recent);
                            backups(ui, editor, kept);
                        }
                        _ => (),
                    }
                }
            });
        }
    });
}

fn item(ui: &mut Ui, editor: &mut EditorContext, entry: &CommandInfo) {
    let theme = ui.ctx().options(|options| options.theme_preference);
    let on = is_on(entry.command, editor.session).or_else(|| Some(theme_of(entry.command)? == theme));
    let enabled = is_enabled(entry.command, editor.document, editor.session);
    let place = IdSalt::new("check");
    let mut button =
        Button::selectable(false, (Atom::custom(place, vec2(14.0, 14.0)), title(entry, editor.document)));
    if let Some(shortcut) = &entry.shortcut {
        button = button.shortcut_text(shortcuts::words(shortcut));
    }
    let shown = ui.add_enabled_ui(enabled, |ui| button.atom_ui(ui)).inner;
    if let Some(square) = shown.rect(place).filter(|_| on == Some(true)) {
        let colour = ui.visuals().widgets.active.fg_stroke.color;
        check_mark(ui, square, Stroke::new(1.8, colour));
    }
    if let Some(on) = on {
        let name = entry.name;
        shown
            .response
            .widget_info(|| egui::WidgetInfo::selected(egui::Role::MenuItemCheckBox, enabled, on, name));
    }
    if shown.response.clicked() {
        editor.ask(entry.command);
        ui.close();
    }
}

/// The theme that a command chooses.
fn theme_of(command: Command) -> Option<ThemePreference> {
    match command {
        Command::DarkTheme => Some(ThemePreference::Dark),
        Command::LightTheme => Some(ThemePreference::Light),
        Command::SystemTheme => Some(ThemePreference::System),
        _ => None,
    }
}

/// The name of a command; undo and redo name their step.
fn title(entry: &CommandInfo, document: &Document) -> String {
    let what = match entry.command {
        Command::Undo => document.history().undoes(),
        Command::Redo => document.history().redoes(),
        _ => None,
    };
    what.map_or_else(|| entry.name.to_owned(), |what| format!("{} {what}", entry.name))
}

fn check_mark(ui: &Ui, square: Rect, stroke: Stroke) {
    let at = |x: f32, y: f32| pos2(square.left() + x * square.width(), square.top() + y * square.height());
    ui.painter().line(vec![at(0.15, 0.55), at(0.4, 0.8), at(0.85, 0.25)], stroke);
}

fn templates(ui: &mut Ui, editor: &mut EditorContext) {
    ui.menu_button("      New from an example", |ui| {
        for (index, template) in TEMPLATES.iter().enumerate() {
            if ui.button(template.name).on_hover_text(template.line).clicked() {
                editor.ask(Action::New(index));
                ui.close();
            }
        }
    });
}

fn recents(ui: &mut Ui, editor: &mut EditorContext, recent: &[Recent]) {
    let list = |ui: &mut Ui| {
        for Recent { path, is_there } in recent {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let folder = path.parent().unwrap_or(Path::new("")).to_string_lossy();
            let shown = ui.add_enabled(*is_there, Button::new(name.as_ref()));
            let shown =
                shown.on_hover_text(folder.as_ref()).on_disabled_hover_text(format!("{folder}: not found"));
            if shown.clicked() {
                editor.ask(Action::Open(path.clone()));
                ui.close();
            }
        }
    };
    ui.add_enabled_ui(!recent.is_empty(), |ui| ui.menu_button("      Open recent", list));
}

/// The last versions of the document's file.
fn backups(ui: &mut Ui, editor: &mut EditorContext, kept: &[Backup]) {
    let list = |ui: &mut Ui| {
        for Backup { path, replaced } in kept {
            let age = ago(replaced.elapsed().unwrap_or_default());
            if ui.button(format!("Replaced {age}")).on_hover_text(path.to_string_lossy()).clicked() {
                editor.ask(Action::OpenBackup(path.clone()));
                ui.close();
            }
        }
    };
    ui.add_enabled_ui(!kept.is_empty(), |ui| ui.menu_button("      Open backup", list));
}

/// A time that has passed, in words.
pub fn ago(age: Duration) -> String {
    match age.as_secs() / 60 {
        0 => "less than a minute ago".to_owned(),
        1 => "a minute ago".to_owned(),
        minutes @ 2..120 => format!("{minutes} minutes ago"),
        minutes @ 120..2880 => format!("{} hours ago", minutes / 60),
        minutes => format!("{} days ago", minutes / 1440),
    }
}

/// The state of a toggle command; none for other commands.
pub fn is_on(command: Command, session: &Session) -> Option<bool> {
    let show = &session.overlays;
    Some(match command {
        Command::Snapping => session.snapping,
        Command::ToggleLoop => session.looping,
        Command::BothViews => session.layout == ViewLayout::PlaneAndShot,
        Command::PlaneView => session.layout == ViewLayout::Plane,
        Command::ShotView => session.layout == ViewLayout::Shot,
        Command::OrbitView => session.layout == ViewLayout::Orbit,
        Command::ShowDrawn => show.drawn,
        Command::ShowTarget => show.target,
        Command::ShowArrows => show.arrows,
        Command::ShowStreamlines => show.streamlines,
        Command::ShowTrails => show.trails,
        Command::ShowGrid => show.grid,
        Command::ShowDivergence => show.map == Some(FieldMap::Divergence),
        Command::ShowCurl => show.map == Some(FieldMap::Curl),
        Command::ShowResidual => show.map == Some(FieldMap::Residual),
        Command::ShowTears => show.map == Some(FieldMap::Tears),
        Command::FalseColour => show.false_colour,
        Command::Compare => session.compare.is_some(),
        Command::LookThroughCamera => session.layout == ViewLayout::Orbit && session.through_camera,
        _ => return None,
    })
}

/// Whether a command has an effect now.
pub fn is_enabled(command: Command, document: &Document, session: &Session) -> bool {
    let chosen = !session.selection.is_empty();
    match command {
        Command::Undo => document.history().undoes().is_some(),
        Command::Redo => document.history().redoes().is_some(),
        Command::Delete => chosen || session.focus.key.is_some(),
        Command::Cut | Command::Copy | Command::Duplicate | Command::SelectNone => chosen,
        Command::Reverse | Command::Join | Command::Split | Command::Group | Command::Ungroup => chosen,
        Command::SelectAll => !document.project().constraints.is_empty(),
        Command::ClearMarks => session.marks != [None; 2],
        Command::OrbitView => document.project().scene.is_some(),
        _ => commands::is_enabled(command, document, session).unwrap_or(true),
    }
}
