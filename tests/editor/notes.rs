//! Notes lead to what they are about.

use std::fs;

use egui_kittest::kittest::Queryable as _;
use lightloom::editor::action::Action;
use lightloom::editor::look::object::SceneObject;
use lightloom::editor::selection::Selection;
use lightloom::editor::session::Panel;
use lightloom_core::flow::FlowSettings;
use lightloom_core::note::About;

use crate::window::{Editor, document, examples, project, until, window};

#[test]
fn a_note_that_is_clicked_selects_the_wall_it_is_about() {
    let folder = examples();
    let path = project(&folder, "letters_free");
    let mut text: serde_json::Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    text["constraints"] = serde_json::json!([
        { "type": "directed_line", "points": [[0.2, 0.2], [0.4, 0.2]] },
        { "type": "wall", "points": [[0.0, 0.95], [1.0, 0.95]] }
    ]);
    fs::write(&path, text.to_string()).unwrap();
    let mut harness = window(&folder, "letters_free", Vec::new());
    harness.state_mut().ask(Action::Panel(Panel::Numbers));
    let is_told = |app: &lightloom::editor::App| {
        app.preview().preview().is_some_and(|preview| !preview.notes().is_empty())
    };
    until(&mut harness, "the note", is_told);
    harness.run_steps(3);
    harness.get_by_label_contains("reaches the border").scroll_to_me();
    harness.run_steps(3);
    harness.get_by_label_contains("reaches the border").click();
    harness.run_steps(3);
    let session = harness.state().session();
    assert_eq!((session.panel, &session.selection), (Panel::Drawn, &Selection::one(1)));
}

#[test]
fn a_lamp_that_misses_all_glass_is_told_in_the_status_bar_which_leads_to_the_notes() {
    let folder = examples();
    let path = project(&folder, "dark_glass");
    let mut text: serde_json::Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    let idle = serde_json::json!({ "type": "spot", "name": "idle", "position": [0, 1, 0], "target": [9, 1, 0], "angle_deg": 5 });
    text["scene"]["lights"].as_array_mut().unwrap().push(idle);
    fs::write(&path, text.to_string()).unwrap();
    let mut harness = window(&folder, "dark_glass", Vec::new());
    let told = |app: &lightloom::editor::App| {
        let notes = app.preview().notes();
        notes.iter().any(|note| note.text.contains("no caustic of its own: light 'idle'"))
    };
    until(&mut harness, "the note", told);
    harness.run_steps(3);
    let count = harness.state().preview().notes().len();
    let label = if count == 1 { "1 note".to_owned() } else { format!("{count} notes") };
    harness.get_by_label(&label).click();
    harness.run_steps(3);
    assert_eq!(harness.state().session().panel, Panel::Numbers);
    assert!(harness.query_by_label_contains("no caustic of its own").is_some());
}

#[test]
fn what_a_note_is_about_is_selected_and_its_panel_shown() {
    let folder = examples();
    let mut editor = Editor::new(document(&project(&folder, "bottles")));
    let second = editor.document.project().caustics[1].name.clone();
    let last = editor.document.project().keys.len() - 1;
    let frame = editor.document.project().keys[last].frame;
    let mut shown = |about: About| {
        editor.apply(Action::Show(about));
        let session = &editor.session;
        (session.panel, session.focus.object, session.focus.caustic, session.focus.key, session.playhead)
    };
    assert_eq!(shown(About::Mesh(1)), (Panel::Scene, Some(SceneObject::Mesh(1)), None, None, 1));
    assert_eq!(shown(About::Camera), (Panel::Scene, Some(SceneObject::Camera), None, None, 1));
    // One that is gone meanwhile.
    assert_eq!(shown(About::Light(99)), (Panel::Scene, None, None, None, 1));
    assert_eq!(shown(About::Caustic(second)), (Panel::Caustics, None, Some(1), None, 1));
    assert_eq!(shown(About::Key(last)), (Panel::Keys, None, Some(1), Some(last), frame));
    assert_eq!(shown(About::Setting(FlowSettings::GRID.place)).0, Panel::Flow);
    assert_eq!(shown(About::Project).0, Panel::Flow);
}
