//! Projects that are handed on, and files that are trusted, as the command line meets them.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

use crate::small::{letters, lightloom};

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn run(args: &[&str]) -> String {
    let output = lightloom(args);
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn a_collected_project_renders_the_same_bytes_in_its_folder() {
    let (folder, project) = letters("linear");
    let into = folder.path().join("in/there");
    let printed = run(&["collect", text(&project), "--into", text(&into), "--json"]);
    let result: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(result["copied"].as_array().unwrap().len(), 2);
    let there = result["project"].as_str().unwrap();
    let render = |project: &str, out: &Path| {
        run(&["render", project, "--out", text(out), "--frames", "5", "--format", "png"]);
        fs::read(out.join("frame.0005.png")).unwrap()
    };
    let here = render(text(&project), &folder.path().join("a"));
    assert_eq!(here, render(there, &folder.path().join("b")));
    // What stands there is not overwritten.
    fs::write(there, "another").unwrap();
    let refused = lightloom(&["collect", text(&project), "--into", text(&into)]);
    assert_eq!(refused.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("another folder"));
    assert_eq!(fs::read_to_string(there).unwrap(), "another");
}

#[test]
fn what_the_editor_trusts_the_command_line_reads() {
    let (folder, project) = letters("linear");
    let far = tempfile::tempdir().unwrap();
    let picture = far.path().canonicalize().unwrap().join("s.png");
    fs::rename(folder.path().join("letter_s.png"), &picture).unwrap();
    let named = fs::read_to_string(&project).unwrap().replace("letter_s.png", text(&picture));
    fs::write(&project, named).unwrap();
    let state = folder.path().join("state");
    let check = || {
        let program = env!("CARGO_BIN_EXE_lightloom");
        Command::new(program)
            .args(["check", text(&project)])
            .env("LIGHTLOOM_STATE_DIR", &state)
            .output()
            .unwrap()
    };
    let refused = check();
    assert_eq!(refused.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("trust it in the editor"));
    fs::create_dir_all(&state).unwrap();
    fs::write(state.join("trusted.json"), json!({ "files": [picture] }).to_string()).unwrap();
    assert!(check().status.success());
}
