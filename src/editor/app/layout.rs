//! The layout of the window.

use eframe::egui;
use egui::{Align, CentralPanel, Frame, Layout, Margin, Panel, RichText, Ui};
use lightloom_core::import::awaits_glass;

use super::file_state::Details;
use super::task::{Doing, Task};
use super::{App, Gpu};
use crate::editor::action::Action;
use crate::editor::command::Command;
use crate::editor::context::EditorContext;
use crate::editor::export;
use crate::editor::invitation;
use crate::editor::panels;
use crate::editor::store::PhotonRenderer;
use crate::editor::timeline::Timeline;
use crate::editor::tools::toolbar;
use crate::editor::tour::Anchors;
use crate::editor::{menu, theme};

/// Width of the panel on the right at first, and at least, points.
const PANEL: [f32; 2] = [330.0, 290.0];
/// Width in points at which the status bar has room for all it shows while work goes on.
const ROOM: f32 = 1000.0;

impl App {
    /// Shows everything; actions are appended to `actions`.
    pub(super) fn layout(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        let mut details_wanted = false;
        let mut editor = self.editor.context(actions);
        let editor = &mut editor;
        Panel::top("menu").show(ui, |ui| menu::show(ui, editor, &self.recents.found(), &self.files.backups));
        Panel::bottom("status").exact_size(28.0).show(ui, |ui| {
            let told = self.details.as_ref().is_some_and(|details| details.status == *editor.status);
            let tasks = [
                self.importing.as_ref().map(Task::shown),
                self.collecting.as_ref().map(Task::shown),
                self.placing.as_ref().map(|placing| placing.task.shown()),
            ];
            let clicked = status(
                ui,
                editor,
                self.gpu,
                self.preferences.photon_renderer,
                (&self.exports, &tasks, told, self.views.pixel()),
            );
            if clicked.export {
                editor.ask(Command::Export);
            }
            if clicked.notes {
                editor.ask(Action::Panel(panels::NOTES));
            }
            details_wanted = clicked.details;
        });
        let height = Timeline::height(editor);
        let timeline = Panel::bottom("timeline").resizable(true).default_size(height).min_size(110.0);
        self.timeline.access = self.files.access();
        let play = timeline.show(ui, |ui| self.timeline.show(ui, editor)).inner;
        let frame = Frame::side_top_panel(ui.style()).inner_margin(Margin::same(2));
        let tools = Panel::left("tools").exact_size(toolbar::WIDTH).resizable(false).frame(frame);
        let [line, wall] = tools.show(ui, |ui| toolbar::show(ui, editor, &self.toolbox)).inner;
        Panel::right("panels")
            .resizable(true)
            .default_size(PANEL[0])
            .min_size(PANEL[1])
            .show(ui, |ui| panels::show(ui, editor));
        let surround = Frame::NONE.fill(theme::SURROUND);
        let plane = CentralPanel::default().frame(surround).show(ui, |ui| {
            let views = ui.max_rect();
            self.views.show(ui, editor, &mut self.toolbox);
            if let Some(problem) = editor.preview.problem().map(str::to_owned) {
                // Over the views: nothing moves away under the pointer.
                let place = egui::Area::new(egui::Id::unique("problem"))
                    .fixed_pos(views.min)
                    .order(egui::Order::Middle);
                place.show(ui.ctx(), |ui| {
                    banner(ui).show(ui, |ui| {
                        ui.set_width(views.width() - 24.0);
                        let asked = problem_banner(ui, &problem);
                        self.files.asks_outside |= asked;
                    });
                });
            }
            if awaits_glass(editor.document.project()) {
                invitation::show(ui, views, editor);
            }
            self.views.plane_rect()
        });
        if details_wanted && let Some(Details { title, text, .. }) = self.details.clone() {
            self.show_message(title, text);
        }
        self.windows.anchors = Some(Anchors { line, wall, play, plane: plane.inner });
    }
}

fn banner(ui: &Ui) -> Frame {
    Frame::side_top_panel(ui.style())
        .fill(ui.visuals().panel_fill.lerp_to_gamma(theme::BAD, 0.25))
        .inner_margin(Margin::symmetric(12, 6))
}

