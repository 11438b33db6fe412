//! Pointer and keys over a view, as gestures on the plane and moves of the view.

use egui::{Event, Key, MouseWheelSource, PointerButton, Pos2, Response, Ui, Vec2};
use glam::Vec2 as PlanePoint;

use crate::editor::keyboard::is_covered;
use crate::editor::tools::{Gesture, HeldKeys, PointerMode};

/// Wheel scroll that doubles the zoom, points.
const WHEEL: f32 = 240.0;
/// Drag distance that doubles the zoom, points.
const DRAG: f32 = 120.0;
/// Zoom factor of a click with the zoom tool.
const CLICK_ZOOM: f32 = 1.6;
/// A drag shorter than this is a click, points.
const CLICK: f32 = 4.0;

/// A move of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ViewMove {
    /// Pans by a vector in points.
    Pan(Vec2),
    /// Zooms by a factor about a screen position.
    Zoom(f32, Pos2),
}

/// The input of one frame.
#[derive(Clone, Debug, Default)]
pub struct Input {
    /// Gestures for the active tool.
    pub gestures: Vec<Gesture>,
    /// Moves of the view.
    pub moves: Vec<ViewMove>,
    /// Whether the view is being dragged.
    pub dragging: bool,
}

/// What the pressed buttons are doing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum PointerDrag {
    #[default]
    Free,
    Tool,
    Pan(Pos2),
    /// Start, current position, and whether the drag threshold was passed.
    Zoom(Pos2, Pos2, bool),
}

/// The modifier keys.
pub fn held(ui: &Ui) -> HeldKeys {
    let modifiers = ui.input(|input| input.modifiers);
    HeldKeys { shift: modifiers.shift, alt: modifiers.alt, ctrl: modifiers.command || modifiers.ctrl }
}

/// Reads the pointer over the view of `response`. `plane` maps a screen position to a plane point, if there is
/// one.
pub fn pointer(
    ui: &Ui,
    response: &Response,
    pointer_mode: PointerMode,
    plane: &dyn Fn(Pos2) -> Option<PlanePoint>,
) -> Input {
    let id = response.id.with("hand");
    let mut drag = ui.data(|data| data.get_temp::<PointerDrag>(id)).unwrap_or_default();
    let mut input = Input::default();
    let events = ui.input(|input| input.events.clone());
    for event in events {
        match event {
            Event::PointerButton { pos, button, pressed: true, .. } if drag == PointerDrag::Free => {
                drag = press(ui, response, pointer_mode, pos, button);
                let at = plane(pos).filter(|_| drag == PointerDrag::Tool);
                input.gestures.extend(at.map(Gesture::Press));
            }
            Event::PointerMoved(pos) => moved(&mut drag, pos, plane, &mut input),
            Event::PointerButton { pos, pressed: false, .. } => {
                release(ui, std::mem::take(&mut drag), pos, plane, &mut input);
            }
            _ => (),
        }
    }
    // No event reports a button released outside of the window.
    if drag != PointerDrag::Free && !ui.input(|input| input.pointer.any_down()) {
        let at = ui.input(|input| input.pointer.latest_pos()).unwrap_or(response.rect.center());
        release(ui, std::mem::take(&mut drag), at, plane, &mut input);
    }
    let pointer = ui.input(|input| input.pointer.latest_pos());
    if response.double_clicked() && pointer_mode == PointerMode::Tool {
        input.gestures.extend(pointer.and_then(plane).map(Gesture::DoubleClick));
    }
    if response.hovered() && drag == PointerDrag::Free {
        input.gestures.extend(pointer.and_then(plane).map(Gesture::Hover));
    }
    input.moves.extend(wheel(ui, response));
    input.dragging = matches!(drag, PointerDrag::Pan(_));
    ui.data_mut(|data| data.insert_temp(id, drag));
    input
}

