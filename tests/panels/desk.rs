//! A desk for the tests: the panels over a document, and what they asked for.

use std::path::{Path, PathBuf};

use egui::accesskit::Role;
use egui::{Event, Modifiers, PointerButton};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lightloom::editor::action::Action;
use lightloom::editor::context::EditorContext;
use lightloom::editor::document::Document;
use lightloom::editor::panels;
use lightloom::editor::preview::Preview;
use lightloom::editor::session::{Focus, Panel, Session};
use lightloom::editor::theme;
use lightloom_core::project::Project;

/// A window with nothing but the panels.
pub(crate) type Bench = Harness<'static, Table>;

/// What the window is about.
pub(crate) struct Table {
    pub(crate) document: Document,
    pub(crate) session: Session,
    pub(crate) preview: Preview,
    /// All that was asked for.
    pub(crate) asked: Vec<Action>,
    /// Whether edits are carried out.
    pub(crate) applies: bool,
    /// The last edit that the document refused.
    pub(crate) refused: Option<String>,
}

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

/// Every list opened at its first element.
pub(crate) fn first_of_everything(project: &Project) -> Focus {
    let scene = project.scene.as_ref();
    Focus {
        key: Some(0),
        caustic: (!project.caustics.is_empty()).then_some(0),
        mesh: scene.filter(|scene| !scene.meshes.is_empty()).map(|_| 0),
        light: scene.filter(|scene| !scene.lights.is_empty()).map(|_| 0),
    }
}

/// Width of the panels, points.
pub(crate) const WIDTH: f32 = 300.0;

/// The panels over a project, with one of them chosen.
pub(crate) fn bench(project: Project, panel: Panel) -> Bench {
    bench_in(project, panel, egui::Theme::Dark)
}

/// The same in a theme.
pub(crate) fn bench_in(project: Project, panel: Panel, of: egui::Theme) -> Bench {
    let table = Table {
        document: Document::new(project, None),
        session: Session { panel, ..Session::default() },
        preview: Preview::new(|| ()),
        asked: Vec::new(),
        applies: true,
        refused: None,
    };
    let mut bench = Harness::builder()
        .with_size(egui::vec2(WIDTH, 1000.0))
        .with_theme(of)
        .with_max_steps(20)
        .with_context_setup(theme::apply)
        .build_ui_state(show, table);
    bench.run();
    bench
}

fn show(ui: &mut egui::Ui, table: &mut Table) {
    let mut actions = Vec::new();
    let mut editor = EditorContext {
        document: &table.document,
        session: &mut table.session,
        preview: &table.preview,
        actions: &mut actions,
    };
    panels::show(ui, &mut editor);
    for action in actions {
        match &action {
            Action::Edit(edit) if table.applies => {
                if let Err(error) = table.document.edit(edit.clone()) {
                    table.refused = Some(error.to_string());
                }
            }
            Action::Select(selection) => table.session.selection = selection.clone(),
            Action::Solo(groups) => table.session.solo = groups.clone(),
            _ => {}
        }
        table.asked.push(action);
    }
}

/// Two clicks in one place, quick enough to be one gesture.
pub(crate) fn double_click(bench: &mut Bench, role: Role, name: &str) {
    let pos = bench.get_by_role_and_label(role, name).rect().center();
    let button = |pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let events = [Event::PointerMoved(pos), button(true), button(false), button(true), button(false)];
    // All in one step: the harness lets more time pass between steps than a double click may take.
    bench.input_mut().events.extend(events);
    bench.run();
}