/// The preview's problem; returns whether files outside of the project's folder shall be allowed.
fn problem_banner(ui: &mut Ui, problem: &str) -> bool {
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("The preview cannot be computed").strong());
        ui.label(problem);
        problem.contains("--allow-external") && ui.button("Allow these files…").clicked()
    })
    .inner
}

/// What was clicked in the status bar.
#[derive(Default)]
struct Clicked {
    export: bool,
    /// The notes on the project.
    notes: bool,
    /// The details of the message.
    details: bool,
}

/// The status bar: activity, message with its details if there are some, export, notes, renderer.
fn status(
    ui: &mut Ui,
    editor: &EditorContext,
    gpu: Gpu,
    renderer: PhotonRenderer,
    (exports, tasks, has_details, pixel): (&export::Exports, &[Option<Doing>], bool, Option<glam::Vec3>),
) -> Clicked {
    let mut clicked = Clicked::default();
    ui.horizontal_centered(|ui| {
        let activity = editor.preview.activity();
        let idle = match (editor.preview.problem(), editor.preview.is_shown()) {
            (Some(_), _) => "not computed",
            (None, true) => "ready",
            (None, false) if awaits_glass(editor.document.project()) => "no glass yet",
            (None, false) => "painting",
        };
        let (doing, share) = activity.map_or((idle, 1.0), |now| (doing(now.stage), now.fraction));
        let bar = egui::ProgressBar::new(share).desired_width(70.0).desired_height(6.0);
        ui.add_enabled(activity.is_some(), bar).accessible_name("Preview");
        // As wide as the longest word, so that nothing jumps.
        ui.add_sized([120.0, 18.0], egui::Label::new(RichText::new(doing).weak()).halign(Align::Min));
        ui.separator();
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            // In a narrow window, what the panels show too gives way to work that goes on.
            let is_busy = exports.is_busy() || tasks.iter().any(Option::is_some);
            let has_room = !is_busy || ui.available_width() > ROOM;
            if has_room {
                let (name, help) = drawn_by(gpu, renderer);
                ui.weak(name).on_hover_text(help);
                ui.separator();
                panels::readouts::status_line(ui, editor);
            }
            clicked.notes = panels::readouts::note_count(ui, editor.preview.notes());
            if let Some(light) = pixel.filter(|_| has_room) {
                ui.separator();
                panels::readouts::pixel(ui, light, editor.document.project().render.view.exposure);
            }
            ui.separator();
            clicked.export = export::status_line(ui, exports);
            tasks.iter().flatten().for_each(|task| task.show(ui));
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                clicked.details = has_details && ui.small_button("Details").clicked();
                ui.add(egui::Label::new(editor.status).truncate());
            });
        });
    });
    clicked
}

/// The name of the preview's stage.
fn doing(stage: &str) -> &'static str {
    match stage {
        "trace" => "tracing photons",
        "match" => "matching",
        "plan" => "planning the flow",
        "fit" => "fitting the flow",
        "watch" | "measure" => "measuring the flow",
        "visible" | "background" | "still" => "rendering the background",
        "render" | "carry" => "moving photons",
        _ => "loading",
    }
}

fn drawn_by(gpu: Gpu, renderer: PhotonRenderer) -> (&'static str, &'static str) {
    match (gpu, renderer) {
        (Gpu::Hardware, PhotonRenderer::Auto | PhotonRenderer::Gpu) => {
            ("Graphics card", "The graphics card draws the light of the plane view.")
        }
        (Gpu::Software, PhotonRenderer::Gpu) => {
            ("Software graphics", "There is no graphics card; a software renderer draws the light.")
        }
        (Gpu::Hardware, PhotonRenderer::Cpu) => {
            ("Processor", "The processor draws the light, as set in the preferences.")
        }
        (Gpu::Software | Gpu::None, _) => (
            "No graphics card",
            "The processor draws the light: the same picture at a lower frame rate. Everything else is the same.",
        ),
    }
}
