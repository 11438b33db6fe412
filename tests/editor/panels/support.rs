//! The panels over a project, for the tests.

use std::path::{Path, PathBuf};

use egui::accesskit::Role;
use egui::{Event, Modifiers, PointerButton};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lightloom::editor::look::object::SceneObject;
use lightloom::editor::panels;
use lightloom::editor::session::{Focus, Panel};
use lightloom::editor::theme;
use lightloom_core::project::Project;

use crate::window::Editor;

/// A window with nothing but the panels.
pub(crate) type PanelHarness = Harness<'static, Editor>;

fn projects() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("projects")
}

/// The example of this name.
pub(crate) fn example(name: &str) -> Project {
    Project::load(&projects().join(format!("{name}.json"))).unwrap()
}

/// All examples, by name.
pub(crate) fn examples() -> Vec<(String, Project)> {
    let files = std::fs::read_dir(projects()).unwrap().map(|entry| entry.unwrap().path());
    let mut names: Vec<String> = files
        .filter(|path| path.extension().is_some_and(|end| end == "json"))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    names.sort();
    names.into_iter().map(|name| (name.clone(), example(&name))).collect()
}

/// Every list opened at its first element; of the scene one object after the other.
pub(crate) fn firsts(project: &Project, panel: Panel) -> Vec<Focus> {
    let scene = project.scene.as_ref();
    let objects = [SceneObject::Mesh(0), SceneObject::Light(0), SceneObject::Camera, SceneObject::Receiver];
    let mut there: Vec<Option<SceneObject>> = objects
        .into_iter()
        .filter(|object| scene.is_some_and(|scene| object.is_in(scene)))
        .map(Some)
        .collect();
    if panel != Panel::Scene || there.is_empty() {
        there = vec![None];
    }
    let focus = |object| Focus { key: Some(0), caustic: (!project.caustics.is_empty()).then_some(0), object };
    there.into_iter().map(focus).collect()
}

/// Width of the panels, points.
pub(crate) const WIDTH: f32 = 300.0;

/// The panels over a project, with one of them chosen.
pub(crate) fn panel_harness(project: Project, panel: Panel) -> PanelHarness {
    panel_harness_in(project, panel, egui::Theme::Dark)
}

/// The same in a theme.
pub(crate) fn panel_harness_in(project: Project, panel: Panel, of: egui::Theme) -> PanelHarness {
    let mut editor = Editor::with_project(project);
    editor.session.panel = panel;
    let mut harness = Harness::builder()
        .with_size(egui::vec2(WIDTH, 1000.0))
        .with_theme(of)
        .with_max_steps(20)
        .with_context_setup(theme::apply)
        .build_ui_state(show, editor);
    harness.run();
    harness
}

fn show(ui: &mut egui::Ui, editor: &mut Editor) {
    let ctx = ui.ctx().clone();
    editor.frame(&ctx, |editor| panels::show(ui, editor));
}

/// Two clicks in one place, quick enough to be one gesture.
pub(crate) fn double_click(harness: &mut PanelHarness, role: Role, name: &str) {
    double_click_in(harness, role, name, false);
}

/// The same, with a frame between the clicks where they are `apart`.
pub(crate) fn double_click_in(harness: &mut PanelHarness, role: Role, name: &str, apart: bool) {
    let pos = harness.get_by_role_and_label(role, name).rect().center();
    let button = |pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    harness.input_mut().events.extend([Event::PointerMoved(pos), button(true), button(false)]);
    if apart {
        // One step and no more: the harness lets more time pass than a double click may take.
        harness.step();
    }
    harness.input_mut().events.extend([button(true), button(false)]);
    harness.run();
}
