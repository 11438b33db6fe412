//! A panic in each thread of the preview; what "ready" means.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use lightloom_core::flow::GridSize;

use super::*;
use crate::editor::access::Access;
use crate::editor::guard;

/// A small version of an example with a scene and a picture at its end; another one for each gamma.
fn subject(gamma: f32) -> Subject {
    let base: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("projects/dark_glass.json");
    let mut project = Project::load(&base).unwrap();
    (project.render.width, project.render.height, project.render.photons) = (64, 36, 2000);
    (project.flow.gamma, project.flow.grid, project.flow.steps) = (gamma, GridSize::Longer(16), 8);
    project.keys[1].frame = 4;
    Subject { project: Arc::new(project), base, access: Access::default() }
}

/// A session that needs the thread with this name, and the pictures it wants.
fn needing(name: &str, of: &Subject) -> (Session, Wanted) {
    let mut session = Session { playhead: 3, ..Session::default() };
    let mut wanted = Wanted { plane: Plane::Picture(32), shot: Some([32, 18]), look: None };
    match name {
        "orbit view" => {
            let camera = of.project.scene.as_ref().unwrap().camera.clone();
            wanted.look = Some((camera, [32, 18]));
        }
        "lamp" => {
            (session.panel, session.focus.object) = (Panel::Scene, Some(SceneObject::Light(0)));
        }
        "flow view" => session.overlays.arrows = true,
        "figures" => session.panel = Panel::Numbers,
        _ => (),
    }
    (session, wanted)
}

/// Whether the work of the thread with this name is there.
fn is_done(name: &str, preview: &LivePreview) -> bool {
    match name {
        "pictures" => preview.painted().number > 0,
        "background" => preview.shot().is_some(),
        "orbit view" => preview.look().number > 0,
        "lamp" => preview.lamp(0).is_some(),
        "flow view" => !preview.flow().arrows.is_empty(),
        "figures" => preview.continuity().is_some(),
        "target" => preview.target().is_some(),
        _ => preview.is_shown(),
    }
}

#[test]
fn a_panic_in_any_thread_is_told_until_the_next_edit_which_is_answered() {
    let names =
        ["animation", "pictures", "background", "orbit view", "lamp", "flow view", "figures", "target"];
    for name in names {
        let engine = SharedEngine::default();
        let mut preview = guard::planted(name, || LivePreview::new(engine, || ()));
        let mut follow = |gamma: f32, what: &str, holds: &dyn Fn(&LivePreview) -> bool| {
            let subject = subject(gamma);
            let (session, wanted) = needing(name, &subject);
            let begun = Instant::now();
            while !holds(&preview) {
                assert!(begun.elapsed() < Duration::from_secs(120), "{name}: waited in vain: {what}");
                preview.follow(&subject, &session, &wanted);
                std::thread::sleep(Duration::from_millis(2));
            }
            // What is told stays there to be read; pictures come and go while the light grows.
            let told = preview.problem().map(str::to_owned);
            (0..20).for_each(|_| preview.follow(&subject, &session, &wanted));
            assert_eq!(preview.problem(), told.as_deref(), "{name}: {what}");
        };
        let is_told = |preview: &LivePreview| {
            preview.problem().is_some_and(|told| told.contains("planted") && told.contains("unharmed"))
        };
        follow(0.25, "the message", &is_told);
        follow(0.75, "the answer", &|preview| preview.problem().is_none() && is_done(name, preview));
    }
}

#[test]
fn what_is_ready_shows_no_glass_of_an_older_scene() {
    let mut preview = LivePreview::new(SharedEngine::default(), || ());
    let (session, wanted) = needing("background", &subject(0.5));
    let mut shots: Vec<Arc<Shot>> = Vec::new();
    // A little: beside the lamp's cone the project would be wrong.
    for x in [0.0, 0.005, 0.01] {
        let mut subject = subject(0.5);
        let mut project = (*subject.project).clone();
        project.scene.as_mut().unwrap().meshes[0].transform.translate[0] += x;
        subject.project = Arc::new(project);
        let begun = Instant::now();
        preview.follow(&subject, &session, &wanted);
        while !preview.is_shown() {
            assert!(begun.elapsed() < Duration::from_secs(120), "waited in vain");
            preview.follow(&subject, &session, &wanted);
            std::thread::sleep(Duration::from_millis(2));
        }
        let shot = preview.shot().unwrap();
        let other = |old: &Arc<Shot>| old.background().pixels != shot.background().pixels;
        assert!(shots.iter().all(other), "the glass stands where it stood");
        shots.push(shot);
    }
}
