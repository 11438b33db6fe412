//! The command line as a farm or a script meets it.

use std::fs;
use std::path::Path;
use std::process::Command;

use glam::Vec2;
use lightloom_core::Progress;
use lightloom_core::export::load_fields;
use lightloom_core::files::npy;
use lightloom_core::files::npz::NpzReader;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::small::{letters, lightloom};

/// Runs the program, which must succeed, and returns what it printed.
fn run(args: &[&str]) -> String {
    let output = lightloom(args);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{args:?}: {text}{}", String::from_utf8_lossy(&output.stderr));
    text
}

/// Runs the program, which must fail with `code` and say what is wrong on one line.
fn fail(code: i32, args: &[&str]) -> String {
    let output = lightloom(args);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{args:?}: {message}");
    assert!(!message.contains("panicked"), "{message}");
    message
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn frames_of(dir: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn render_writes_every_frame_a_contact_sheet_and_a_summary() {
    let (folder, project) = letters("flow");
    let out = folder.path().join("out");
    let printed = run(&["render", text(&project), "--out", text(&out), "--frames", "1-9x4"]);
    let expected = [
        "contact_sheet.png",
        "frame.0001.exr",
        "frame.0001.png",
        "frame.0005.exr",
        "frame.0005.png",
        "frame.0009.exr",
        "frame.0009.png",
        "summary.json",
    ];
    assert_eq!(frames_of(&out), expected);
    assert!(printed.contains("Progress: ") && printed.contains("Saved: '"), "{printed}");

    let summary: Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    for name in [
        "endpoint_error",
        "transport_cost",
        "gap",
        "crossing_index",
        "fit_residual",
        "solver_error",
        "solver_iterations",
        "unknowns",
        "divergence_rms",
        "curl_rms",
        "flux_ratio",
        "peak_speed_ratio",
        "dispersion",
        "stages",
        "left_out",
    ] {
        assert!(!summary[name].is_null(), "no {name} in {summary}");
    }
    assert!(summary["endpoint_error"].as_f64().unwrap() < 1e-6);
    let continuity = &summary["continuity"][0];
    assert_eq!(continuity["frames"], json!([1, 9]));
    for name in
        ["cracks", "torn_source", "torn_target", "torn_target_late", "bunch", "fastest", "fastest_999"]
    {
        assert!(continuity[name].as_f64().is_some_and(|figure| figure >= 0.0), "no {name} in {summary}");
    }
    assert!((summary["flux_ratio"].as_f64().unwrap() - 1.0).abs() < 1e-6);
    assert!(
        summary["stages"].as_array().unwrap().iter().all(|stage| stage["seconds"].as_f64().unwrap() >= 0.0)
    );
}

#[test]
fn the_same_seed_gives_the_same_bytes_for_any_threads_and_any_choice_of_frames() {
    let (folder, project) = letters("flow");
    let render = |name: &str, extra: &[&str]| {
        let out = folder.path().join(name);
        run(&[&["render", text(&project), "--out", text(&out)], extra].concat());
        ["exr", "png"].map(|kind| fs::read(out.join(format!("frame.0004.{kind}"))).unwrap())
    };
    let full = render("two", &["--threads", "2"]);
    assert!(full == render("one", &["--threads", "1"]), "threads change the bytes");
    assert!(
        full == render("alone", &["--frames", "4"]),
        "a frame alone differs from the same frame of a run"
    );
    assert!(full != render("seed", &["--seed", "2"]), "the seed changes nothing");
}

#[test]
fn fit_writes_tracks_flux_and_fields_of_the_promised_shapes() {
    let (folder, project) = letters("flow");
    let out = folder.path().join("fit");
    run(&["fit", text(&project), "--out", text(&out)]);
    assert_eq!(frames_of(&out), ["fields.npz", "flux.npy", "summary.json", "tracks.npy"]);
    let read = |name: &str| npy::parse(&fs::read(out.join(name)).unwrap()).unwrap();
    let photons = 4000;
    let ((of_tracks, tracks), (of_flux, flux)) = (read("tracks.npy"), read("flux.npy"));
    assert_eq!(of_tracks.shape, [9, photons, 2]);
    assert_eq!(of_flux.shape, [9, photons, 3]);
    assert!(tracks.iter().all(|c| c.is_finite()));
    let totals: Vec<f64> =
        flux.chunks(3 * photons as usize).map(|step| step.iter().map(|f| f64::from(*f)).sum()).collect();
    // 12 000 f32 values around 1e-5 each: their rounding is far below 1e-6 of the sum.
    assert!(totals.iter().all(|total| (total / totals[0] - 1.0).abs() < 1e-6), "{totals:?}");
}

#[test]
fn fields_that_are_read_back_carry_the_photons_of_the_tracks() {
    let swirls = r#""turbulence":{"strength":20,"grids":[20,30],"rate":2.5},"grid":32"#;
    for method in ["flow", "guided"] {
        let (folder, project) = letters(method);
        let plain = fs::read_to_string(&project).unwrap();
        for text_of in [&plain, &plain.replace("\"grid\":32", swirls)] {
            fs::write(&project, text_of).unwrap();
            let out = folder.path().join("fit");
            run(&["fit", text(&project), "--out", text(&out)]);
            let (_, tracks) = npy::parse(&fs::read(out.join("tracks.npy")).unwrap()).unwrap();
            let rows: Vec<Vec<Vec2>> =
                tracks.chunks(8000).map(|row| row.chunks(2).map(Vec2::from_slice).collect()).collect();
            let segments = load_fields(&out.join("fields.npz")).unwrap();
            assert!(matches!(segments[..], [ref only] if (only.segment, only.caustic) == (0, None)));
            let mut carrier = segments[0].flow.trajectories(&rows[0], &rows[8], &[], None);
            let mut positions = vec![Vec2::ZERO; 4000];
            for (step, wanted) in rows.iter().enumerate() {
                carrier.positions_at(step as f64 / 8.0, &mut positions, &Progress::new()).unwrap();
                assert_eq!(&positions, wanted, "{method}, step {step}");
            }
        }
    }
}

#[test]
fn fields_fitted_between_walls_are_read_back_without_the_walls() {
    let (folder, project) = letters("flow");
    let mut drawn: Value = serde_json::from_str(&fs::read_to_string(&project).unwrap()).unwrap();
    drawn["constraints"] = json!([{ "type": "wall", "points": [[0.45, 0.4], [0.55, 0.6]] }]);
    fs::write(&project, drawn.to_string()).unwrap();
    run(&["fit", text(&project), "--out", text(folder.path())]);
    let (header, tracks) = npy::parse(&fs::read(folder.path().join("tracks.npy")).unwrap()).unwrap();
    assert_eq!(header.shape, [33, 4000, 2]);
    let [first, last] = [0, 32].map(|step| -> Vec<Vec2> {
        tracks[8000 * step..8000 * (step + 1)].chunks(2).map(Vec2::from_slice).collect()
    });
    let segments = load_fields(&folder.path().join("fields.npz")).unwrap();
    assert_eq!(segments[0].flow.steps(), Some(8));
    let mut carrier = segments[0].flow.trajectories(&first, &last, &[], None);
    let mut positions = vec![Vec2::ZERO; 4000];
    carrier.positions_at(1.0, &mut positions, &Progress::new()).unwrap();
    assert_eq!(positions, last);
}

#[test]
fn check_says_what_is_left_out_and_what_it_would_cost() {
    let (_folder, project) = letters("flow");
    let printed = run(&["check", text(&project)]);
    for word in ["left out", "tracing", "memory", "seconds"] {
        assert!(printed.contains(word), "no '{word}' in {printed}");
    }
    let json: Value = serde_json::from_str(&run(&["check", text(&project), "--json"])).unwrap();
    assert!(json["left_out"].as_array().unwrap().len() >= 2, "{json}");
}

#[test]
fn check_notes_a_stretched_grid() {
    let (_folder, project) = letters("flow");
    let text_of = fs::read_to_string(&project).unwrap();
    fs::write(&project, text_of.replace("\"grid\":32", "\"grid\":[4096,8]")).unwrap();
    assert!(run(&["check", text(&project)]).contains("stretched 512 : 1"));
}

#[test]
fn turbulence_is_left_out_or_told_of_and_exported() {
    let (folder, project) = letters("flow");
    let none = run(&["check", text(&project)]);
    assert!(none.contains("left out: turbulence") && !none.contains("note"), "{none}");
    let text_of = fs::read_to_string(&project).unwrap();
    let turbulent =
        text_of.replace("\"grid\":32", r#""turbulence":{"strength":20,"grids":[100,30]},"grid":32"#);
    fs::write(&project, turbulent).unwrap();
    let some = run(&["check", text(&project)]);
    // 0.2 times 100 cells in 8 steps.
    assert!(!some.contains("left out: turbulence") && some.contains("give flow.steps 20"), "{some}");

    let out = folder.path().join("out");
    run(&["fit", text(&project), "--out", text(&out)]);
    let fields = fs::read(out.join("fields.npz")).unwrap();
    let (noise, _) = NpzReader::new(&fields).unwrap().array("noise_0_30").unwrap().unwrap();
    // Of 8 steps the fade needs 8 fits; 30 cells have 33 coefficients.
    assert_eq!(noise.shape, [8, 33, 33]);
    let summary: Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert!((summary["turbulence_rms"].as_f64().unwrap() - 0.2).abs() < 1e-6);
}

#[test]
fn schema_is_json_and_knows_the_fields() {
    let schema: Value = serde_json::from_str(&run(&["schema"])).unwrap();
    assert!(schema["properties"]["keys"].is_object());
}

#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_printed_is_a_failure() {
    let (_folder, project) = letters("flow");
    for args in [vec!["schema"], vec!["check", text(&project)]] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_lightloom")).args(&args).stdout(full).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(5), "{args:?}: {said}");
        assert!(said.contains("standard output"), "{said}");
    }
}

#[cfg(unix)]
#[test]
fn sigterm_keeps_the_frames_as_ctrl_c_does() {
    use std::io::{BufRead as _, BufReader};
    for (signal, code) in [("-TERM", 143), ("-INT", 130)] {
        let (folder, project) = letters("flow");
        let out = folder.path().join("out");
        let mut program = Command::new(env!("CARGO_BIN_EXE_lightloom"))
            // More passes than anybody waits for.
            .args(["render", text(&project), "--out", text(&out), "--passes", "6000"])
            .stdout(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(program.stdout.take().unwrap()).lines();
        // The stages before the passes are short: with one per cent done, passes have begun.
        lines.by_ref().map_while(Result::ok).find(|line| line.starts_with("Progress: 1%")).unwrap();
        let killed = Command::new("kill").args([signal, &program.id().to_string()]).status().unwrap();
        assert!(killed.success());
        lines.for_each(drop);
        assert_eq!(program.wait().unwrap().code(), Some(code));
        assert!(!frames_of(&out).is_empty(), "{signal}: frames of the quality reached");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_screen_the_program_says_so_and_names_the_way_without() {
    for display in [None, Some(":987")] {
        let mut program = Command::new(env!("CARGO_BIN_EXE_lightloom"));
        program.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
        display.map(|display| program.env("DISPLAY", display));
        let output = program.output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains("screen") && said.contains("lightloom render PROJECT"), "{said}");
        assert!(!said.contains(".rs:") && said.lines().count() == 1, "{said}");
    }
}

/// The limit leaves no room for the stacks of so many threads, which are large: the next one is refused while there is room for all else
/// that those before need.
#[cfg(target_os = "linux")]
#[test]
fn what_the_system_refuses_for_now_has_an_exit_code_of_its_own() {
    let (_folder, project) = letters("flow");
    let program = env!("CARGO_BIN_EXE_lightloom");
    let command = format!("ulimit -v 1500000; exec '{program}' check '{}' --threads 1024", text(&project));
    let output =
        Command::new("sh").env("RUST_MIN_STACK", "300000000").args(["-c", &command]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(75), "{said}");
    assert!(said.contains("threads"), "{said}");
}

#[test]
fn exit_codes_tell_causes_apart() {
    let (folder, project) = letters("flow");
    let out = folder.path().join("out");
    let render = |project: &Path, extra: &[&str]| {
        [&["render", text(project), "--out", text(&out)], extra]
            .concat()
            .iter()
            .map(|s| s.to_string())
            .collect::<Vec<_>>()
    };
    let code =
        |code: i32, args: Vec<String>| fail(code, &args.iter().map(String::as_str).collect::<Vec<_>>());
    code(2, vec!["render".into()]);
    assert!(code(2, render(&project, &["--frames", "9-1"])).contains("--frames"));
    assert!(code(2, render(&project, &["--size", "big"])).contains("--size"));
    assert!(code(2, render(&project, &["--format", "bmp"])).contains("--format"));
    assert!(code(2, render(&project, &["--photons", "0"])).contains("--photons"));
    assert!(code(3, render(&folder.path().join("none.json"), &[])).contains("none.json"));
    fs::remove_file(folder.path().join("letter_s.png")).unwrap();
    assert!(code(3, render(&project, &[])).contains("letter_s.png"));
    assert!(!out.join("frame.0001.png").exists(), "a bad project must not leave frames");
}

#[test]
fn an_output_folder_that_cannot_be_written_is_refused_before_the_work() {
    let (folder, project) = letters("flow");
    let file = folder.path().join("taken");
    fs::write(&file, b"mine").unwrap();
    let message = fail(2, &["render", text(&project), "--out", text(&file)]);
    assert!(message.contains("taken"), "{message}");
    let below = file.join("out");
    let message = fail(5, &["render", text(&project), "--out", text(&below)]);
    assert!(message.contains("taken"), "{message}");
    assert_eq!(fs::read(&file).unwrap(), b"mine");
}

#[test]
fn a_run_never_overwrites_what_it_is_made_from() {
    let (folder, project) = letters("flow");
    let own = folder.path().join("summary.json");
    fs::rename(&project, &own).unwrap();
    let before = fs::read(&own).unwrap();
    for command in ["render", "fit"] {
        let message = fail(2, &[command, text(&own), "--out", text(folder.path())]);
        assert!(message.contains("summary.json"), "{message}");
    }
    assert_eq!(fs::read(&own).unwrap(), before);

    fs::rename(folder.path().join("letter_c.png"), folder.path().join("frame.0001.png")).unwrap();
    let renamed = String::from_utf8(before).unwrap().replace("letter_c.png", "frame.0001.png");
    fs::write(&project, renamed).unwrap();
    let message = fail(2, &["render", text(&project), "--out", text(folder.path())]);
    assert!(message.contains("frame.0001.png"), "{message}");
}

#[test]
fn with_json_the_output_is_json_and_nothing_else() {
    let (folder, project) = letters("flow");
    let out = folder.path().join("out");
    let printed = run(&["fit", text(&project), "--out", text(&out), "--json", "--photons", "500"]);
    let summary: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(summary["photons"], 500);
}

#[test]
fn what_is_asked_for_by_name_outweighs_the_quality() {
    let (folder, project) = letters("flow");
    let out = folder.path().join("out");
    let extra = ["--quality", "preview", "--passes", "3", "--frames", "5", "--format", "png", "--json"];
    let printed = run(&[&["render", text(&project), "--out", text(&out)], &extra[..]].concat());
    let summary: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!((&summary["passes"], &summary["frames"]), (&json!(3), &json!(1)));
}

#[test]
fn work_that_does_not_fit_into_memory_is_refused_beforehand() {
    let (folder, project) = letters("flow");
    let out = folder.path().join("out");
    let huge = ["--size", "16384x16384", "--photons", "100000000"];
    let message = fail(6, &[&["render", text(&project), "--out", text(&out)], &huge[..]].concat());
    assert!(message.contains("GiB"), "{message}");
}

#[test]
fn rows_of_two_point_files_are_paired_as_given() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.csv"), "x,y\n0.2,0.2\n0.8,0.2\n0.5,0.8\n").unwrap();
    fs::write(folder.path().join("b.csv"), "x,y\n0.8,0.3\n0.2,0.3\n0.5,0.1\n").unwrap();
    let key = |frame: i32, file: &str| json!({ "frame": frame, "shows": { "points": { "file": file } } });
    let project = |matching: &str| {
        let path = folder.path().join(format!("{matching}.json"));
        let keys = [key(1, "a.csv"), key(5, "b.csv")];
        let flow = json!({ "grid": 16, "steps": 4 });
        let text = json!({ "lightloom": 1, "keys": keys, "matching": matching, "flow": flow }).to_string();
        fs::write(&path, text).unwrap();
        path
    };
    let ends = |matching: &str| {
        let out = folder.path().join(matching);
        run(&["fit", text(&project(matching)), "--out", text(&out), "--photons", "3"]);
        let (header, tracks) = npy::parse(&fs::read(out.join("tracks.npy")).unwrap()).unwrap();
        assert_eq!(header.shape, [5, 3, 2]);
        tracks[24..].to_vec()
    };
    assert_eq!(ends("given"), [0.8, 0.3, 0.2, 0.3, 0.5, 0.1]);
    // The optimal pairing crosses nothing: left stays left.
    assert_ne!(ends("transport"), ends("given"));

    fs::write(folder.path().join("b.csv"), "0.8,0.3\n0.2,0.3\n").unwrap();
    let out = folder.path().join("out");
    let message = fail(3, &["fit", text(&project("given")), "--out", text(&out)]);
    assert!(message.contains("keys[1].shows.points.file") && message.contains('3'), "{message}");
}

#[test]
fn one_photon_runs() {
    let (folder, project) = letters("flow");
    let out = folder.path().join("out");
    run(&[
        "render",
        text(&project),
        "--out",
        text(&out),
        "--photons",
        "1",
        "--frames",
        "5",
        "--format",
        "png",
    ]);
    assert!(out.join("frame.0005.png").exists());
}

#[test]
fn figures_prints_a_row_for_each_project_method_and_gamma() {
    let (_folder, project) = letters("flow");
    let printed =
        run(&["figures", text(&project), text(&project), "--method", "flow,linear", "--gamma", "0,1"]);
    let rows: Vec<&str> = printed.lines().skip(2).collect();
    let named = |row: &str| row.split('|').nth(1).unwrap().trim().to_owned();
    let of_one = ["flow, gamma 0, 1-9", "flow, gamma 1, 1-9", "linear, 1-9"]
        .map(|row| format!("Small letters, {row}"));
    assert_eq!(rows.iter().map(|row| named(row)).collect::<Vec<_>>(), [&of_one[..], &of_one[..]].concat());
    assert_eq!(rows[0], rows[3], "the same project has the same figures");
    let json: Value = serde_json::from_str(&run(&["figures", text(&project), "--json"])).unwrap();
    assert_eq!(json[0]["name"], "Small letters, 1-9");
    assert!(json[0]["cracks"].as_f64().is_some());
    assert!(
        fail(2, &["figures", text(&project), "--method", "magic"]).contains("flow,guided,stylized,linear")
    );
    assert!(fail(2, &["figures", text(&project), "--gamma", "7"]).contains("--gamma"));
}

/// A folder with a program `ffmpeg` that knows libx264, notes its arguments, and copies its input to its last argument.
#[cfg(unix)]
fn pretended_ffmpeg() -> TempDir {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = tempfile::tempdir().unwrap();
    let script = "#!/bin/sh\ncase \"$*\" in *-encoders*) echo ' V..... libx264'; exit 0;; esac\n\
        for last; do :; done\necho \"$*\" > \"$(dirname \"$0\")/arguments\"\ncat > \"$last\"\n";
    let path = folder.path().join("ffmpeg");
    fs::write(&path, script).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    folder
}

#[cfg(unix)]
#[test]
fn a_film_goes_through_ffmpeg_at_the_pace_of_the_project() {
    let (folder, project) = letters("flow");
    let (ffmpeg, out) = (pretended_ffmpeg(), folder.path().join("out"));
    let film = folder.path().join("films/shot.mp4");
    let path = format!("{}:/usr/bin:/bin", ffmpeg.path().display());
    let mut command = Command::new(env!("CARGO_BIN_EXE_lightloom"));
    command.args(["render", project.to_str().unwrap(), "--format", "png", "--frames", "1-9x4"]);
    let done = command.arg("--out").arg(&out).arg("--film").arg(&film).env("PATH", path).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    // Frames 1, 5 and 9, each for four frames, of 96 x 96 pixels and three bytes.
    assert_eq!(fs::metadata(&film).unwrap().len(), 12 * 96 * 96 * 3);
    let arguments = fs::read_to_string(ffmpeg.path().join("arguments")).unwrap();
    assert!(arguments.contains("-framerate 24/1") && arguments.contains("-video_size 96x96"), "{arguments}");
    let left: Vec<_> = film.parent().unwrap().read_dir().unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left, ["shot.mp4"], "no temporary file");
}

#[cfg(unix)]
#[test]
fn a_film_that_cannot_be_written_is_refused_before_the_work_begins() {
    let (folder, project) = letters("flow");
    let out = folder.path().join("out");
    let render = |film: &Path| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lightloom"));
        command.args(["render", project.to_str().unwrap()]).arg("--out").arg(&out).arg("--film").arg(film);
        let done = command.env("PATH", folder.path()).output().unwrap();
        assert_eq!(done.status.code(), Some(2));
        assert!(!out.join("frame.0001.png").exists());
        String::from_utf8_lossy(&done.stderr).into_owned()
    };
    let said = render(&folder.path().join("shot.mp4"));
    assert!(said.contains("--film") && said.contains("install it") && said.contains(".gif"), "{said}");
    assert!(render(&folder.path().join("shot.mov")).contains(".mp4"));
    assert!(render(&folder.path().join("out")).contains(".gif"));
    // An animated PNG, but the picture that the project shows.
    let said = render(&folder.path().join("letter_c.png"));
    assert!(said.contains("would be overwritten"), "{said}");
}
