//! The log of a run.

use std::fs;
use std::process::{Command, Output};

use crate::small::letters;

/// Runs the program with a state folder.
fn run(state: &std::path::Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lightloom"))
        .args(args)
        .env("LIGHTLOOM_STATE_DIR", state)
        .output()
        .unwrap()
}

#[test]
fn a_command_logs_where_it_is_asked_to_and_the_last_runs_are_kept() {
    let (folder, project) = letters("flow");
    let (project, state) = (project.to_str().unwrap(), folder.path().join("state"));
    assert!(run(&state, &["check", project]).status.success());
    assert!(!state.exists(), "a command without --log leaves nothing");
    for _ in 0..5 {
        assert!(run(&state, &["check", project, "--log", "info"]).status.success());
    }
    let logs: Vec<_> = fs::read_dir(state.join("logs")).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(logs.len(), 3);
    let text = fs::read_to_string(&logs[0]).unwrap();
    assert!(text.contains(env!("CARGO_PKG_VERSION")) && text.contains("Small letters"), "{text}");

    let file = folder.path().join("a.log");
    let failed = run(&state, &["check", "none.json", "--log", file.to_str().unwrap()]);
    assert_eq!(failed.status.code(), Some(3));
    let text = fs::read_to_string(&file).unwrap();
    assert!(text.contains("ERROR") && text.contains("none.json"), "{text}");

    let nowhere = run(&state, &["check", project, "--log", "no/such/folder/a.log"]);
    assert_eq!(nowhere.status.code(), Some(5));
    assert!(String::from_utf8_lossy(&nowhere.stderr).contains("a.log"));

    // A project is not taken for a log.
    let before = fs::read(project).unwrap();
    let refused = run(&state, &["check", project, "--log", project]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("ends in .log"));
    assert_eq!(fs::read(project).unwrap(), before);
}
