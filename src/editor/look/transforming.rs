//! A transform in progress: moved by the pointer, locked to axes and typed by keys, confirmed or cancelled.

use egui::{Event, Key, Pos2};
use glam::Vec3;
use lightloom_core::scene::SceneDesc;
use lightloom_core::setting::format;

use super::axis::{self, AxisLock};
use super::change::{Change, changed};
use super::object::SceneObject;
use super::viewpoint::Viewpoint;

/// Longest number that is typed.
const LONGEST: usize = 12;
/// Smallest factor of a pointer's scale.
const LEAST_SCALE: f32 = 0.01;

/// What a transform does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransformKind {
    /// Moves.
    Move,
    /// Turns.
    Turn,
    /// Scales.
    Scale,
}

impl TransformKind {
    /// Its key.
    pub fn key(self) -> Key {
        match self {
            Self::Move => Key::G,
            Self::Turn => Key::R,
            Self::Scale => Key::S,
        }
    }
}

/// The end of a transform.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// It stays.
    Confirmed,
    /// The scene is as before.
    Cancelled,
}

/// A transform of one object in progress.
#[derive(Clone, Debug, PartialEq)]
pub struct Transforming {
    /// The object.
    pub object: SceneObject,
    /// What is done with it.
    pub kind: TransformKind,
    /// The axes it is locked to.
    pub lock: AxisLock,
    /// Whether a handle is dragged: its release confirms.
    pub by_handle: bool,
    typed: String,
    before: SceneDesc,
    pivot: Vec3,
    /// The view at its beginning: one that the transform moves, as of the camera, leaves the pointer its meaning.
    view: Option<Viewpoint>,
    /// Pointer at the beginning and now.
    pointer: Option<[Pos2; 2]>,
    /// Angle by which the pointer went about the pivot, degrees, clockwise.
    swept: f32,
}

impl Transforming {
    /// The beginning of a transform of `object` in `scene` about `pivot`.
    pub fn new(object: SceneObject, kind: TransformKind, scene: &SceneDesc, pivot: Vec3) -> Self {
        Self {
            object,
            kind,
            lock: AxisLock::Free,
            by_handle: false,
            typed: String::new(),
            before: scene.clone(),
            pivot,
            view: None,
            pointer: None,
            swept: 0.0,
        }
    }

    /// As one that a handle began.
    pub fn by_handle(self, lock: AxisLock) -> Self {
        Self { by_handle: true, lock, ..self }
    }

    /// The point about which it turns and scales.
    pub fn pivot(&self) -> Vec3 {
        self.pivot
    }

    /// The pointer over a view.
    pub fn point(&mut self, view: &Viewpoint, at: Pos2) {
        let view = *self.view.get_or_insert(*view);
        let [from, last] = self.pointer.unwrap_or([at; 2]);
        let centre = view.screen(self.pivot).unwrap_or(view.place.center());
        let (before, now) = (last - centre, at - centre);
        let angle = before.x * now.y - before.y * now.x;
        self.swept += angle.atan2(before.dot(now)).to_degrees();
        self.pointer = Some([from, at]);
    }

