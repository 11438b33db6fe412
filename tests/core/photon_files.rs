//! Photon files read back: places, velocities, flux, lines.

use std::path::Path;

use lightloom_core::Progress;
use lightloom_core::engine::Engine;
use lightloom_core::export::PhotonFormat;
use lightloom_core::glam::{Vec3, vec3};
use lightloom_core::project::{AssetFolder, Project};

/// Three photons that go straight from frame 1 to frame 5 at 24 frames per second, and a line and a wall.
fn project(folder: &Path) -> (Project, std::path::PathBuf) {
    std::fs::write(folder.join("a.csv"), "0.2,0.2,1,0,0\n0.5,0.2,0,1,0\n0.8,0.2,0,0,1\n").unwrap();
    std::fs::write(folder.join("b.csv"), "0.2,0.6,1,0,0\n0.5,0.2,0,1,0\n0.9,0.8,0,0,1\n").unwrap();
    let text = r#"{
      "lightloom": 1, "name": "three \"photons\"", "method": "linear", "matching": "given",
      "keys": [ { "frame": 1, "shows": { "points": { "file": "a.csv" } }, "ease": "linear" },
                { "frame": 5, "shows": { "points": { "file": "b.csv" } } } ],
      "constraints": [
        { "type": "directed_line", "points": [[0.1, 0.1], [0.5, 0.3], [0.9, 0.1]], "width": 0.05 },
        { "type": "wall", "points": [[0.5, 0.5], [0.5, 0.9]], "thickness": 0.02, "span": { "from": 2, "to": 3 } } ],
      "output": { "frames": "0-6", "fps": [24, 1] }
    }"#;
    let place = folder.join("project.json");
    (Project::parse(text.as_bytes(), &place).unwrap(), place)
}

fn written(format: PhotonFormat) -> (tempfile::TempDir, Vec<String>) {
    let folder = tempfile::tempdir().unwrap();
    let (project, place) = project(folder.path());
    let out = folder.path().join("out");
    std::fs::create_dir(&out).unwrap();
    let engine = Engine::new(AssetFolder::new(&place, false).unwrap());
    let saved = std::sync::Mutex::new(Vec::new());
    let keep =
        |path: &Path| saved.lock().unwrap().push(path.file_name().unwrap().to_string_lossy().into_owned());
    engine.photons(&project, (&out, format), &Progress::new(), &keep).unwrap();
    let names = saved.lock().unwrap().clone();
    (folder, names)
}

/// The elements of a binary PLY of numbers of four bytes: for each its rows, a column being `float` or `int`.
fn read_ply(path: &Path) -> Vec<Vec<Vec<f64>>> {
    let bytes = std::fs::read(path).unwrap();
    let mark = b"end_header\n";
    let end = bytes.windows(mark.len()).position(|window| window == mark).unwrap() + mark.len();
    let head = std::str::from_utf8(&bytes[..end]).unwrap();
    let mut lines = head.lines();
    assert_eq!(lines.next(), Some("ply"));
    assert_eq!(lines.next(), Some("format binary_little_endian 1.0"));
    let mut elements: Vec<(usize, Vec<bool>)> = Vec::new();
    for line in lines {
        match line.split(' ').collect::<Vec<_>>()[..] {
            ["element", _, count] => elements.push((count.parse().unwrap(), Vec::new())),
            ["property", kind, _] => elements.last_mut().unwrap().1.push(kind == "float"),
            _ => (),
        }
    }
    let mut words = bytes[end..].chunks_exact(4).map(|word| <[u8; 4]>::try_from(word).unwrap());
    let mut value = |float: bool| match (float, words.next().unwrap()) {
        (true, word) => f64::from(f32::from_le_bytes(word)),
        (false, word) => f64::from(i32::from_le_bytes(word)),
    };
    let read = elements
        .iter()
        .map(|(count, columns)| (0..*count).map(|_| columns.iter().map(|c| value(*c)).collect()).collect());
    let read = read.collect();
    assert_eq!(words.next(), None, "no more bytes than the head tells of");
    read
}

fn vector(row: &[f64], first: usize) -> Vec3 {
    vec3(row[first] as f32, row[first + 1] as f32, row[first + 2] as f32)
}

