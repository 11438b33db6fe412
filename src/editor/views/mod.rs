//! The views: plane, shot and orbit view, side by side or alone.

mod fit;
mod halves;
mod orbit_view;
mod pictures;
mod plane;
mod shot;
mod transform;
mod wipe;

use egui::{CursorIcon, Rect, Sense, Ui, UiBuilder, pos2};

use super::action::Action;
use super::canvas::plane_transform::PlaneTransform;
use super::command::KeyPlace;
use super::look::gizmo::Handle;
use super::preview::{Plane, Wanted};
use super::session::{Session, ShotViewport, ViewLayout};
use super::tools::Toolbox;
use crate::editor::context::EditorContext;
use lightloom_core::project::Project;
use pictures::Pictures;

/// Gap between two views, points.
const GAP: f32 = 6.0;
/// Opacity of the veil over pictures that are not those of the project.
const VEIL: f32 = 0.7;
/// Minimum share of a view beside another.
const LEAST: f32 = 0.15;

/// The views of the window.
pub(super) struct Views {
    pictures: Pictures,
    /// Share of the plane view beside the shot, once it was chosen by hand; before, both pictures are as large as they can be.
    split: Option<f32>,
    wanted: Wanted,
    /// Rectangles of the plane view and the shot view when last shown.
    places: [Rect; 2],
    /// The orbit view when it was last shown, where its keys count.
    orbit: Option<egui::Id>,
    /// The handle under the pointer.
    handle: Option<Handle>,
    /// Whether a handle was grabbed by the drag that goes on: what is left of it after Escape flies no camera.
    grabbed: bool,
    /// Frames in which a transform still covers the window.
    covered: u8,
    /// The linear light under the pointer, as rendered.
    pixel: Option<glam::Vec3>,
    /// When the project's camera was flown last, seconds of the window.
    flown: Option<f64>,
}

impl Default for Views {
    fn default() -> Self {
        Self {
            pictures: Pictures::default(),
            split: None,
            wanted: Wanted::default(),
            places: [Rect::NOTHING; 2],
            orbit: None,
            handle: None,
            grabbed: false,
            covered: 0,
            pixel: None,
            flown: None,
        }
    }
}

impl Views {
    /// The pictures that the visible views need.
    pub(super) fn wanted(&self) -> &Wanted {
        &self.wanted
    }

    /// Forgets all pictures: those of another project are not shown.
    pub(super) fn forget_pictures(&mut self) {
        self.pictures = Pictures::default();
    }

    /// Whose keys count: those of the orbit view while the pointer is over it.
    pub(super) fn key_place(&self, ctx: &egui::Context) -> KeyPlace {
        // As the pointer is now: it may have come in the frame of the key.
        let view = self.orbit.and_then(|id| ctx.read_response(id));
        let is_over = view.is_some_and(|view| view.contains_pointer() || self.covered > 0)
            && !ctx.input(|input| input.pointer.any_down());
        if is_over { KeyPlace::OrbitView } else { KeyPlace::Everywhere }
    }

    /// The linear light under the pointer, as rendered; none where no picture is.
    pub(super) fn pixel(&self) -> Option<glam::Vec3> {
        self.pixel
    }

    /// Rectangle of the plane view.
    pub(super) fn plane_rect(&self) -> Rect {
        self.places[0]
    }

    /// Zooms so that one rendered pixel is one screen point; the plane gets the width of the picture.
    pub(super) fn actual_size(&self, session: &mut Session, project: &Project) {
        let width = project.render.width as f32;
        let [plane, shot] = self.places;
        session.plane.zoom =
            width / (PlaneTransform::new(plane, project.extent(), &Default::default()).scale()).max(1.0);
        session.shot =
            ShotViewport { zoom: width / fit::fitted(shot, project).width().max(1.0), offset: [0.0; 2] };
    }

