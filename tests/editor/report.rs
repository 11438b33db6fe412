//! The report that a user sends.

use std::fs;

use crate::window::{examples, until, window};
use lightloom::editor::action::Action;
use lightloom::editor::command::Command;
use lightloom::editor::dialogs::PickResult;

#[test]
fn a_report_tells_versions_and_settings_and_no_content_of_files() {
    let folder = examples();
    let path = folder.path().join("report.txt");
    let mut harness = window(&folder, "letters_free", vec![PickResult::Picked(path.clone())]);
    harness.run_steps(3);
    harness.state_mut().ask(Action::Command(Command::SaveReport));
    until(&mut harness, "the report", |_| path.exists());
    let text = fs::read_to_string(&path).unwrap();
    for part in [
        env!("CARGO_PKG_VERSION"),
        "== graphics ==",
        "\"theme\": \"dark\"",
        "2 keys",
        "== notes on it ==",
        "== messages (",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    // Neither the project's own words nor the names of recent files.
    for part in ["letter_c.png", "letters_free", "\"recent\": [\n"] {
        assert!(!text.contains(part), "{part}: {text}");
    }
}
