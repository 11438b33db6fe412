//! `lightloom report`: the pages, tables and refusals of the command.

use std::process::Command;

use serde_json::Value;

use crate::letters::project;

#[test]
fn the_command_writes_a_page_that_needs_no_other_file_and_its_tables() {
    let (folder, path) = project(&["c", "s"]);
    let out = folder.path().join("out");
    let run = |extra: &[&str]| {
        let args = ["report", path.to_str().unwrap(), "--out", out.to_str().unwrap(), "--quick"];
        Command::new(env!("CARGO_BIN_EXE_lightloom")).args(args).args(extra).output().unwrap()
    };
    let done = run(&["--only", "gamma"]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("<svg") && page.contains("What gamma does"));
    let needs_others = ["src=\"http", "href=\"http", "<script", "<link"];
    assert!(needs_others.iter().all(|part| !page.contains(part)), "the page stands alone");
    assert!(!page.contains("Small <letters>") && page.contains("Small &lt;letters&gt;"), "text is no markup");
    assert!(out.join("report/gamma.svg").is_file() && out.join("report/gamma.csv").is_file());
    let json: Value = serde_json::from_slice(&run(&["--only", "gamma", "--json"]).stdout).unwrap();
    assert_eq!(json["chapters"][0]["parts"][2]["table"]["rows"].as_array().unwrap().len(), 26);
    let refused = run(&["--only", "gama"]);
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        refused.status.code() == Some(2) && message.contains("gama") && message.contains("gamma"),
        "{message}"
    );
}

#[test]
fn the_command_takes_a_project_or_the_table_and_one_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    for args in
        [&["report"][..], &["report", "a.json", "--stability"], &["report", "--stability", "--only", "time"]]
    {
        let run =
            Command::new(env!("CARGO_BIN_EXE_lightloom")).args(args).arg("--out").arg(&out).output().unwrap();
        assert_eq!(run.status.code(), Some(2), "{args:?}: {}", String::from_utf8_lossy(&run.stderr));
    }
    assert!(!out.exists());
}