fn press(
    ui: &Ui,
    response: &Response,
    pointer_mode: PointerMode,
    pos: Pos2,
    button: PointerButton,
) -> PointerDrag {
    let here = response.is_pointer_button_down_on()
        || response.clicked_by(button)
        || (button == PointerButton::Middle && response.contains_pointer());
    if !here {
        return PointerDrag::Free;
    }
    let space = ui.input(|input| input.key_down(Key::Space)) && !ui.ctx().text_edit_focused();
    match (button, pointer_mode) {
        (PointerButton::Middle, _) => PointerDrag::Pan(pos),
        (PointerButton::Primary, _) if space => PointerDrag::Pan(pos),
        (PointerButton::Primary, PointerMode::Pan) => PointerDrag::Pan(pos),
        (PointerButton::Primary, PointerMode::Zoom) => PointerDrag::Zoom(pos, pos, false),
        (PointerButton::Primary, PointerMode::Tool) => PointerDrag::Tool,
        _ => PointerDrag::Free,
    }
}

fn moved(drag: &mut PointerDrag, pos: Pos2, plane: &dyn Fn(Pos2) -> Option<PlanePoint>, input: &mut Input) {
    match drag {
        PointerDrag::Free => (),
        PointerDrag::Tool => input.gestures.extend(plane(pos).map(Gesture::Drag)),
        PointerDrag::Pan(last) => {
            input.moves.push(ViewMove::Pan(pos - *last));
            *last = pos;
        }
        PointerDrag::Zoom(begin, last, dragged) => {
            *dragged |= begin.distance(pos) > CLICK;
            if *dragged {
                let by = (pos.x - last.x) - (pos.y - last.y);
                input.moves.push(ViewMove::Zoom((by / DRAG).exp2(), *begin));
                *last = pos;
            }
        }
    }
}

fn release(
    ui: &Ui,
    drag: PointerDrag,
    pos: Pos2,
    plane: &dyn Fn(Pos2) -> Option<PlanePoint>,
    input: &mut Input,
) {
    match drag {
        // Where the pointer left the plane, the gesture ends at its last place.
        PointerDrag::Tool => {
            let last = input.gestures.iter().rev().find_map(|gesture| match gesture {
                Gesture::Press(p) | Gesture::Drag(p) => Some(*p),
                _ => None,
            });
            input.gestures.push(Gesture::Release(plane(pos).or(last).unwrap_or_default()));
        }
        PointerDrag::Zoom(begin, _, false) => {
            let held = held(ui);
            let factor = if held.shift || held.alt { CLICK_ZOOM.recip() } else { CLICK_ZOOM };
            input.moves.push(ViewMove::Zoom(factor, begin));
        }
        PointerDrag::Free | PointerDrag::Pan(_) | PointerDrag::Zoom(..) => (),
    }
}

/// The wheel zooms, two-finger scrolling pans, pinching zooms.
fn wheel(ui: &Ui, response: &Response) -> Option<ViewMove> {
    let pointer = response.hover_pos().filter(|_| response.hovered())?;
    let (scroll, pinch, source) =
        ui.input(|input| (input.smooth_scroll_delta(), input.zoom_delta(), input.scroll_source()));
    if source == Some(MouseWheelSource::Trackpad) && pinch == 1.0 {
        return (scroll != Vec2::ZERO).then_some(ViewMove::Pan(scroll));
    }
    let factor = pinch * (scroll.y / WHEEL).exp2();
    (factor != 1.0 && factor.is_finite()).then_some(ViewMove::Zoom(factor, pointer))
}

/// Key presses for tools, unless another widget has the focus.
pub fn keys(ui: &Ui, response: &Response) -> Vec<Gesture> {
    const KEYS: [Key; 8] = [
        Key::Enter,
        Key::Escape,
        Key::Backspace,
        Key::Delete,
        Key::ArrowLeft,
        Key::ArrowRight,
        Key::ArrowUp,
        Key::ArrowDown,
    ];
    let elsewhere = ui.memory(|memory| memory.focused()).is_some_and(|id| id != response.id);
    if elsewhere || is_covered(ui.ctx()) {
        return Vec::new();
    }
    let pressed = |key: Key| ui.input(|input| input.num_presses(key));
    KEYS.into_iter().flat_map(|key| std::iter::repeat_n(Gesture::Key(key), pressed(key))).collect()
}
