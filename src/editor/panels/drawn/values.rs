//! The values of what is selected, one or several at once.

use egui::Ui;
use lightloom_core::constraint::{Common, Constraint, DirectedLine, Span, Wall};
use lightloom_core::setting::format::number;

use crate::editor::context::EditorContext;
use crate::editor::document::Edit;
use crate::editor::panels::control::Control;
use crate::editor::panels::control::row::LABELS;
use crate::editor::panels::widgets::aside;

const WEIGHT: Control = Control::new("Weight", DirectedLine::WEIGHT).log_slider(0.0, 100.0);
const SPEED: Control = Control::new("Speed", DirectedLine::SPEED).log_slider(0.1, 10.0);
const WIDTH: Control = Control::new("Width", DirectedLine::WIDTH).log_slider(0.005, 0.5).without_suffix();
const THICKNESS: Control = Control::new("Thickness", Wall::THICKNESS).log_slider(0.001, 0.2).without_suffix();
const SPAN: Control = Control::new("Acts", Common::SPAN).labels(&["Always", "In frames"]);
const FROM: Control = Control::new("From frame", Span::FROM);
const TO: Control = Control::new("To frame", Span::TO);
const FADE: Control = Control::new("Fade", Span::FADE);

/// The settings of what was drawn; name, eye and padlock stand in the list.
pub(super) const CONTROLS: &[Control] = &[WEIGHT, SPEED, WIDTH, THICKNESS, SPAN, FROM, TO, FADE];

/// Largest coordinate of a point, plane units.
const FARTHEST: f32 = 10.0;

/// A change of one constraint.
type Change = Box<dyn Fn(&mut Constraint)>;

/// The values of the `chosen`; each change reaches all of them that are not locked.
pub(super) fn show(ui: &mut Ui, editor: &mut EditorContext, constraints: &[Constraint], chosen: &[usize]) {
    let free: Vec<usize> = chosen.iter().copied().filter(|&i| !constraints[i].is_locked()).collect();
    if free.len() < chosen.len() {
        ui.weak(if free.is_empty() { "It is locked." } else { "Those that are locked stay as they are." });
    }
    let mut changes: Vec<Change> = Vec::new();
    ui.add_enabled_ui(!free.is_empty(), |ui| {
        let of = if free.is_empty() { chosen } else { &free };
        let mut lines = of.iter().filter_map(|&i| line_of(&constraints[i]));
        if let Some(line) = lines.next() {
            let alike = lines.all(|l| (l.weight, l.speed, l.width) == (line.weight, line.speed, line.width));
            line_values(ui, editor, line.clone(), &mut changes);
            mixed(ui, alike);
        }
        let mut walls = of.iter().filter_map(|&i| wall_of(&constraints[i]));
        if let Some(wall) = walls.next() {
            let alike = walls.all(|w| w.thickness == wall.thickness);
            wall_values(ui, editor, wall.clone(), &mut changes);
            mixed(ui, alike);
        }
        if let Some(&first) = of.first() {
            let any_line = of.iter().any(|&i| line_of(&constraints[i]).is_some());
            span(ui, editor, constraints[first].span().copied(), any_line, &mut changes);
            mixed(ui, of.iter().all(|&i| constraints[i].span() == constraints[first].span()));
        }
    });
    if let [one] = free[..] {
        point(ui, editor, &constraints[one], one, &mut changes);
    }
    if !changes.is_empty() {
        let changed = free.into_iter().map(|i| {
            let mut constraint = constraints[i].clone();
            changes.iter().for_each(|change| change(&mut constraint));
            (i, constraint)
        });
        editor.ask(Edit::Change(changed.collect()));
    }
}