#[test]
fn each_frame_of_ply_tells_places_velocities_and_flux() {
    let (folder, names) = written(PhotonFormat::Ply);
    let expected: Vec<String> = (0..=6).map(|frame| format!("photons.{frame:04}.ply")).collect();
    assert_eq!(names, [&expected[..], &["lines.ply".to_owned()]].concat());
    // The plane of a project without scene lies on the floor: (x, y) is (x, 0, -y). Four frames are a sixth of a second.
    let ways = [vec3(0.0, 0.0, -0.4), Vec3::ZERO, vec3(0.1, 0.0, -0.6)];
    let starts = [vec3(0.2, 0.0, -0.2), vec3(0.5, 0.0, -0.2), vec3(0.8, 0.0, -0.2)];
    for frame in 0..=6 {
        let [photons] = &read_ply(&folder.path().join(format!("out/photons.{frame:04}.ply")))[..] else {
            panic!("one element")
        };
        assert_eq!(photons.len(), 3);
        let share = (frame as f32 - 1.0).clamp(0.0, 4.0) / 4.0;
        let moves = (1..=5).contains(&frame);
        for (id, row) in photons.iter().enumerate() {
            assert_eq!(row[9], id as f64);
            // f32 positions near 1, and a difference of two of them over a 48th of a second.
            assert!(vector(row, 0).distance(starts[id] + share * ways[id]) < 1e-6, "{frame} {row:?}");
            let speed = if moves { 6.0 * ways[id] } else { Vec3::ZERO };
            assert!(vector(row, 3).distance(speed) < 1e-4, "{frame} {row:?}");
            let flux = vector(row, 6);
            assert!(flux[id] > 0.0 && (flux.element_sum() - flux[id]).abs() < 1e-9, "{row:?}");
        }
    }
}

#[test]
fn drawn_lines_are_edges_of_ply() {
    let (folder, _) = written(PhotonFormat::Ply);
    let [points, edges] = &read_ply(&folder.path().join("out/lines.ply"))[..] else { panic!("two elements") };
    assert_eq!(*edges, [[0.0, 1.0], [1.0, 2.0], [3.0, 4.0]]);
    assert!(vector(&points[1], 0).distance(vec3(0.5, 0.0, -0.3)) < 1e-6);
    // Twice the reach of the line, and the thickness of the wall.
    assert_eq!([points[0][3] as f32, points[3][3] as f32], [0.1, 0.02]);
    assert_eq!([points[2][7], points[3][7]], [0.0, 1.0]);
}

#[test]
fn usd_has_a_sample_of_each_attribute_for_each_frame() {
    let (folder, names) = written(PhotonFormat::Usda);
    assert_eq!(names, ["photons.usda"]);
    let text = std::fs::read_to_string(folder.path().join("out/photons.usda")).unwrap();
    assert!(text.starts_with("#usda 1.0\n"));
    for (open, close) in [('{', '}'), ('(', ')'), ('[', ']')] {
        assert_eq!(text.matches(open).count(), text.matches(close).count(), "{open}");
    }
    // The quotes of the name are left out.
    assert_eq!(text.matches('"').count() % 2, 0);
    assert!(text.contains("doc = \"three photons: "), "{}", &text[..200]);
    for attribute in ["extent", "points", "velocities", "primvars:flux", "primvars:displayColor"] {
        let (_, samples) = text.split_once(&format!("{attribute}.timeSamples = {{\n")).unwrap();
        let samples: Vec<_> = samples.lines().take_while(|line| line.trim() != "}").collect();
        let frames: Vec<_> = samples.iter().map(|line| line.trim().split_once(':').unwrap().0).collect();
        assert_eq!(frames, ["0", "1", "2", "3", "4", "5", "6"], "{attribute}");
        let of_each = if attribute == "extent" { 2 } else { 3 };
        assert!(samples.iter().all(|line| line.matches('(').count() == of_each), "{attribute}");
    }
    assert!(text.contains("3: [(0.2, 0, -0.4"), "half way the first photon is at y = 0.4");
    assert!(
        text.contains("def BasisCurves \"directed_line_1\"")
            && text.contains("int[] curveVertexCounts = [3]")
    );
    let wall = text.split_once("def BasisCurves \"wall_2\"").unwrap().1;
    assert!(
        wall.contains("visibility.timeSamples = { 1: \"invisible\", 2: \"inherited\", 4: \"invisible\" }")
    );
}
