//! Keyboard input as actions.

use egui::{Context, Event, Key, KeyboardShortcut, Modifiers};

use super::action::Action;
use super::command::{COMMANDS, Command, KeyPlace};

/// Keys that a busy tool handles itself.
const BUSY: [Key; 9] = [
    Key::Enter,
    Key::Escape,
    Key::Backspace,
    Key::Delete,
    Key::Space,
    Key::ArrowUp,
    Key::ArrowDown,
    Key::ArrowLeft,
    Key::ArrowRight,
];

/// Commands that repeat while their key is held.
const REPEATED: [Command; 6] = [
    Command::NextFrame,
    Command::PreviousFrame,
    Command::Undo,
    Command::Redo,
    Command::ZoomIn,
    Command::ZoomOut,
];

/// Commands that begin a transform, into which the keys that follow are typed.
const TRANSFORMS: [Command; 3] = [Command::MoveObject, Command::TurnObject, Command::ScaleObject];

/// The actions of this frame's key presses. `tools` are the names and keys of the tools in order; `busy` means
/// that the active tool has an unfinished gesture. Over the orbit view its keys win. A focused text field keeps all keys except shortcuts that have
/// no meaning in text, and so does the palette before its field has the focus: `typing`.
pub fn pressed(
    ctx: &Context,
    tools: &[(&'static str, Key)],
    (busy, typing): (bool, bool),
    place: KeyPlace,
) -> Vec<Action> {
    let typing = typing || ctx.text_edit_focused();
    let focused = ctx.memory(|memory| memory.focused().is_some());
    if is_covered(ctx) {
        return Vec::new();
    }
    let events = ctx.input(|i| i.events.clone());
    let action = |event: &Event| {
        let action = asked(event, tools, busy, (typing, focused), place);
        let space = matches!(event, Event::Key { key: Key::Space, .. });
        if space { tapped(ctx, event, action) } else { action }
    };
    let actions: Vec<Action> = events.iter().filter_map(action).collect();
    let count = actions.iter().position(takes_keys).map_or(actions.len(), |at| at + 1);
    actions.into_iter().take(count).collect()
}

/// Whether what follows in the same frame is typed into a transform that the action begins.
fn takes_keys(action: &Action) -> bool {
    matches!(action, Action::Command(command) if TRANSFORMS.contains(command))
}

/// Tells in each frame whether a dialog or a question of the program takes the keys.
pub(super) fn set_covered(ctx: &Context, covered: bool) {
    ctx.data_mut(|data| data.insert_temp(egui::Id::unique("covered"), covered));
}

/// Whether a dialog or a menu is open that receives the keys.
pub(super) fn is_covered(ctx: &Context) -> bool {
    let told = ctx.data(|data| data.get_temp(egui::Id::unique("covered")).unwrap_or(false));
    told || egui::Popup::is_any_open(ctx)
}

/// The action of the space bar on release: held while the pointer drags, it pans the view instead.
fn tapped(ctx: &Context, event: &Event, action: Option<Action>) -> Option<Action> {
    let id = egui::Id::unique("space bar");
    if matches!(event, Event::Key { pressed: true, .. }) {
        // A key that is held is told again and again.
        if action.is_some() {
            ctx.data_mut(|data| data.insert_temp(id, action));
        }
        return None;
    }
    let dragged = ctx.input(|input| input.pointer.any_down() || input.pointer.any_released());
    ctx.data_mut(|data| data.remove_temp::<Option<Action>>(id)).flatten().filter(|_| !dragged)
}

fn asked(
    event: &Event,
    tools: &[(&'static str, Key)],
    busy: bool,
    (typing, focused): (bool, bool),
    place: KeyPlace,
) -> Option<Action> {
    match event {
        // The system turns these shortcuts into events of their own.
        Event::Copy if !typing => Some(Command::Copy.into()),
        Event::Cut if !typing => Some(Command::Cut.into()),
        Event::Paste(text) if !typing => Some(Action::Paste(text.clone())),
        Event::Key { key, pressed: true, repeat, modifiers, .. } => {
            let taken = (busy && BUSY.contains(key)) || (focused && [Key::Space, Key::Enter].contains(key));
            if taken && modifiers.is_none() {
                return None;
            }
            let of_view = || command(*key, *modifiers, KeyPlace::OrbitView);
            if place == KeyPlace::OrbitView
                && !typing
                && !repeat
                && let Some(command) = of_view()
            {
                return Some(command.into());
            }
            if let Some(command) = command(*key, *modifiers, KeyPlace::Everywhere) {
                let kept = typing && !command.info()?.shortcut.as_ref().is_some_and(means_nothing_in_text);
                let again = *repeat && !REPEATED.contains(&command);
                return (!kept && !again).then(|| command.into());
            }
            let tool = tools.iter().position(|(_, own)| own == key)?;
            (!typing && modifiers.is_none()).then_some(Action::Tool(tool))
        }
        _ => None,
    }
}

/// The command of a key with modifiers; an exact match wins.
fn command(key: Key, held: Modifiers, place: KeyPlace) -> Option<Command> {
    let fits = |exact: bool| {
        COMMANDS.iter().filter(|entry| entry.keys == place).find(|entry| {
            entry.shortcut.as_ref().is_some_and(|shortcut| {
                let KeyboardShortcut { modifiers, logical_key } = *shortcut;
                let matches =
                    if exact { held.matches_exact(modifiers) } else { held.matches_logically(modifiers) };
                // Only characters may need Shift to be typed, such as + on many keyboards.
                logical_key == key && matches && (exact || [Key::Plus, Key::Minus].contains(&key))
            })
        })
    };
    fits(true).or_else(|| fits(false)).map(|entry| entry.command)
}

/// Whether a shortcut works while text is typed.
fn means_nothing_in_text(shortcut: &KeyboardShortcut) -> bool {
    let editing = [Key::Z, Key::Y, Key::X, Key::C, Key::V, Key::A, Key::D, Key::J, Key::H];
    let function = shortcut.logical_key == Key::F1;
    function || (shortcut.modifiers.command && !editing.contains(&shortcut.logical_key))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(key: Key, modifiers: Modifiers) -> Event {
        Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
    }

    const TOOLS: [(&str, Key); 2] = [("Select", Key::V), ("Wall", Key::W)];

    #[test]
    fn every_shortcut_calls_its_command() {
        for entry in COMMANDS {
            let Some(shortcut) = entry.shortcut else { continue };
            let event = key(shortcut.logical_key, shortcut.modifiers);
            assert_eq!(
                asked(&event, &TOOLS, false, (false, false), entry.keys),
                Some(entry.command.into()),
                "{}",
                entry.name
            );
        }
    }

    #[test]
    fn typing_keeps_letters_and_editing_but_saves() {
        let typed = |k, m| asked(&key(k, m), &TOOLS, false, (true, true), KeyPlace::OrbitView);
        for letter in [Key::W, Key::R, Key::Space, Key::K, Key::Period, Key::Delete] {
            assert_eq!(typed(letter, Modifiers::NONE), None, "{letter:?}");
        }
        assert_eq!(typed(Key::Z, Modifiers::COMMAND), None);
        assert_eq!(typed(Key::S, Modifiers::COMMAND), Some(Command::Save.into()));
        assert_eq!(asked(&Event::Paste("7".into()), &TOOLS, false, (true, true), KeyPlace::Everywhere), None);
    }

    #[test]
    fn a_busy_tool_keeps_what_ends_it() {
        let pressed = |k| asked(&key(k, Modifiers::NONE), &TOOLS, true, (false, false), KeyPlace::Everywhere);
        assert_eq!(pressed(Key::Delete), None);
        assert_eq!(pressed(Key::W), Some(Action::Tool(1)));
    }

    #[test]
    fn a_held_key_steps_on_but_does_not_start_and_stop() {
        let held = |k| Event::Key {
            key: k,
            physical_key: None,
            pressed: true,
            repeat: true,
            modifiers: Modifiers::NONE,
        };
        let pressed = |k| asked(&held(k), &TOOLS, false, (false, false), KeyPlace::Everywhere);
        assert_eq!(pressed(Key::Space), None);
        assert_eq!(pressed(Key::Period), Some(Command::NextFrame.into()));
    }

    #[test]
    fn plus_needs_shift_on_many_keyboards() {
        let pressed = |k| command(k, Modifiers::SHIFT, KeyPlace::Everywhere);
        assert_eq!(pressed(Key::Plus), Some(Command::ZoomIn));
        assert_eq!(pressed(Key::S), None);
    }

    #[test]
    fn keys_of_the_orbit_view_count_over_it_alone() {
        let pressed = |k, place| asked(&key(k, Modifiers::NONE), &TOOLS, false, (false, false), place);
        assert_eq!(pressed(Key::G, KeyPlace::OrbitView), Some(Command::MoveObject.into()));
        assert_eq!(pressed(Key::G, KeyPlace::Everywhere), Some(Command::ShowGrid.into()));
        assert_eq!(pressed(Key::Space, KeyPlace::OrbitView), Some(Command::PlayPause.into()));
        assert_eq!(pressed(Key::W, KeyPlace::OrbitView), Some(Action::Tool(1)));
    }
}