/// The coordinates of the selected point, where it is one alone.
fn point(
    ui: &mut Ui,
    editor: &EditorContext,
    constraint: &Constraint,
    index: usize,
    changes: &mut Vec<Change>,
) {
    let chosen: Vec<usize> = editor.session.selection.points(index).collect();
    let points = constraint.points();
    let only = if let [place] = chosen[..] { Some(place) } else { None };
    let Some((place, mut at)) = only.and_then(|place| Some((place, *points.get(place)?))) else {
        return aside(ui, "click one of its points for its coordinates");
    };
    let before = at;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let size = egui::vec2(LABELS, ui.spacing().interact_size.y);
        ui.allocate_ui_with_layout(size, egui::Layout::left_to_right(egui::Align::Center), |ui| {
            ui.set_min_width(LABELS);
            ui.add_space(9.0);
            ui.label(format!("Point {} of {}", place + 1, points.len()))
                .on_hover_text("From the lower left corner of the plane, whose longer side is 1.");
        });
        let width = (ui.available_width() - 4.0) / 2.0;
        for (value, name) in at.iter_mut().zip(["x", "y"]) {
            let field = egui::DragValue::new(value).speed(0.001).range(-FARTHEST..=FARTHEST).max_decimals(5);
            let field = field.prefix(format!("{name} "));
            let size = egui::vec2(width, ui.spacing().interact_size.y);
            ui.add_sized(size, field).accessible_name(format!("Point {name}"));
        }
    });
    if at != before {
        changes.push(Box::new(move |constraint| {
            // A loop stays closed.
            let points = match constraint {
                Constraint::DirectedLine(line) => &mut line.points,
                Constraint::Wall(wall) => &mut wall.points,
            };
            let last = points.len().saturating_sub(1);
            let closed = last > 2 && points[0] == points[last] && (place == 0 || place == last);
            let moved = if closed { vec![0, last] } else { vec![place] };
            moved.into_iter().for_each(|place| points[place] = at);
        }));
    }
}

fn line_of(constraint: &Constraint) -> Option<&DirectedLine> {
    if let Constraint::DirectedLine(line) = constraint { Some(line) } else { None }
}

fn wall_of(constraint: &Constraint) -> Option<&Wall> {
    if let Constraint::Wall(wall) = constraint { Some(wall) } else { None }
}

fn mixed(ui: &mut Ui, alike: bool) {
    if !alike {
        aside(ui, "several values; this is the first");
    }
}

fn line_values(ui: &mut Ui, editor: &EditorContext, mut line: DirectedLine, changes: &mut Vec<Change>) {
    let mut on_lines = |change: Box<dyn Fn(&mut DirectedLine)>| {
        changes.push(Box::new(move |constraint| {
            if let Constraint::DirectedLine(line) = constraint {
                change(line);
            }
        }));
    };
    if WEIGHT.number(ui, &mut line.weight) {
        on_lines(Box::new(move |other| other.weight = line.weight));
    }
    if SPEED.number(ui, &mut line.speed) {
        on_lines(Box::new(move |other| other.speed = line.speed));
    }
    if WIDTH.number(ui, &mut line.width) {
        on_lines(Box::new(move |other| other.width = line.width));
    }
    in_plane(ui, editor, line.width);
}

fn wall_values(ui: &mut Ui, editor: &EditorContext, mut wall: Wall, changes: &mut Vec<Change>) {
    if THICKNESS.number(ui, &mut wall.thickness) {
        changes.push(Box::new(move |constraint| {
            if let Constraint::Wall(other) = constraint {
                other.thickness = wall.thickness;
            }
        }));
    }
    in_plane(ui, editor, wall.thickness);
}

/// A length on the plane in per cent of it, and in cells of the field.
fn in_plane(ui: &mut Ui, editor: &EditorContext, length: f32) {
    let project = editor.document.project();
    let cells = project.flow.grid.cells(project.extent()).into_iter().max().unwrap_or(0);
    let tenths = |value: f32| number((f64::from(value) * 10.0).round() / 10.0, false);
    aside(ui, &format!("{} % of the plane, {} cells", tenths(length * 100.0), tenths(length * cells as f32)));
}

fn span(ui: &mut Ui, editor: &EditorContext, now: Option<Span>, fades: bool, changes: &mut Vec<Change>) {
    let mut span = now;
    if let Some(kind) = SPAN.pick(ui, usize::from(span.is_some())) {
        let keys = &editor.document.project().keys;
        let ends = keys.first().zip(keys.last());
        let all = ends.map(|(first, last)| Span { from: first.frame, to: last.frame, fade: 0 });
        span = if kind == 1 { all } else { None };
    }
    if let Some(span) = &mut span {
        if whole(&FROM, ui, &mut span.from) {
            span.to = span.to.max(span.from);
        }
        if whole(&TO, ui, &mut span.to) {
            span.from = span.from.min(span.to);
        }
        if fades {
            whole(&FADE, ui, &mut span.fade);
        }
    }
    if span != now {
        changes.push(Box::new(move |constraint| match constraint {
            Constraint::DirectedLine(line) => line.span = span,
            Constraint::Wall(wall) => wall.span = span,
        }));
    }
}

/// A field without a slider: frames have no end.
fn whole<T: egui::emath::Numeric>(control: &Control, ui: &mut Ui, value: &mut T) -> bool {
    let mut values = [*value];
    let changed = control.numbers(ui, &mut values, [""]);
    *value = values[0];
    changed
}
