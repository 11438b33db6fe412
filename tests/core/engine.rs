//! One engine for all users: what is remembered is not made again, whoever made it, and changes nothing.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::previews::two_balls;
use lightloom_core::Progress;
use lightloom_core::continuity::{Continuity, measure};
use lightloom_core::engine::{Client, Engine, Summary};
use lightloom_core::glam::Vec2;
use lightloom_core::project::Project;
use tempfile::TempDir;

/// Renders into a folder of its own; the files by name, and the stages that ran.
fn render(engine: &Engine, project: &Project) -> (BTreeMap<String, Vec<u8>>, Vec<&'static str>) {
    let out = tempfile::tempdir().unwrap();
    let summary = engine.render(project, out.path(), &Progress::new(), &|_| ()).unwrap();
    (frames(&out), stages(&summary))
}

fn frames(out: &TempDir) -> BTreeMap<String, Vec<u8>> {
    let files = std::fs::read_dir(out.path()).unwrap().map(|entry| entry.unwrap().path());
    let is_frame = |path: &PathBuf| path.extension().is_some_and(|end| end == "exr");
    let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
    files.filter(is_frame).map(|path| (name(&path), std::fs::read(&path).unwrap())).collect()
}

fn stages(summary: &Summary) -> Vec<&'static str> {
    summary.stages.iter().map(|cost| cost.stage).collect()
}

/// The two balls, small, with the frames 3 and 7.
fn small() -> (impl Sized, Project, Engine) {
    let (stage, mut project, engine) = two_balls();
    project.output.frames = Some("3,7".to_owned());
    project.render.passes = 2;
    (stage, project, engine)
}

#[test]
fn a_second_render_makes_only_passes_and_files() {
    let (_stage, project, engine) = small();
    let (first, made) = render(&engine, &project);
    let camera = ["load", "visible", "background", "still"];
    let flow = ["trace", "plan", "fit", "match", "watch", "render", "write", "measure"];
    assert_eq!(made, [&camera[..], &flow].concat());
    let (second, made) = render(&engine.on_behalf_of(Client::Export), &project);
    assert_eq!(made, ["load", "render", "write"]);
    assert_eq!(first.len(), 2);
    assert!(first == second, "what is remembered is what would be made");
}

#[test]
fn a_new_gamma_traces_nothing_in_a_render_either() {
    let (_stage, mut project, engine) = small();
    render(&engine, &project);
    project.flow.gamma = 0.2;
    let (remembered, made) = render(&engine, &project);
    assert_eq!(made, ["load", "plan", "fit", "match", "watch", "render", "write", "measure"]);
    let (afresh, _) = render(&engine.afresh(), &project);
    assert!(remembered == afresh);
}

#[test]
fn users_at_the_same_time_get_the_same_light() {
    let (_stage, project, engine) = small();
    let alone = render(&engine.afresh(), &project).0;
    std::thread::scope(|scope| {
        let clients = [Client::Main, Client::Comparison, Client::Export];
        let renders = clients.map(|client| {
            let (engine, project) = (engine.on_behalf_of(client), &project);
            scope.spawn(move || render(&engine, project).0)
        });
        renders.into_iter().for_each(|render| assert!(render.join().unwrap() == alone));
    });
}

#[test]
fn the_figures_of_a_project_are_those_of_the_tracks_that_are_written() {
    let (_stage, mut project, engine) = small();
    // As many photons as the figures are taken from, and steps that meet the times of all pictures.
    (project.render.photons, project.flow.steps) = (5000, 20);
    let out = tempfile::tempdir().unwrap();
    let summary = engine.fit(&project, out.path(), &Progress::new(), &|_| ()).unwrap();
    let tracks: Vec<Vec<Vec2>> = crate::tracks::read::<Vec2, 2>(&out.path().join("tracks.npy"));
    let extent = engine.fitted(&project, &Progress::new()).unwrap().extent();
    // The first of two segments.
    let expected = measure(&tracks[..=tracks.len() / 2], extent, &Progress::new());
    let (found, expected) = (&summary.continuity[0].all, expected.unwrap());
    let torn = |of: &Continuity| [of.torn_source, of.torn_target, of.torn_target_late];
    assert_eq!(torn(found), torn(&expected));
    // Positions at a time do not depend on which others are asked for, but for single precision.
    assert!((found.cracks - expected.cracks).abs() < 1e-4, "{found:?} {expected:?}");
    // Between steps light may be denser and faster still.
    assert!(
        found.bunch >= expected.bunch && found.fastest > 0.99 * expected.fastest,
        "{found:?} {expected:?}"
    );
    assert_eq!(engine.continuity(&project, &Progress::new()).unwrap(), summary.continuity);
}
