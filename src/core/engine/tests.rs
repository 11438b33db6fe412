//! A panic in any stage of a render: one failure, after which the same engine renders the same bytes.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use super::{Engine, Summary};
use crate::flow::GridSize;
use crate::project::{AssetFolder, Project};
use crate::{Progress, Result};

/// The files of a folder and what is in them.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
    entries.map(|path| (name(&path), std::fs::read(&path).unwrap())).collect()
}

#[test]
fn a_panic_in_any_stage_is_one_failure_and_the_next_run_ends_with_the_bytes_of_one_left_alone() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../projects/dark_glass.json");
    let mut project = Project::load(&file).unwrap();
    (project.render.width, project.render.height) = (32, 18);
    (project.render.photons, project.render.passes) = (2000, 2);
    (project.render.camera_samples, project.render.background_samples) = (2, 2);
    project.flow.grid = GridSize::Longer(16);
    project.keys[1].frame = project.keys[0].frame + 2;
    project.output.frames = None;
    let folder = tempfile::tempdir().unwrap();
    // As an export does: the render has threads of its own.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let render = |engine: &Engine, name: &str, progress: &Progress| -> std::thread::Result<Result<Summary>> {
        let out = folder.path().join(name);
        std::fs::create_dir_all(&out).unwrap();
        catch_unwind(AssertUnwindSafe(|| pool.install(|| engine.render(&project, &out, progress, &|_| ()))))
    };
    let engine = || Engine::new(AssetFolder::new(&file, false).unwrap());
    let counted = Progress::noting_looks();
    render(&engine(), "left alone", &counted).unwrap().unwrap();
    let expected = files(&folder.path().join("left alone"));
    assert_eq!(expected.len(), 7, "three frames in two formats, and the contact sheet");

    let looks = counted.looks();
    let mut stages = looks.clone();
    stages.sort_unstable();
    stages.dedup();
    for stage in ["background", "fit", "render", "trace", "visible", "write"] {
        assert!(stages.contains(&stage), "{stage}: {stages:?}");
    }
    for stage in stages {
        // What is looked at before any stage has begun has no name.
        let name = if stage.is_empty() { "before" } else { stage };
        let count = looks.iter().filter(|look| **look == stage).count();
        let engine = engine();
        let words = render(&engine, name, &Progress::with_panic(stage, count.div_ceil(2))).map(|_| ());
        let words = words.expect_err(stage);
        assert!(words.downcast_ref::<&str>().is_some_and(|words| words.contains("planted")), "{stage}");
        render(&engine, name, &Progress::new()).unwrap().unwrap();
        assert!(files(&folder.path().join(name)) == expected, "{stage}");
    }
}
