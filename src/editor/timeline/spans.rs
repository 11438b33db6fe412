//! The bars of constraints: their spans of frames.

use egui::{
    Align2, CursorIcon, FontId, Id, Rect, Response, Role, ScrollArea, Sense, Shape, Stroke, StrokeKind, Ui,
    WidgetInfo, pos2, vec2,
};
use lightloom_core::constraint::{Constraint, Span};
use lightloom_core::project::Project;

use super::commands::step;
use super::drag::Drag;
use super::edits::BarPart;
use super::lanes::{GUTTER, ROW, with_bar};
use super::scale::Scale;
use super::{Timeline, edits};
use crate::editor::action::Action;
use crate::editor::context::EditorContext;
use crate::editor::panels;
use crate::editor::playback;
use crate::editor::selection::Selection;
use crate::editor::theme;

impl Timeline {
    /// Shows the bars in `area`, which includes the gutter of titles.
    pub(super) fn spans(&mut self, ui: &mut Ui, area: Rect, scale: &Scale, editor: &mut EditorContext) {
        let project = editor.document.project().clone();
        let rows = with_bar(&project, &editor.session.selection);
        let mut ui = ui.new_child(egui::UiBuilder::new().max_rect(area).id_salt("spans"));
        let list = ScrollArea::vertical().auto_shrink(false);
        list.show_rows(&mut ui, ROW, rows.len(), |ui, visible| {
            ui.spacing_mut().item_spacing = egui::Vec2::ZERO;
            for &index in &rows[visible] {
                let (_, row) = ui.allocate_space(vec2(area.width(), ROW));
                self.bar(ui, row, scale, index, editor, &project);
            }
        });
    }

    fn bar(
        &mut self,
        ui: &mut Ui,
        row: Rect,
        scale: &Scale,
        index: usize,
        editor: &mut EditorContext,
        project: &Project,
    ) {
        let constraint = &project.constraints[index];
        let name = panels::title(constraint, index);
        let track = row.with_min_x(row.left() + GUTTER);
        let label = Rect::from_min_max(row.left_top(), pos2(track.left() - 6.0, row.bottom()));
        let strong = editor.session.selection.contains(index);
        let colour = if strong { ui.visuals().strong_text_color() } else { ui.visuals().text_color() };
        let font = FontId::proportional(11.5);
        ui.painter_at(label).text(label.right_center(), Align2::RIGHT_CENTER, &name, font, colour);
        let own = constraint.span().copied();
        let whole = playback::whole(project);
        let span = own.unwrap_or(Span { from: *whole.start(), to: *whole.end(), fade: 0 });
        let bar = Rect::from_x_y_ranges(
            scale.x(f64::from(span.from) - 0.5)..=scale.x(f64::from(span.to) + 0.5),
            row.shrink2(vec2(0.0, 3.0)).y_range(),
        );
        paint(ui, track, bar, constraint, &span, own.is_some(), strong);
        let ui = &mut ui.new_child(egui::UiBuilder::new().max_rect(track).id_salt(("bar", index)));
        ui.shrink_clip_rect(track);
        for (part, grip) in grips(bar) {
            if !track.intersects(grip) {
                continue;
            }
            let response =
                ui.interact(grip, Id::unique(("span", index, part as u8)), Sense::click_and_drag());
            let info = format!("{name}, {}", words(part, &span, own.is_some()));
            response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &info));
            self.drag_bar(ui, &response, index, part, span, scale, editor);
            if response.clicked() {
                editor.ask(Action::Select(Selection::one(index)));
            }
            menu(&response, index, own, editor, project);
            let cursor =
                if part == BarPart::Middle { CursorIcon::Grab } else { CursorIcon::ResizeHorizontal };
            response.on_hover_cursor(cursor).on_hover_text(format!(
                "{info}. Drag the ends or the middle to retime; right click to keep it always active."
            ));
        }
    }

    #[expect(clippy::too_many_arguments, reason = "the bar, its part, and where it is dragged")]
    fn drag_bar(
        &mut self,
        ui: &Ui,
        response: &Response,
        index: usize,
        part: BarPart,
        span: Span,
        scale: &Scale,
        editor: &mut EditorContext,
    ) {
        let what = Drag::Bar(index, part);
        if response.drag_started() {
            self.drag.begin_bar(editor, what, span, scale, ui);
        }
        let before = self.drag.span();
        if let Some(by) = self.drag.frames(ui, response, what, scale, editor)
            && let Some(before) = before
        {
            // A bar without a span gets one once it is moved.
            let after = part.dragged(before, by);
            let edit = edits::span(editor.document.project(), index, Some(after));
            if let Some(edit) = edit.filter(|_| by != 0 || span != before) {
                editor.ask(edit);
            }
        }
    }
}

