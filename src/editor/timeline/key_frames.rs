//! The lane of key frames: thumbnails, positions and easing.

use egui::{
    Align2, Atom, Button, Color32, CornerRadius, CursorIcon, FontId, Id, IdSalt, Rect, Response, Role, Sense,
    Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};
use glam::Vec2;
use lightloom_core::project::{Ease, KeyFrame, Project, Shows};

use super::commands::{add_key, go, step};
use super::drag::Drag;
use super::scale::Scale;
use super::thumbnails::Thumbnail;
use super::{Timeline, edits, icons};
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;
use crate::editor::panels::EASE;
use crate::editor::session::Panel;
use crate::editor::templates;
use crate::editor::theme;

/// Height of a thumbnail.
const PICTURE: f32 = 44.0;
/// Distance of the diamonds' centres from the bottom of the lane.
const DIAMOND: f32 = 13.0;

impl Timeline {
    /// Shows the lane and asks for edits of the key frames.
    pub(super) fn keys(&mut self, ui: &mut Ui, rect: Rect, scale: &Scale, editor: &mut EditorContext) {
        let project = editor.document.project().clone();
        let lane = ui.interact(rect, ui.scope_id().with("key lane"), Sense::click());
        lane.widget_info(|| WidgetInfo::labeled(Role::Group, true, "Key frames"));
        if lane.double_clicked()
            && let Some(at) = lane.interact_pointer_pos()
        {
            add_key(editor, &project, scale.frame(at.x));
        }
        lane.on_hover_text_at_pointer(
            "Double click to add a key frame, or press K to add one at the playhead.",
        );
        ui.painter_at(rect).rect_filled(rect, 0.0, ui.visuals().faint_bg_color);
        for pair in project.keys.windows(2) {
            between(ui, rect, scale, &pair[0], &pair[1]);
        }
        for index in 0..project.keys.len() {
            self.key(ui, rect, scale, index, editor, &project);
        }
    }

    fn key(
        &mut self,
        ui: &mut Ui,
        lane: Rect,
        scale: &Scale,
        index: usize,
        editor: &mut EditorContext,
        project: &Project,
    ) {
        let key = &project.keys[index];
        let x = scale.x(f64::from(key.frame));
        let extent = project.extent();
        let size = picture_size(extent).min(vec2(room(&project.keys, index, scale), PICTURE));
        let grip =
            Rect::from_center_size(pos2(x, lane.center().y), vec2(size.x.max(18.0), lane.height() - 4.0));
        if !lane.intersects(grip) {
            return;
        }
        let mut response = ui.interact(grip, Id::unique(("key frame", index)), Sense::click_and_drag());
        let shown = shown_at(key, project);
        let all: Vec<String> = shown.iter().map(|shows| words(shows)).collect();
        let name = format!("Key frame at {}, shows {}", key.frame, all.join(", "));
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
        if response.clicked() {
            editor.session.focus.key = Some(index);
            editor.session.panel = Panel::Keys;
            go(editor, key.frame);
        }
        if response.drag_started() {
            self.drag.begin(editor, Drag::Key(index), scale, ui);
        }
        if let Some(by) = self.drag.frames(ui, &response, Drag::Key(index), scale, editor)
            && let Some(edit) = edits::retime(&project.keys, index, self.drag.from().saturating_add(by))
        {
            editor.ask(edit);
        }
        let file = templates::file_of(editor.document);
        let mut thumbnail = |shows: &&Shows| self.thumbnails.of(ui.ctx(), shows, &file, &self.access, extent);
        let thumbnails: Vec<Thumbnail> = shown.iter().map(&mut thumbnail).collect();
        let chosen = editor.session.focus.key == Some(index);
        let style = KeyStyle { x, size, chosen, hot: response.hovered() || response.dragged() };
        paint(ui, lane, &style, &thumbnails);
        response = response.on_hover_cursor(CursorIcon::Grab).on_hover_ui(|ui| {
            ui.strong(&name);
            for thumbnail in &thumbnails {
                if let Thumbnail::Failed(why) = thumbnail {
                    ui.colored_label(theme::words(ui.visuals(), theme::BAD), why);
                }
            }
            ui.label("Drag to retime, click to go there, right click for easing and more.");
        });
        menu(&response, index, editor, project);
    }
}

fn picture_size(extent: Vec2) -> egui::Vec2 {
    vec2(PICTURE * (extent.x / extent.y).clamp(0.4, 2.0), PICTURE)
}

/// Width available for a thumbnail between its neighbours.
fn room(keys: &[KeyFrame], index: usize, scale: &Scale) -> f32 {
    let x = |key: &KeyFrame| scale.x(f64::from(key.frame));
    let own = x(&keys[index]);
    let before = index.checked_sub(1).map_or(f32::INFINITY, |i| own - x(&keys[i]));
    let after = keys.get(index + 1).map_or(f32::INFINITY, |next| x(next) - own);
    before.min(after) - 4.0
}

/// What the light shows at a key frame, each thing once: what the caustics have of their own, and the common one of the others.
fn shown_at<'a>(key: &'a KeyFrame, project: &Project) -> Vec<&'a Shows> {
    let own = project.caustics.iter().map(|caustic| key.shown_by(Some(&caustic.name)));
    let mut all: Vec<&Shows> = Vec::new();
    for shows in own {
        if !all.contains(&shows) {
            all.push(shows);
        }
    }
    if all.is_empty() { vec![&key.shows] } else { all }
}

fn words(shows: &Shows) -> String {
    let file = |path: &str| path.rsplit('/').next().unwrap_or(path).to_owned();
    match shows {
        Shows::PhysicalCaustic => "the physical caustic".into(),
        Shows::Image(image) => file(&image.file),
        Shows::Points(points) => file(&points.file),
    }
}