    /// Keys and text of a frame of the window, in their order.
    pub fn take<'a>(&mut self, events: impl IntoIterator<Item = &'a Event>) -> Option<End> {
        events.into_iter().find_map(|event| match event {
            Event::Key { key, pressed: true, repeat, modifiers, .. } if !modifiers.command => {
                (!repeat || *key == Key::Backspace).then(|| self.key(*key, modifiers.shift)).flatten()
            }
            Event::Text(text) => {
                self.text(text);
                None
            }
            _ => None,
        })
    }

    /// A key: axes lock, Enter confirms, Escape cancels, Backspace takes a digit back, G, R and S change what is done.
    pub fn key(&mut self, key: Key, shift: bool) -> Option<End> {
        match key {
            Key::Enter => return Some(End::Confirmed),
            Key::Escape => return Some(End::Cancelled),
            Key::Backspace => {
                self.typed.pop();
            }
            Key::X => self.lock = self.lock.pressed(0, shift),
            Key::Y => self.lock = self.lock.pressed(1, shift),
            Key::Z => self.lock = self.lock.pressed(2, shift),
            Key::G => self.become_another(TransformKind::Move),
            Key::R => self.become_another(TransformKind::Turn),
            Key::S => self.become_another(TransformKind::Scale),
            _ => (),
        }
        None
    }

    fn become_another(&mut self, kind: TransformKind) {
        if self.kind != kind {
            self.kind = kind;
            self.typed.clear();
            self.swept = 0.0;
            self.pointer = self.pointer.map(|[_, now]| [now; 2]);
        }
    }

    /// Typed text: digits and a point or comma; a minus changes the sign wherever it is typed.
    pub fn text(&mut self, text: &str) {
        for letter in text.chars() {
            match letter {
                '-' if self.typed.starts_with('-') => drop(self.typed.remove(0)),
                '-' => self.typed.insert(0, '-'),
                '.' | ',' if !self.typed.contains('.') => self.typed.push('.'),
                '0'..='9' if self.typed.len() < LONGEST => self.typed.push(letter),
                _ => (),
            }
        }
    }

    fn typed(&self) -> Option<f32> {
        format::parse(&self.typed, "").map(|value| value as f32)
    }

    /// What is done so far; none before the pointer moved or a number is typed.
    pub fn change(&self) -> Option<Change> {
        match self.kind {
            TransformKind::Move => self.moved().map(Change::Move),
            TransformKind::Turn => {
                let (axis, degrees) = self.turned()?;
                Some(Change::Turn(axis, degrees))
            }
            TransformKind::Scale => self.scale().map(Change::Scale),
        }
    }

    fn moved(&self) -> Option<Vec3> {
        if let Some(metres) = self.typed() {
            let axis = match self.lock {
                AxisLock::Axis(axis) => axis,
                AxisLock::Free => 0,
                AxisLock::Plane(axis) => usize::from(axis == 0),
            };
            return Some(axis::unit(axis) * metres);
        }
        let (view, [from, now]) = (self.view?, self.pointer?);
        let across = |normal: Vec3| {
            let at = |pointer| view.on_plane(pointer, self.pivot, normal);
            Some(at(now)? - at(from)?)
        };
        match self.lock {
            AxisLock::Free => across(view.camera.forward),
            AxisLock::Plane(axis) => across(axis::unit(axis)),
            AxisLock::Axis(axis) => {
                let at = |pointer| view.along(pointer, self.pivot, axis::unit(axis));
                Some(axis::unit(axis) * (at(now)? - at(from)?))
            }
        }
    }

    fn turned(&self) -> Option<(Vec3, f32)> {
        let towards = self.view.map_or(Vec3::Z, |view| -view.camera.forward);
        let axis = match self.lock {
            AxisLock::Free => towards,
            AxisLock::Axis(axis) | AxisLock::Plane(axis) => axis::unit(axis),
        };
        if let Some(degrees) = self.typed() {
            return Some((axis, degrees));
        }
        let view = self.view?;
        // Seen from its tip an axis turns against the clock.
        let from_tip = (view.camera.position - self.pivot).dot(axis) > 0.0;
        Some((axis, if self.lock == AxisLock::Free || from_tip { -self.swept } else { self.swept }))
    }

    fn scale(&self) -> Option<f32> {
        if let Some(factor) = self.typed() {
            return (factor > 0.0).then_some(factor);
        }
        let (view, [from, now]) = (self.view?, self.pointer?);
        let centre = view.screen(self.pivot).unwrap_or(view.place.center());
        let factor = now.distance(centre) / from.distance(centre).max(1.0);
        Some(factor.max(LEAST_SCALE))
    }

    /// The scene as it is so far.
    ///
    /// # Errors
    /// The reason why the object cannot be changed like this.
    pub fn scene(&self) -> Result<SceneDesc, &'static str> {
        let change = self.change();
        change.map_or_else(
            || Ok(self.before.clone()),
            |change| changed(&self.before, self.object, change, self.pivot),
        )
    }

    /// The status line: what is done, by how much, and what is typed.
    pub fn words(&self) -> String {
        let turns = self.kind == TransformKind::Turn;
        let verb = match self.kind {
            TransformKind::Move => "Move",
            TransformKind::Turn => "Turn",
            TransformKind::Scale => "Scale",
        };
        let lock = if self.kind == TransformKind::Scale { String::new() } else { self.lock.words(turns) };
        let unit = [" m", "°", ""][self.kind as usize];
        let amount = if self.typed.is_empty() {
            self.amount().map_or_else(String::new, |amount| format!("{amount}{unit}"))
        } else {
            format!("{}|{unit}", self.typed)
        };
        format!("{verb} {}{lock}: {amount}", self.object.name(&self.before))
    }

    /// The amount that the pointer gives.
    fn amount(&self) -> Option<String> {
        let short =
            |value: f32, steps: f32| format::number(f64::from((value * steps).round() / steps), false);
        Some(match self.change()? {
            Change::Move(by) => match self.lock {
                AxisLock::Axis(axis) => short(by[axis], 1e3),
                AxisLock::Free | AxisLock::Plane(_) => {
                    by.to_array().map(|value| short(value, 1e3)).join(", ")
                }
            },
            Change::Turn(_, degrees) => short(degrees, 10.0),
            Change::Scale(factor) => short(factor, 1e3),
        })
    }
}
