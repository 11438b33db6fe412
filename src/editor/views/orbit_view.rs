//! The orbit view: the scene through a free camera or the project's, its objects drawn over it, selected and transformed.

use egui::{
    Color32, Painter, PointerButton, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo,
};
use glam::Vec2;
use lightloom_core::scene::{CameraDesc, SceneDesc};

use super::Views;
use super::draw_veil;
use super::fit::WHOLE;
use super::transform;
use crate::editor::action::Action;
use crate::editor::context::EditorContext;
use crate::editor::document::Edit;
use crate::editor::keyboard::is_covered;
use crate::editor::look::bounds::{Loaded, pivot};
use crate::editor::look::fly;
use crate::editor::look::gizmo::{Gizmo, Handle};
use crate::editor::look::object::SceneObject;
use crate::editor::look::overlay::{self, SceneOverlay};
use crate::editor::look::pick::pick;
use crate::editor::look::transforming::Transforming;
use crate::editor::look::viewpoint::{Viewpoint, fitted};
use crate::editor::preview::Seen;
use crate::editor::session::Panel;
use crate::editor::theme;

/// Maximum pixels along the longer side, for interactive speed.
const MOST: f32 = 640.0;
/// Wheel scroll that doubles the zoom, points.
const WHEEL: f32 = 240.0;
/// Margin around the picture of the project's camera, points.
const MARGIN: f32 = 28.0;
/// Seconds after the last turn of the wheel in which the flight of the camera goes on: one step of undo.
const FLIGHT: f64 = 0.6;

impl Views {
    /// Shows the orbit view; its pointer selects, transforms and flies.
    pub(super) fn orbit_view(&mut self, ui: &mut Ui, editor: &mut EditorContext) {
        let view = ui.available_rect_before_wrap();
        let project = editor.document.project().clone();
        let shot = project.scene.as_ref().map_or_else(CameraDesc::default, |scene| scene.camera.clone());
        let response = ui.allocate_rect(view, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, ui.is_enabled(), "Orbit view"));
        // What covers the window during a transform does so for a frame after its end.
        let transforms = editor.session.transforming.is_some();
        self.covered = if transforms { 2 } else { self.covered.saturating_sub(1) };
        self.orbit = project.scene.as_ref().map(|_| response.id);
        let aspect = [project.render.width as f32, project.render.height as f32];
        let through = editor.session.through_camera && project.scene.is_some();
        let frame = if through { fitted(view.shrink(MARGIN), aspect) } else { view };
        let camera = if through { shot.clone() } else { free_camera(editor, &shot) };
        let seen = editor.preview.look();
        let shown = self.shown(ui, &seen, (&camera, frame));
        let scene = project.scene.as_ref().zip(shown.as_ref());
        let over = self.objects(ui, &response, editor, scene, &seen);
        let by_handle = |transforming: &Transforming| transforming.by_handle;
        self.grabbed |= editor.session.transforming.as_ref().is_some_and(by_handle);
        self.grabbed &= ui.input(|input| input.pointer.any_down());
        if editor.session.transforming.is_none() && !self.grabbed {
            self.navigate(ui, &response, editor, (&camera, through));
        }
        let camera = if through { shot } else { editor.session.free_camera.clone().unwrap_or(camera) };
        self.wanted.look = Some((camera, pixels(ui, frame)));
        self.paint(ui, view, &seen, shown.map_or(frame, |shown| shown.place), through);
        if editor.preview.veil() && !seen.has_meshes_of(&project) {
            draw_veil(ui, view);
        }
        if let Some((scene, shown)) = scene {
            let aspect = aspect[0] / aspect[1].max(1.0);
            self.draw((&ui.painter_at(view), shown), editor, scene, &seen, (over, aspect, through));
        }
        transform::words(ui, view, editor, through);
    }

    /// What the pointer does with the objects: a transform goes on, or one is selected. Returns the one under it.
    fn objects(
        &mut self,
        ui: &Ui,
        response: &Response,
        editor: &mut EditorContext,
        scene: Option<(&SceneDesc, &Viewpoint)>,
        seen: &Seen,
    ) -> Option<SceneObject> {
        let is_transforming = editor.session.transforming.is_some();
        let Some((scene, shown)) = scene else {
            if editor.session.transforming.take().is_some() {
                editor.ask(Action::Abort);
            }
            return None;
        };
        if is_transforming {
            transform::drive(ui, editor, scene, shown);
            return None;
        }
        self.handle = point(ui, response, editor, (scene, shown), seen.loaded());
        hovered(response, (scene, shown), seen.loaded(), editor.session.focus.object)
    }

    /// Draws the objects over the picture. A transform is seen before the project has it.
    fn draw(
        &self,
        (painter, view): (&Painter, &Viewpoint),
        editor: &EditorContext,
        scene: &SceneDesc,
        seen: &Seen,
        (over, aspect, through_camera): (Option<SceneObject>, f32, bool),
    ) {
        let transforming = editor.session.transforming.as_ref();
        let changed = transforming.and_then(|transforming| transforming.scene().ok());
        let scene = changed.as_ref().unwrap_or(scene);
        let (loaded, selected) = (seen.loaded(), editor.session.focus.object);
        SceneOverlay { painter, view, scene, loaded, selected, over, aspect, through_camera }.draw();
        if let (None, Some(gizmo)) = (transforming, gizmo((scene, view), loaded, selected)) {
            gizmo.draw(painter, self.handle);
        }
    }

    /// Whether the project's camera is being flown.
    pub(in crate::editor) fn is_flying(&self, ctx: &egui::Context) -> bool {
        let left = self.flown.map_or(0.0, |at| at + FLIGHT - ctx.input(|input| input.time));
        if left > 0.0 {
            ctx.request_repaint_after(std::time::Duration::from_secs_f64(left));
        }
        left > 0.0
    }

    /// The viewpoint of the picture that is on the screen: what is drawn over it belongs to it.
    fn shown(&self, ui: &Ui, seen: &Seen, (camera, frame): (&CameraDesc, Rect)) -> Option<Viewpoint> {
        let picture = self.pictures.look.texture().zip(seen.camera.as_ref());
        match picture {
            Some((texture, camera)) => Viewpoint::new(
                camera,
                fitted(frame, texture.size().map(|n| n as f32 / ui.pixels_per_point())),
            ),
            None => Viewpoint::new(camera, frame),
        }
    }

    /// Flies the camera: a drag orbits, with Shift or the middle button it pans, the wheel dollies.
    fn navigate(
        &mut self,
        ui: &Ui,
        response: &Response,
        editor: &mut EditorContext,
        (camera, through): (&CameraDesc, bool),
    ) {
        let (by, shift) = (response.drag_delta(), ui.input(|input| input.modifiers.shift));
        let by = Vec2::new(by.x, by.y);
        let mut flown = camera.clone();
        if response.dragged_by(PointerButton::Middle) || (shift && response.dragged()) {
            flown = fly::panned(&flown, by, response.rect.height());
        } else if response.dragged() {
            flown = fly::orbited(&flown, by);
        }
        if response.hovered() {
            let factor =
                ui.input(|input| input.zoom_delta() * (input.smooth_scroll_delta().y / WHEEL).exp2());
            if factor != 1.0 {
                flown = fly::dollied(&flown, factor);
            }
        }
        if flown == *camera {
            return;
        }
        if !through {
            editor.session.free_camera = Some(flown);
            return;
        }
        self.flown = Some(ui.input(|input| input.time));
        let scene = editor.document.project().scene.clone();
        if let Some(scene) = scene {
            editor.ask(Edit::Scene(Some(Box::new(SceneDesc { camera: flown, ..scene }))));
        }
    }

    fn paint(&self, ui: &Ui, view: Rect, seen: &Seen, place: Rect, through: bool) {
        let painter = ui.painter_at(view);
        painter.rect_filled(view, 0.0, theme::SURROUND);
        if let Some(texture) = self.pictures.look.texture().filter(|_| seen.picture.is_some()) {
            painter.image(texture.id(), place, WHOLE, Color32::WHITE);
        }
        if through {
            painter.rect_stroke(place, 0.0, Stroke::new(1.0, theme::ACCENT), StrokeKind::Outside);
        }
    }
}

