//! The tour of the first start: three notes that point at controls. Each closes when its step is done or skipped;
//! they do not come back by themselves.

use egui::{
    Area, Color32, Context, Frame, Id, LayerId, Order, Pos2, Rect, RichText, Shape, Stroke, Vec2, pos2, vec2,
};
use lightloom_core::constraint::Constraint;
use lightloom_core::project::Project;

use super::session::Session;
use super::theme;

/// Width of a note, points.
const WIDTH: f32 = 300.0;
/// Distance of a note from its control, points.
const AWAY: f32 = 70.0;

/// The controls that the notes point at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchors {
    /// The tool that draws directed lines.
    pub line: Rect,
    /// The tool that draws walls.
    pub wall: Rect,
    /// The play button.
    pub play: Rect,
    /// The plane view.
    pub plane: Rect,
}

/// The tour.
#[derive(Clone, Debug, Default)]
pub struct Tour {
    /// The current step.
    step: Option<usize>,
    /// Number of directed lines and walls when the step began.
    drawn: [usize; 2],
}

struct Step {
    title: &'static str,
    text: &'static str,
}

const STEPS: [Step; 3] = [
    Step {
        title: "Draw a line",
        text: "Choose this tool, or press D, and draw over the light: it flows along your line, in its direction.",
    },
    Step {
        title: "Draw a wall",
        text: "Choose this tool, or press W, and draw where no light may pass: it flows around.",
    },
    Step {
        title: "Press play",
        text: "See the light move, here or with the space bar. Undo reverts anything.",
    },
];

impl Tour {
    /// Starts with the first step.
    pub fn begin(&mut self, project: &Project) {
        *self = Self { step: Some(0), drawn: drawn(project) };
    }

    /// Ends it; whether a step was shown.
    pub fn end(&mut self) -> bool {
        self.step.take().is_some()
    }

    /// Whether a step is shown.
    pub fn is_open(&self) -> bool {
        self.step.is_some()
    }

    /// Shows the step, and the next once it is done. Returns whether the tour ended now.
    pub fn show(&mut self, ctx: &Context, anchors: &Anchors, project: &Project, session: &Session) -> bool {
        let Some(step) = self.step else { return false };
        let now = drawn(project);
        let done = match step {
            0 => now[0] > self.drawn[0],
            1 => now[1] > self.drawn[1],
            _ => session.playing,
        };
        if done {
            return self.go(step + 1, now) || self.show(ctx, anchors, project, session);
        }
        let target = match step {
            0 => anchors.line,
            1 => anchors.wall,
            _ => anchors.play,
        };
        let place = place(target, anchors.plane, ctx.content_rect());
        let mut wanted = None;
        let area = Area::new(Id::unique("tour")).order(Order::Foreground).fixed_pos(place);
        let shown = area.show(ctx, |ui| {
            let frame = Frame::popup(ui.style()).inner_margin(14.0).stroke(Stroke::new(1.5, theme::ACCENT));
            frame.show(ui, |ui| {
                ui.set_width(WIDTH);
                ui.label(RichText::new(format!("{} of {}", step + 1, STEPS.len())).small().weak());
                ui.label(RichText::new(STEPS[step].title).heading().strong());
                ui.label(STEPS[step].text);
                ui.add_space(8.0);
                ui.horizontal(|ui| {
                    if ui.button("Skip the tour").clicked() {
                        wanted = Some(STEPS.len());
                    }
                    let last = step + 1 == STEPS.len();
                    let next = egui::Button::new(if last { "Done" } else { "Next" })
                        .fill(ui.visuals().selection.bg_fill);
                    if ui.add(next).clicked() {
                        wanted = Some(step + 1);
                    }
                });
            });
        });
        point(ctx, shown.response.rect, target);
        wanted.is_some_and(|step| self.go(step, now))
    }

    fn go(&mut self, step: usize, drawn: [usize; 2]) -> bool {
        self.step = (step < STEPS.len()).then_some(step);
        self.drawn = drawn;
        self.step.is_none()
    }
}

/// Number of directed lines and walls.
fn drawn(project: &Project) -> [usize; 2] {
    let lines = project.constraints.iter().filter(|c| matches!(c, Constraint::DirectedLine(_))).count();
    [lines, project.constraints.len() - lines]
}

/// Position of a note beside its control, towards the plane view, within the window.
fn place(target: Rect, plane: Rect, window: Rect) -> Pos2 {
    let towards = plane.center() - target.center();
    let size = vec2(WIDTH + 30.0, 160.0);
    let middle = if towards.x.abs() * target.height() > towards.y.abs() * target.width()
        || towards.x.abs() > towards.y.abs()
    {
        target.center()
            + vec2(towards.x.signum() * (target.width() / 2.0 + AWAY + size.x / 2.0), size.y / 4.0)
    } else {
        target.center()
            + vec2(size.x / 4.0, towards.y.signum() * (target.height() / 2.0 + AWAY + size.y / 2.0))
    };
    let room = window.shrink(12.0);
    let corner = middle - size / 2.0;
    let most = (room.max - size).max(room.min);
    pos2(corner.x.clamp(room.left(), most.x), corner.y.clamp(room.top(), most.y))
}

/// Paints an arrow from the note to its control, and a frame around the control.
fn point(ctx: &Context, note: Rect, target: Rect) {
    if !target.is_finite() || target.is_negative() {
        return;
    }
    let painter = ctx.layer_painter(LayerId::new(Order::Foreground, Id::unique("tour arrow")));
    let stroke = Stroke::new(2.0, theme::ACCENT);
    painter.rect_stroke(target.expand(4.0), 6.0, stroke, egui::StrokeKind::Outside);
    let clamped = |rect: Rect, p: Pos2| rect.clamp(p);
    let from = clamped(note, target.center());
    let to = clamped(target.expand(8.0), from);
    let along = to - from;
    if along.length() < 12.0 {
        return;
    }
    let (unit, side): (Vec2, Vec2) = (along.normalized(), along.normalized().rot90());
    painter.line_segment([from, to - 8.0 * unit], stroke);
    let head = vec![to, to - 11.0 * unit + 5.5 * side, to - 11.0 * unit - 5.5 * side];
    painter.add(Shape::convex_polygon(head, theme::ACCENT, Stroke::new(0.0, Color32::TRANSPARENT)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_stays_in_the_window_and_off_its_target() {
        let window = Rect::from_min_size(Pos2::ZERO, vec2(1280.0, 800.0));
        let plane = Rect::from_min_size(pos2(60.0, 40.0), vec2(700.0, 500.0));
        let note = |target| Rect::from_min_size(place(target, plane, window), vec2(WIDTH + 30.0, 160.0));
        for target in [pos2(20.0, 100.0), pos2(1260.0, 300.0), pos2(140.0, 600.0), pos2(640.0, 790.0)] {
            let target = Rect::from_center_size(target, vec2(30.0, 26.0));
            assert!(window.contains_rect(note(target)), "{target:?}");
            assert!(!note(target).intersects(target), "{target:?}");
        }
    }
}