    /// Shows the views of the session's layout.
    pub(super) fn show(&mut self, ui: &mut Ui, editor: &mut EditorContext, toolbox: &mut Toolbox) {
        self.pictures.take(ui.ctx(), editor.preview);
        self.wanted = Wanted::default();
        self.orbit = None;
        let pixel = self.pixel.take();
        if editor.session.layout != ViewLayout::Orbit && editor.session.transforming.take().is_some() {
            editor.ask(Action::Abort);
        }
        let all = ui.available_rect_before_wrap();
        // The orbit view has one of its own, beneath the handles by which the scene is put right.
        let veil = editor.preview.veil() && editor.session.layout != ViewLayout::Orbit;
        match editor.session.layout {
            ViewLayout::Plane => self.plane(ui, all, editor, toolbox),
            ViewLayout::Shot => self.shot(ui, all, editor, toolbox),
            ViewLayout::Orbit => self.look(ui, all, editor),
            ViewLayout::PlaneAndShot => {
                let [plane, shot] = self.halves(ui, all, editor.document.project());
                self.plane(ui, plane, editor, toolbox);
                self.shot(ui, shot, editor, toolbox);
            }
        }
        if self.pixel != pixel {
            // The status bar was shown before the views.
            ui.ctx().request_repaint();
        }
        if veil {
            draw_veil(ui, all);
        }
    }

    /// The rectangles of plane and shot, and the handle between them.
    fn halves(&mut self, ui: &mut Ui, all: Rect, project: &Project) -> [Rect; 2] {
        let arranged = halves::arranged(all, halves::aspects(project), self.split);
        let handle = arranged.handle(all, GAP);
        let response = ui.interact(handle, ui.scope_id().with("between the views"), Sense::click_and_drag());
        let cursor = if arranged.stacked { CursorIcon::ResizeVertical } else { CursorIcon::ResizeHorizontal };
        let response = response.on_hover_and_drag_cursor(cursor);
        if let Some(at) = response.interact_pointer_pos().filter(|_| response.dragged()) {
            self.split = Some(arranged.share(all, at).clamp(LEAST, 1.0 - LEAST));
        }
        if response.double_clicked() {
            self.split = None;
        }
        let colour = if response.hovered() { super::theme::ACCENT } else { ui.visuals().panel_fill };
        ui.painter().rect_filled(handle, 0.0, colour);
        arranged.places(all, GAP)
    }

    fn plane(&mut self, ui: &mut Ui, place: Rect, editor: &mut EditorContext, toolbox: &mut Toolbox) {
        self.places[0] = place;
        let longer = place.size().max_elem() * ui.pixels_per_point();
        self.wanted.plane = if editor.preview.draws_photons() && !editor.session.overlays.false_colour {
            Plane::Photons
        } else {
            // While it plays, quick beats sharp.
            let most = if editor.session.playing { 512.0 } else { 1024.0 };
            Plane::Picture(longer.clamp(64.0, most) as usize)
        };
        let mut ui = ui.new_child(UiBuilder::new().id_salt("plane view").max_rect(place));
        self.plane_view(&mut ui, editor, toolbox);
        title(&ui, place, "Plane");
    }

    fn shot(&mut self, ui: &mut Ui, place: Rect, editor: &mut EditorContext, toolbox: &mut Toolbox) {
        self.places[1] = place;
        let mut ui = ui.new_child(UiBuilder::new().id_salt("shot view").max_rect(place));
        self.wanted.shot = Some(fit::size(&ui, place, editor.document.project()));
        self.shot_view(&mut ui, editor, toolbox);
        title(&ui, place, "Shot");
    }

    fn look(&mut self, ui: &mut Ui, place: Rect, editor: &mut EditorContext) {
        let mut ui = ui.new_child(UiBuilder::new().id_salt("orbit view").max_rect(place));
        self.orbit_view(&mut ui, editor);
        title(&ui, place, "Orbit view");
    }
}

/// A veil over pictures that are not those of the project.
fn draw_veil(ui: &Ui, place: Rect) {
    ui.painter_at(place).rect_filled(place, 0.0, super::theme::SURROUND.gamma_multiply(VEIL));
}

/// The name of a view in its corner.
fn title(ui: &Ui, place: Rect, name: &str) {
    let at = pos2(place.left() + 10.0, place.top() + 8.0);
    let font = egui::FontId::proportional(11.5);
    ui.painter().text(at, egui::Align2::LEFT_TOP, name, font, egui::Color32::from_gray(150));
}