/// The draggable parts of a bar; its ends are above the middle.
fn grips(bar: Rect) -> [(BarPart, Rect); 3] {
    let end = |x: f32| Rect::from_center_size(pos2(x, bar.center().y), vec2(10.0, bar.height() + 4.0));
    [(BarPart::Middle, bar), (BarPart::From, end(bar.left())), (BarPart::To, end(bar.right()))]
}

fn words(part: BarPart, span: &Span, own: bool) -> String {
    match part {
        BarPart::Middle if !own => "always active".into(),
        BarPart::Middle => format!("active from frame {} to {}", span.from, span.to),
        BarPart::From => format!("first frame {}", span.from),
        BarPart::To => format!("last frame {}", span.to),
    }
}

fn paint(ui: &Ui, track: Rect, bar: Rect, constraint: &Constraint, span: &Span, own: bool, strong: bool) {
    let painter = ui.painter_at(track);
    let colour = match constraint {
        Constraint::DirectedLine(_) => theme::LINE,
        Constraint::Wall(_) => theme::WALL,
    };
    let colour = if constraint.is_enabled() { colour } else { colour.gamma_multiply(0.4) };
    if !own {
        let corners =
            [bar.left_top(), bar.right_top(), bar.right_bottom(), bar.left_bottom(), bar.left_top()];
        painter.extend(Shape::dashed_line(&corners, Stroke::new(1.2, colour.gamma_multiply(0.7)), 5.0, 4.0));
        return;
    }
    painter.rect_filled(bar, 4.0, colour.gamma_multiply(if strong { 0.85 } else { 0.55 }));
    // Walls do not fade.
    if matches!(constraint, Constraint::DirectedLine(_)) {
        fades(&painter, bar, span, ui.visuals().panel_fill);
    }
    painter.rect_stroke(bar, 4.0, Stroke::new(if strong { 1.8 } else { 1.0 }, colour), StrokeKind::Inside);
}

/// Corners are cut where a line fades in and out.
fn fades(painter: &egui::Painter, bar: Rect, span: &Span, behind: egui::Color32) {
    let frames = (f64::from(span.to) - f64::from(span.from) + 1.0) as f32;
    let width = bar.width() * (span.fade as f32 / frames).min(0.5);
    if width >= 1.0 {
        for (x, inwards) in [(bar.left(), width), (bar.right(), -width)] {
            let corner = vec![pos2(x, bar.top()), pos2(x + inwards, bar.top()), pos2(x, bar.bottom())];
            painter.add(Shape::convex_polygon(corner, behind.gamma_multiply(0.8), Stroke::NONE));
        }
    }
}

fn menu(response: &Response, index: usize, own: Option<Span>, editor: &mut EditorContext, project: &Project) {
    response.context_menu(|ui| {
        let whole = playback::whole(project);
        let span = own.unwrap_or(Span { from: *whole.start(), to: *whole.end(), fade: 0 });
        let at = editor.session.playhead;
        let choices = [
            ("Start at the playhead", Some(Span { from: at, to: span.to.max(at), ..span })),
            ("End at the playhead", Some(Span { from: span.from.min(at), to: at, ..span })),
            ("Always active", None),
        ];
        for (name, wanted) in choices {
            let edit = edits::span(project, index, wanted);
            if ui.add_enabled(edit.is_some(), egui::Button::new(name)).clicked()
                && let Some(edit) = edit
            {
                step(editor, edit);
            }
        }
    });
}
