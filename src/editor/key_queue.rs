//! Keys wait for what they are meant for. In one frame no key follows one that opens or closes something: it is read in the next.
//! While a dialog is on its way all keys wait. However slow the frames are, nothing typed is lost or reaches what lies beneath.

use std::mem;

use egui::{Context, Event, Key, Plugin, RawInput};

/// What takes the keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Taker {
    /// What is shown.
    #[default]
    Shown,
    /// A field that is not there yet.
    Coming,
    /// A field that is perhaps not coming: Escape gives it up, with all that was typed for it.
    Doubtful,
    /// Nothing: the field did not come, what was typed for it is dropped.
    Gone,
}

/// The keys that wait.
#[derive(Debug, Default)]
pub(super) struct KeyQueue {
    taker: Taker,
    waiting: Vec<Event>,
}

impl KeyQueue {
    /// Tells who takes the keys from the next frame on.
    pub(super) fn set(ctx: &Context, taker: Taker) {
        ctx.plugin_or_default::<Self>().lock().taker = taker;
    }

    /// The events of the next frame; the others go on waiting.
    fn next(&mut self, new: Vec<Event>) -> Vec<Event> {
        if mem::take(&mut self.taker) == Taker::Gone {
            self.drop_typed();
        }
        let events = mem::take(&mut self.waiting).into_iter().chain(new);
        let mut opened = false;
        let mut now = Vec::new();
        for event in events {
            // The rest stays in order.
            if opened && (is_typed(&event) || !self.waiting.is_empty()) {
                self.waiting.push(event);
                continue;
            }
            opened |= opens(&event);
            now.push(event);
        }
        now
    }

    /// Drops what was typed; keys that were released are still told, or they would seem held.
    fn drop_typed(&mut self) {
        self.waiting.retain(|event| matches!(event, Event::Key { pressed: false, .. }));
    }

    /// The events of a frame in which something is on its way.
    fn held(&mut self, new: Vec<Event>) -> Vec<Event> {
        let escape = |event: &Event| matches!(event, Event::Key { key: Key::Escape, .. });
        let mut now = Vec::new();
        for event in new {
            if self.taker == Taker::Doubtful && escape(&event) {
                self.drop_typed();
                now.push(event);
            } else if is_typed(&event) {
                self.waiting.push(event);
            } else {
                now.push(event);
            }
        }
        now
    }
}

impl Plugin for KeyQueue {
    fn debug_name(&self) -> &'static str {
        "keys that wait"
    }

    fn input_hook(&mut self, ctx: &Context, input: &mut RawInput) {
        let new = mem::take(&mut input.events);
        input.events = match self.taker {
            Taker::Shown | Taker::Gone => self.next(new),
            Taker::Coming | Taker::Doubtful => self.held(new),
        };
        if !self.waiting.is_empty() {
            ctx.request_repaint();
        }
    }
}

/// Whether an event is one of the keyboard.
fn is_typed(event: &Event) -> bool {
    matches!(
        event,
        Event::Key { .. } | Event::Text(_) | Event::Paste(_) | Event::Copy | Event::Cut | Event::Ime(_)
    )
}

/// Whether what follows may be meant for something that this event opens, or that it uncovers.
fn opens(event: &Event) -> bool {
    match event {
        Event::Key { key, pressed: true, repeat: false, modifiers, .. } => {
            modifiers.command || [Key::Enter, Key::Escape, Key::F1, Key::F2, Key::F3].contains(key)
        }
        Event::PointerButton { pressed: false, .. } => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use egui::Modifiers;

    use super::*;

    fn key(key: Key, modifiers: Modifiers) -> Event {
        Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
    }

    fn text(text: &str) -> Event {
        Event::Text(text.to_owned())
    }

    #[test]
    fn what_follows_a_key_that_opens_something_comes_a_frame_later_in_order() {
        let (escape, import) = (key(Key::Escape, Modifiers::NONE), key(Key::I, Modifiers::COMMAND));
        let enter = key(Key::Enter, Modifiers::NONE);
        let mut queue = KeyQueue::default();
        let all = vec![escape.clone(), import.clone(), text("a"), text("b"), enter.clone(), text("w")];
        assert_eq!(queue.next(all), [escape]);
        assert_eq!(queue.next(Vec::new()), [import]);
        assert_eq!(queue.next(vec![text("x")]), [text("a"), text("b"), enter]);
        assert_eq!(queue.next(Vec::new()), [text("w"), text("x")]);
        assert!(queue.waiting.is_empty());
    }

    #[test]
    fn while_a_dialog_is_on_its_way_keys_wait_and_the_pointer_does_not() {
        let mut queue = KeyQueue { taker: Taker::Coming, ..KeyQueue::default() };
        let moved = Event::PointerMoved(egui::pos2(1.0, 2.0));
        let enter = key(Key::Enter, Modifiers::NONE);
        assert_eq!(queue.held(vec![text("a"), moved.clone(), enter.clone()]), [moved]);
        queue.taker = Taker::Shown;
        assert_eq!(queue.next(Vec::new()), [text("a"), enter]);
    }

    #[test]
    fn what_was_typed_for_a_dialog_that_never_came_reaches_nothing() {
        let mut queue = KeyQueue { taker: Taker::Doubtful, ..KeyQueue::default() };
        let escape = key(Key::Escape, Modifiers::NONE);
        assert_eq!(queue.held(vec![text("w"), escape.clone(), text("e")]), [escape]);
        queue.taker = Taker::Gone;
        assert!(queue.next(vec![text("k")]) == [text("k")] && queue.waiting.is_empty());
    }

    #[test]
    fn clicks_and_held_keys_do_not_wait() {
        let mut queue = KeyQueue::default();
        let click = |pressed| Event::PointerButton {
            pos: egui::Pos2::ZERO,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        let clicks = vec![click(true), click(false), click(true), click(false)];
        assert_eq!(queue.next(clicks.clone()), clicks);
        assert_eq!(queue.next(vec![click(false), text("a")]), [click(false)]);
        assert_eq!(queue.next(Vec::new()), [text("a")]);
    }
}
