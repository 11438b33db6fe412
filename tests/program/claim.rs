//! Several processes that share the frames of one folder.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use crate::small::{letters, lightloom};

/// The command that makes the frames of a project in a folder, with more options.
fn command(project: &Path, out: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lightloom"));
    command.arg("render").arg(project).arg("--out").arg(out).args(more);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// All that a process said.
fn said(output: Output) -> String {
    assert!(output.status.success());
    [output.stdout, output.stderr].map(|said| String::from_utf8(said).unwrap()).concat()
}

/// The files in a folder by name with their bytes, but for what only a render of all leaves.
fn frames(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let named = |entry: fs::DirEntry| entry.file_name().into_string().unwrap();
    let names = fs::read_dir(folder).unwrap().map(|entry| named(entry.unwrap()));
    let of_all = ["summary.json", "contact_sheet.png"];
    let mut names: Vec<_> = names.filter(|name| !of_all.contains(&name.as_str())).collect();
    names.sort();
    names.into_iter().map(|name| (name.clone(), fs::read(folder.join(name)).unwrap())).collect()
}

#[test]
fn processes_that_share_a_folder_make_each_frame_once_with_the_bytes_of_one() {
    let (folder, project) = letters("flow");
    let [alone, shared] = ["alone", "shared"].map(|name| folder.path().join(name));
    said(command(&project, &alone, &[]).output().unwrap());
    fs::create_dir(&shared).unwrap();
    // What a process left that died on this machine: nobody holds it.
    let host = gethostname::gethostname().into_string().unwrap();
    let dead = format!("{{\"host\":\"{host}\",\"process\":1}}");
    fs::write(shared.join(".frame_____.3-4.claim.lock"), dead).unwrap();
    // Another process works at frames 7 and 8.
    let held = fs::File::create(shared.join(".frame_____.7-8.claim.lock")).unwrap();
    held.lock().unwrap();

    let start = || command(&project, &shared, &["--claim", "2"]).spawn().unwrap();
    let processes = [start(), start(), start()];
    let all = processes.map(|process| said(process.wait_with_output().unwrap())).concat();
    for frame in 1..=9 {
        let saved = all.matches(&format!("frame.{frame:04}.png")).count();
        assert_eq!(saved, usize::from(![7, 8].contains(&frame)), "frame {frame}: {all}");
    }
    drop(held);
    let last = said(command(&project, &shared, &["--claim", "2"]).output().unwrap());
    assert!(last.contains("2 of 9 frames were made here; all are there"), "{last}");
    assert!(frames(&shared) == frames(&alone), "other files than of one process");
    assert!(lightloom(&["verify", shared.to_str().unwrap(), "--frames", "1-9"]).status.success());
}
