//! `lightloom import` with a picture.

use std::fs;
use std::path::Path;

use lightloom_core::project::{Project, Shows};

use crate::small::lightloom;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn an_import_with_a_picture_lays_it_on_the_caustic() {
    let dir = tempfile::tempdir().unwrap();
    let import = |picture: &str, into: &Path| {
        lightloom(&["import", "assets/meshes/goblet.obj", "--picture", picture, "--into", text(into)])
    };
    let shot = dir.path().join("shot");
    let done = import("assets/targets/star.png", &shot);
    assert!(done.status.success(), "{done:?}");
    let project = Project::load(&shot.join("goblet.json")).unwrap();
    let Shows::Image(image) = &project.keys[1].shows else { panic!("{:?}", project.keys[1].shows) };
    assert_eq!(image.file, "star.png");
    assert!(shot.join("star.png").is_file());
    // By itself it would fill the table.
    assert!(image.placement.width.is_some_and(|width| (0.1..0.8).contains(&width)), "{:?}", image.placement);
    // What cannot be used is refused before anything is written.
    let (empty, other) = (dir.path().join("empty.png"), dir.path().join("other"));
    fs::write(&empty, "no picture").unwrap();
    let failed = import(text(&empty), &other);
    let error = String::from_utf8_lossy(&failed.stderr);
    assert_eq!(failed.status.code(), Some(3), "{error}");
    assert!(error.contains("empty.png") && !other.exists(), "{error}");
}