struct KeyStyle {
    x: f32,
    size: egui::Vec2,
    chosen: bool,
    hot: bool,
}

fn paint(ui: &Ui, lane: Rect, style: &KeyStyle, thumbnails: &[Thumbnail]) {
    let painter = ui.painter_at(lane);
    let visuals = ui.visuals();
    let outline = if style.chosen {
        Stroke::new(1.5, theme::ACCENT)
    } else if style.hot {
        visuals.widgets.hovered.bg_stroke
    } else {
        Stroke::new(1.0, visuals.widgets.noninteractive.bg_stroke.color)
    };
    if style.size.x >= 14.0 {
        let middle = pos2(style.x, lane.top() + 4.0 + style.size.y / 2.0);
        let rect = Rect::from_center_size(middle, style.size);
        painter.rect_filled(rect, 3.0, Color32::BLACK);
        let sign = rect.shrink2(vec2(rect.width() * 0.12, rect.height() * 0.2));
        thumbnails.iter().for_each(|thumbnail| match thumbnail {
            // Light adds to light.
            Thumbnail::Picture(texture) => {
                let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                painter.image(*texture, rect, uv, Color32::WHITE);
            }
            Thumbnail::Physical => icons::physical(&painter, sign, Color32::from_gray(210)),
            Thumbnail::Waiting => {
                painter.text(
                    middle,
                    Align2::CENTER_CENTER,
                    "…",
                    FontId::proportional(14.0),
                    Color32::from_gray(150),
                );
            }
            Thumbnail::Failed(_) => {
                painter.text(middle, Align2::CENTER_CENTER, "!", FontId::proportional(18.0), theme::BAD);
            }
        });
        painter.rect_stroke(rect, CornerRadius::same(3), outline, StrokeKind::Outside);
    }
    let fill = if style.chosen { theme::ACCENT } else { visuals.widgets.inactive.fg_stroke.color };
    let radius = if style.hot { 7.5 } else { 6.5 };
    let at = pos2(style.x, lane.bottom() - DIAMOND);
    icons::diamond(&painter, at, radius, fill, Stroke::new(1.0, visuals.extreme_bg_color));
}

/// Paints the segment between two keys, with its easing curve.
fn between(ui: &Ui, lane: Rect, scale: &Scale, from: &KeyFrame, to: &KeyFrame) {
    let painter = ui.painter_at(lane);
    let (x0, x1) = (scale.x(f64::from(from.frame)), scale.x(f64::from(to.frame)));
    let y = lane.bottom() - DIAMOND;
    let colour = ui.visuals().weak_text_color();
    painter.hline(x0..=x1, y, Stroke::new(2.0, colour.gamma_multiply(0.5)));
    if x1 - x0 > 64.0 {
        let square = Rect::from_center_size(pos2((x0 + x1) / 2.0, y), vec2(20.0, 16.0));
        painter.rect_filled(square.expand2(vec2(3.0, 0.0)), 3.0, ui.visuals().faint_bg_color);
        icons::ease(&painter, from.ease, square, Stroke::new(1.3, colour));
    }
}

fn menu(response: &Response, index: usize, editor: &mut EditorContext, project: &Project) {
    response.context_menu(|ui| {
        ui.weak(if index + 1 < project.keys.len() {
            "Easing to the next key"
        } else {
            "Easing, once a key follows"
        });
        for (ease, name) in Ease::ALL.into_iter().zip(EASE.labels) {
            if ease_item(ui, ease, name, project.keys[index].ease == ease) {
                let mut keys = project.keys.clone();
                keys[index].ease = ease;
                step(editor, Edit::Keys(keys));
            }
        }
        ui.separator();
        if ui.button("Go to").clicked() {
            editor.session.focus.key = Some(index);
            go(editor, project.keys[index].frame);
        }
        let copy = edits::duplicate(project, index);
        if ui.add_enabled(copy.is_some(), Button::new("Duplicate")).clicked()
            && let Some(edit) = copy
        {
            step(editor, edit);
        }
        let rest = edits::remove_key(project, index);
        let delete = ui.add_enabled(rest.is_some(), Button::new("Delete"));
        if delete.on_disabled_hover_text("A project needs one key frame.").clicked()
            && let Some(edit) = rest
        {
            editor.session.focus.key = None;
            step(editor, edit);
        }
    });
}

/// A menu item with an easing curve.
fn ease_item(ui: &mut Ui, ease: Ease, name: &str, chosen: bool) -> bool {
    let place = IdSalt::new("curve");
    let shown = Button::selectable(chosen, (Atom::custom(place, vec2(22.0, 16.0)), name)).atom_ui(ui);
    if let Some(square) = shown.rect(place) {
        let colour = ui.style().interact_selectable(&shown.response, chosen).fg_stroke.color;
        icons::ease(ui.painter(), ease, square, Stroke::new(1.4, colour));
    }
    if shown.response.clicked() {
        ui.close();
    }
    shown.response.clicked()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_key_frame_shows_the_pictures_of_its_caustics_each_once() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/projects/bottles.json");
        let project = Project::load(std::path::Path::new(path)).unwrap();
        let shown = |key: usize| shown_at(&project.keys[key], &project).len();
        let last = project.keys.len() - 1;
        assert_eq!(shown(0), 1, "the physical caustic of all");
        assert_eq!(shown(last), project.caustics.len(), "a picture of each caustic");
        let bare = Project { caustics: Vec::new(), ..project.clone() };
        assert_eq!(shown_at(&bare.keys[last], &bare), [&bare.keys[last].shows]);
    }
}
