//! Renders that are cut off, meet the frames of others, or are done in parts.

use std::fs;
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::small::{letters, lightloom, make_small};
use crate::window;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Runs the program, which must end with `code`; what it printed, and what it complained of.
fn run(code: i32, args: &[&str]) -> String {
    let output = lightloom(args);
    let said = [output.stdout, output.stderr].map(|said| String::from_utf8(said).unwrap()).concat();
    assert_eq!(output.status.code(), Some(code), "{args:?}: {said}");
    said
}

/// The files of a folder but the summary, which holds seconds, by name with their bytes.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let named = |entry: fs::DirEntry| entry.file_name().into_string().unwrap();
    let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
    let mut names: Vec<_> = entries.map(named).filter(|name| name != "summary.json").collect();
    names.sort();
    names.into_iter().map(|name| (name.clone(), fs::read(folder.join(name)).unwrap_or_default())).collect()
}

/// The folders of unfinished light in a folder.
fn unfinished(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.filter(|path| path.file_name().unwrap().to_str().unwrap().starts_with("unfinished-")).collect()
}

/// Starts the program, and sends it a signal when it tells of so many per cent.
fn cut_off(args: &[&str], percent: u32, signal: &str) -> Option<i32> {
    let mut program =
        Command::new(env!("CARGO_BIN_EXE_lightloom")).args(args).stdout(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(program.stdout.take().unwrap()).lines();
    let far = |line: &String| {
        line.strip_prefix("Progress: ")
            .is_some_and(|done| done.trim_end_matches('%').parse::<u32>().unwrap() >= percent)
    };
    lines.by_ref().map_while(Result::ok).find(far).expect("it must not end before");
    assert!(Command::new("kill").args([signal, &program.id().to_string()]).status().unwrap().success());
    lines.for_each(drop);
    program.wait().unwrap().code()
}

#[cfg(unix)]
#[test]
fn a_render_that_is_killed_again_and_again_ends_with_the_bytes_of_one_left_alone() {
    let (folder, project) = letters("flow");
    let args = |out: &'static str| {
        let out = folder.path().join(out).to_str().unwrap().to_owned();
        ["render", text(&project), "--out", &out, "--passes", "160"].map(ToOwned::to_owned)
    };
    let (alone, cut) = (args("alone"), args("cut"));
    let [alone, cut] = [&alone, &cut].map(|args| args.each_ref().map(String::as_str));
    run(0, &alone);
    let out = folder.path().join("cut");
    for percent in [5, 20, 40, 60, 75] {
        assert_eq!(cut_off(&cut, percent, "-KILL"), None);
        assert_eq!(unfinished(&out).len(), 1);
    }
    // Frames at the quality reached say that they are unfinished, and are finished by the next run.
    assert_eq!(cut_off(&cut, 85, "-TERM"), Some(143));
    let said = run(0, &["info", text(&out.join("frame.0005.exr"))]);
    assert!(said.contains("passes_planned: 160") && !said.contains("  passes: 160"), "{said}");
    assert!(run(4, &["verify", text(&out)]).contains("unfinished"));
    let said = run(0, &cut);
    assert!(said.contains("taken up after"), "{said}");
    assert!(files(&out) == files(&folder.path().join("alone")), "other bytes than of a render left alone");
    assert!(run(0, &["verify", text(&out), "--frames", "1-9"]).contains("made from the same"));
}

#[test]
fn frames_of_another_render_are_refused_replaced_or_kept_as_asked() {
    let (folder, project) = letters("flow");
    let out = folder.path().join("out");
    let render = |code, extra: &[&str]| {
        let all = [&["render", text(&project), "--out", text(&out), "--frames", "1-9x4"], extra].concat();
        run(code, &all)
    };
    render(0, &[]);
    let first = files(&out);
    // The same again is kept, and costs nothing.
    assert!(render(0, &[]).contains("kept: 6 files"));
    let said = render(2, &["--seed", "2"]);
    assert!(
        said.contains("frame.0001.exr") && said.contains("--overwrite") && said.contains("--skip"),
        "{said}"
    );
    assert!(files(&out) == first, "a refused render changes nothing");
    fs::remove_file(out.join("frame.0005.png")).unwrap();
    render(0, &["--seed", "2", "--skip"]);
    let names = |files: &[(String, Vec<u8>)]| files.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    let mixed = files(&out);
    assert_eq!(names(&mixed), names(&first));
    let changed: Vec<_> = mixed.iter().zip(&first).filter(|(a, b)| a != b).map(|(a, _)| &*a.0).collect();
    assert_eq!(changed, ["frame.0005.png"]);
    assert!(run(4, &["verify", text(&out), "--frames", "1-9x4"]).contains("different things"));
    render(0, &["--seed", "2", "--overwrite"]);
    assert!(files(&out).iter().zip(&first).all(|(a, b)| a.1 != b.1), "all files are replaced");
    // A frame that was cut off is one of another; a gap is told.
    let bytes = fs::read(out.join("frame.0009.exr")).unwrap();
    fs::write(out.join("frame.0009.exr"), &bytes[..bytes.len() / 2]).unwrap();
    fs::remove_file(out.join("frame.0001.png")).unwrap();
    let said = run(4, &["verify", text(&out), "--frames", "1-9x4"]);
    assert!(said.contains("frame.0009.exr") && said.contains("missing of frame.#.png: 1\n"), "{said}");
}

