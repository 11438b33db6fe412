//! Dialogs: the system's, ours where there is none, and questions.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use egui::Key;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lightloom::editor::dialogs::{Answer, PickRequest, PickResult, Picker, Purpose, Question, Scripted};

struct State {
    picker: Picker,
    picked: Vec<(Purpose, PathBuf)>,
}

/// A window that asks for a file at once and hears these answers of the system.
fn asking(request: PickRequest, answers: Vec<PickResult>) -> Harness<'static, State> {
    let state = State { picker: Picker::new(Arc::new(Scripted::new(answers))), picked: Vec::new() };
    let mut asked = Some(request);
    let builder = Harness::builder().with_size([800.0, 600.0]).with_max_steps(16);
    let mut harness = builder.build_ui_state(
        move |ui, state: &mut State| {
            let ctx = ui.ctx().clone();
            if let Some(request) = asked.take() {
                state.picker.ask(request, &ctx);
            }
            state.picked.extend(state.picker.show(&ctx));
        },
        state,
    );
    settle(&mut harness);
    harness
}

/// Folders are read on another thread: frames until what it found is shown.
fn settle(harness: &mut Harness<State>) {
    for _ in 0..10 {
        harness.run_ok();
        std::thread::sleep(Duration::from_millis(10));
    }
    for _ in 0..500 {
        harness.run_ok();
        if harness.query_by_label("Reading…").is_none() {
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("the folder is still being read");
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("scenes")).unwrap();
    std::fs::write(folder.path().join("scenes/one.json"), "{}").unwrap();
    std::fs::write(folder.path().join("here.json"), "{}").unwrap();
    folder
}

#[test]
fn what_the_system_answers_is_taken() {
    let request = PickRequest::new(Purpose::SaveProject);
    let harness = asking(request.clone(), vec![PickResult::Picked("/tmp/letter".into())]);
    assert_eq!(harness.state().picked, [(Purpose::SaveProject, "/tmp/letter.json".into())]);
    let harness = asking(request, vec![PickResult::Cancelled]);
    assert!(harness.state().picked.is_empty() && !harness.state().picker.is_open());
}

#[test]
fn without_a_system_dialog_ours_opens_folders_and_files() {
    let folder = folder();
    let request = PickRequest::new(Purpose::OpenProject).in_folder(Some(folder.path().into()));
    let mut harness = asking(request, vec![PickResult::Unavailable]);
    harness.get_by_role_and_label(Role::Button, "scenes/").click();
    settle(&mut harness);
    harness.get_by_role_and_label(Role::Button, "one.json").click();
    settle(&mut harness);
    harness.get_by_role_and_label(Role::Button, "Open").click();
    settle(&mut harness);
    let wanted = folder.path().canonicalize().unwrap().join("scenes/one.json");
    assert_eq!(harness.state().picked, [(Purpose::OpenProject, wanted)]);
}

#[test]
fn a_path_can_be_typed_and_a_wrong_one_is_said() {
    let folder = folder();
    let request = PickRequest::new(Purpose::OpenProject).in_folder(Some(folder.path().into()));
    let mut harness = asking(request, vec![PickResult::Unavailable]);
    harness.get_by_label("Path").focus();
    harness.run_ok();
    harness.get_by_label("Path").type_text("nowhere.json");
    harness.run_ok();
    harness.key_press(Key::Enter);
    settle(&mut harness);
    assert!(harness.query_by_label_contains("does not exist").is_some());
    assert!(harness.state().picker.is_open() && harness.state().picked.is_empty());
    harness.key_press(Key::Escape);
    settle(&mut harness);
    assert!(!harness.state().picker.is_open());
}

#[test]
fn saving_over_a_file_asks_before() {
    let folder = folder();
    let request = PickRequest::new(Purpose::SaveProject).in_folder(Some(folder.path().into())).named("here");
    let mut harness = asking(request, vec![PickResult::Unavailable]);
    harness.get_by_role_and_label(Role::Button, "Save").click();
    settle(&mut harness);
    assert!(harness.state().picked.is_empty());
    harness.get_by_role_and_label(Role::Button, "Overwrite").click();
    settle(&mut harness);
    assert_eq!(harness.state().picked.len(), 1);
    assert!(harness.state().picked[0].1.ends_with("here.json"));
}

#[test]
fn questions_are_answered_by_buttons_enter_and_escape() {
    let questions = [
        Question::Unsaved { title: "a".into() },
        Question::Recover { title: "a".into(), when: "10:30".into(), file_changed: true },
        Question::Changed { title: "a".into(), unsaved: true },
        Question::Message { title: "a".into(), text: "b".into() },
    ];
    for question in questions {
        let shown = question.clone();
        let ask = move || {
            let shown = shown.clone();
            let show = move |ui: &mut egui::Ui, answer: &mut Option<Answer>| {
                *answer = answer.or(shown.show(ui.ctx()));
            };
            let mut harness = Harness::builder().with_max_steps(16).build_ui_state(show, None);
            harness.run_ok();
            harness
        };
        let mut harness = ask();
        assert_eq!(*harness.state(), None);
        harness.key_press(Key::Enter);
        harness.run_ok();
        let message = matches!(question, Question::Message { .. });
        assert_eq!(*harness.state(), Some(if message { Answer::Cancel } else { Answer::Yes }));
        let mut harness = ask();
        harness.key_press(Key::Escape);
        harness.run_ok();
        // Which file holds must be decided: there is no way around it.
        let decided = matches!(question, Question::Changed { .. });
        assert_eq!(*harness.state(), (!decided).then_some(Answer::Cancel));
    }
    let show = |ui: &mut egui::Ui, answer: &mut Option<Answer>| {
        *answer = answer.or(Question::Unsaved { title: "a".into() }.show(ui.ctx()));
    };
    let mut harness = Harness::builder().with_max_steps(16).build_ui_state(show, None);
    harness.run_ok();
    harness.get_by_role_and_label(Role::Button, "Discard").click();
    harness.run_ok();
    assert_eq!(*harness.state(), Some(Answer::No));
}