/// The free camera, with the lens of the shot.
fn free_camera(editor: &mut EditorContext, shot: &CameraDesc) -> CameraDesc {
    let free = editor.session.free_camera.take().unwrap_or_else(|| fly::free(shot));
    let free = CameraDesc { fov_deg: shot.fov_deg, ..free };
    editor.session.free_camera = Some(free.clone());
    free
}

/// Size in pixels of the picture for a rectangle of the screen.
fn pixels(ui: &Ui, frame: Rect) -> [u32; 2] {
    let pixels = frame.size() * ui.pixels_per_point();
    let shrink = (MOST / pixels.max_elem()).min(1.0);
    [pixels.x, pixels.y].map(|n| ((n * shrink).round() as u32).max(16))
}

fn gizmo<'a>(
    (scene, shown): (&SceneDesc, &'a Viewpoint),
    loaded: Option<Loaded>,
    selected: Option<SceneObject>,
) -> Option<Gizmo<'a>> {
    let object = selected.filter(|object| object.is_in(scene))?;
    let pivot = pivot(scene, object, loaded)?;
    let light = object.light().and_then(|index| scene.lights.get(index));
    let is_sun = light.is_some_and(|light| light.position().is_none());
    Some(Gizmo::new(shown, object, pivot, (is_sun, light.is_none_or(overlay::turns))))
}

/// What the pointer does: a press on a handle begins a transform, a click selects. Returns the handle under it.
fn point(
    ui: &Ui,
    response: &Response,
    editor: &mut EditorContext,
    (scene, shown): (&SceneDesc, &Viewpoint),
    loaded: Option<Loaded>,
) -> Option<Handle> {
    let selected = editor.session.focus.object.filter(|object| object.is_in(scene));
    if response.hovered() && ui.input(|input| input.key_pressed(egui::Key::Escape)) && !is_covered(ui.ctx()) {
        editor.session.focus.object = None;
    }
    let at = response.hover_pos().or_else(|| response.interact_pointer_pos())?;
    let handle = gizmo((scene, shown), loaded, selected).and_then(|gizmo| gizmo.hit(at));
    let pressed = response.contains_pointer() && ui.input(|input| input.pointer.primary_pressed());
    if let (true, Some(handle), Some(object)) = (pressed, handle, selected) {
        let pivot = pivot(scene, object, loaded)?;
        let mut begun = Transforming::new(object, handle.kind, scene, pivot).by_handle(handle.lock());
        begun.point(shown, at);
        editor.ask(Action::Settle);
        editor.session.playing = false;
        editor.session.transforming = Some(begun);
    } else if response.clicked() {
        let picked = pick(at, shown, scene, loaded, selected);
        editor.session.focus.object = picked;
        if picked.is_some() {
            editor.session.panel = Panel::Scene;
        }
    }
    handle
}

/// The object under the pointer, while no button is down.
fn hovered(
    response: &Response,
    (scene, shown): (&SceneDesc, &Viewpoint),
    loaded: Option<Loaded>,
    selected: Option<SceneObject>,
) -> Option<SceneObject> {
    let at = response.hover_pos().filter(|_| response.hovered() && !response.dragged())?;
    pick(at, shown, scene, loaded, selected)
}