#[test]
fn parts_that_start_from_a_bake_have_the_bytes_of_one_render() {
    let (letters_folder, letters) = letters("guided");
    let examples = window::examples();
    let [glass, bottles] = ["dark_glass", "bottles"].map(|name| {
        let path = window::project(&examples, name);
        make_small(&path, 2);
        path
    });
    let small = ["--size", "32x24", "--photons", "3000", "--passes", "2", "--frames"];
    for (name, project) in [("letters", &letters), ("glass", &glass), ("bottles", &bottles)] {
        let place = |part: &str| letters_folder.path().join(format!("{name}_{part}"));
        let (whole, parts, bake) = (place("whole"), place("parts"), place("bake"));
        let with = |head: &[&str], frames: &str| {
            let all = [head, &small, &[frames]].concat();
            run(0, &all)
        };
        let project = text(project);
        with(&["render", project, "--out", text(&whole)], "1,4,8-9");
        with(&["fit", project, "--bake", text(&bake)], "1");
        for frames in ["8-9", "4", "1"] {
            with(&["render", project, "--out", text(&parts), "--bake", text(&bake)], frames);
        }
        assert!(!parts.join("summary.json").exists(), "a part has no summary of all");
        let sheet = |files: Vec<(String, Vec<u8>)>| -> Vec<_> {
            files.into_iter().filter(|(name, _)| name != "contact_sheet.png").collect()
        };
        assert!(sheet(files(&whole)) == files(&parts), "{name}: parts have other bytes than the whole");
        run(0, &["sheet", text(&parts)]);
        assert!(
            files(&whole) == files(&parts),
            "{name}: the sheet of the files has other bytes than that of the render"
        );
        run(0, &["verify", text(&parts), "--bake", text(&bake), "--frames", "1,4,8-9"]);
        let other =
            ["render", project, "--out", text(&parts), "--bake", text(&bake), "--frames", "1", "--seed", "9"];
        assert!(
            run(2, &[&other[..], &small[..6]].concat()).contains("another content, size, quality or seed")
        );
    }
}

#[test]
fn progress_is_told_as_farms_read_it_and_jobs_are_written_for_them() {
    let (folder, project) = letters("flow");
    let render = |name: &str, manner: &str| {
        let out = folder.path().join(name);
        run(0, &["render", text(&project), "--out", text(&out), "--progress", manner])
    };
    let openjd = render("openjd", "openjd");
    assert!(openjd.contains("openjd_progress: ") && openjd.contains("openjd_status: "), "{openjd}");
    let json = render("json", "json");
    let lines: Vec<Value> = json.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
    assert!(
        lines.iter().any(|line| line["progress"].is_number() && line["seconds_left"].is_number()),
        "{json}"
    );
    assert!(
        lines.iter().any(|line| line["saved"].as_str().is_some_and(|file| file.ends_with(".exr"))),
        "{json}"
    );
    let farm = |kind: &str, more: &[&str]| {
        let out = folder.path().join(format!("farm_{kind}"));
        let head =
            ["farm", text(&project), "--as", kind, "--out", text(&out), "--chunk", "4", "--passes", "3"];
        run(0, &[&head, more].concat());
        out
    };
    let slurm = farm("slurm", &[]);
    assert_eq!(fs::read_to_string(slurm.join("chunks.txt")).unwrap(), "1-4\n5-8\n9\n");
    assert!(fs::read_to_string(slurm.join("submit.sh")).unwrap().contains("--array=1-3"));
    assert!(fs::read_to_string(slurm.join("render.sbatch")).unwrap().contains("'--passes' '3'"));
    let job: Value =
        serde_json::from_slice(&fs::read(farm("openjd", &[]).join("job.json")).unwrap()).unwrap();
    let range = &job["steps"][1]["parameterSpace"]["taskParameterDefinitions"][0]["range"];
    assert_eq!(range, &serde_json::json!(["1-4", "5-8", "9"]));
}
