//! What is shown of the flow is what the field does.

use std::fmt::Write as _;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::{Vec2, vec2};
use lightloom::editor::access::Access;
use lightloom::editor::engine::SharedEngine;
use lightloom::editor::preview::{FlowPicture, LivePreview, Subject, Wanted};
use lightloom::editor::session::{FieldMap, Session};
use lightloom_core::constraint::{Barriers, Constraint, Wall, Window};
use lightloom_core::flow::MotionMethod;
use lightloom_core::project::Project;
use tempfile::TempDir;

/// A disc of photons that goes from left to right, in a folder of its own.
fn subject(gamma: f32, constraints: Vec<Constraint>) -> (TempDir, Subject) {
    let (folder, subject) = disc("transport", gamma);
    let project = Project { constraints, ..(*subject.project).clone() };
    project.check().unwrap();
    (folder, Subject { project: Arc::new(project), ..subject })
}

/// The disc, whose photons are paired as `matching` says; row by row they change places.
fn disc(matching: &str, gamma: f32) -> (TempDir, Subject) {
    let folder = tempfile::tempdir().unwrap();
    for (name, centre, step) in [("from.csv", vec2(0.25, 0.5), 1), ("to.csv", vec2(0.75, 0.45), 101)] {
        let mut text = String::from("x,y\n");
        // 101 is prime to 300: every place is taken once.
        for i in (0..300).map(|i| i * step % 300) {
            // A sunflower: even in a disc.
            let p = centre + Vec2::from_angle(2.399_963 * i as f32) * (0.15 * (i as f32 / 300.0).sqrt());
            writeln!(text, "{},{}", p.x, p.y).unwrap();
        }
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let text = format!(
        r#"{{ "lightloom": 1, "matching": "{matching}", "keys": [ {{ "frame": 1, "shows": {{ "points": {{ "file": "from.csv" }} }} }},
            {{ "frame": 11, "shows": {{ "points": {{ "file": "to.csv" }} }} }} ],
            "flow": {{ "gamma": {gamma}, "alpha": 0.001, "grid": 24, "steps": 8 }}, "render": {{ "photons": 300 }} }}"#
    );
    let project: Project = serde_json::from_str(&text).unwrap();
    let base = folder.path().join("project.json");
    (folder, Subject { project: Arc::new(project), base, access: Access::default() })
}

/// What is seen once the workers are done.
fn seen(subject: &Subject, session: &Session, ready: impl Fn(&FlowPicture) -> bool) -> Arc<FlowPicture> {
    let mut preview = LivePreview::new(SharedEngine::default(), || {});
    let begun = Instant::now();
    // They need seconds; minutes are for a busy machine.
    while begun.elapsed() < Duration::from_secs(300) {
        preview.follow(subject, session, &Wanted::default());
        assert_eq!(preview.problem(), None);
        let flow = preview.flow();
        if ready(&flow) {
            return flow;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("nothing was seen");
}

fn session(change: impl FnOnce(&mut Session)) -> Session {
    let mut session = Session { playhead: 3, ..Session::default() };
    change(&mut session);
    session
}

fn most(gamma: f32, map: FieldMap) -> f32 {
    let (_folder, subject) = subject(gamma, Vec::new());
    // On its way to a meeting a liquid gathers, too.
    let project = Project { method: MotionMethod::Guided, ..(*subject.project).clone() };
    let subject = Subject { project: Arc::new(project), ..subject };
    let session = session(|session| session.overlays.map = Some(map));
    let flow = seen(&subject, &session, |flow| flow.map.is_some());
    flow.map.as_ref().unwrap().most
}

#[test]
fn without_gamma_the_map_of_the_divergence_is_empty_and_with_all_of_it_that_of_the_curl() {
    let (divergence, curl) = (most(0.0, FieldMap::Divergence), most(0.0, FieldMap::Curl));
    // Derivatives of a B-spline in f32.
    assert!(divergence < 1e-3 * curl && curl > 0.01, "{divergence} {curl}");
    // The disc keeps its size, so little spreads or gathers: 0.07 per segment.
    let (divergence, curl) = (most(1.0, FieldMap::Divergence), most(1.0, FieldMap::Curl));
    assert!(curl < 1e-3 * divergence && divergence > 0.01, "{divergence} {curl}");
}

#[test]
fn arrows_and_streamlines_go_where_the_light_goes() {
    let (_folder, subject) = subject(0.5, Vec::new());
    let session = session(|session| (session.overlays.arrows, session.overlays.streamlines) = (true, true));
    let flow = seen(&subject, &session, |flow| !flow.arrows.is_empty() && !flow.streamlines.is_empty());
    let near = |p: Vec2| p.distance(vec2(0.35, 0.49)) < 0.1;
    let arrows: Vec<_> = flow.arrows.iter().filter(|(p, _)| near(*p)).collect();
    assert!(arrows.len() > 5 && arrows.iter().all(|(_, u)| u.x > 0.0));
    let streams: Vec<_> = flow.streamlines.iter().filter(|way| near(way[0])).collect();
    assert!(streams.len() > 3 && streams.iter().all(|way| way[way.len() - 1].x > way[0].x));
    assert!(flow.map.is_none() && flow.trails.is_empty() && flow.followed.is_none());
}

#[test]
fn the_residual_is_of_the_photons() {
    let (_folder, subject) = subject(0.0, Vec::new());
    let session = session(|session| session.overlays.map = Some(FieldMap::Residual));
    // Before the field is fitted nothing is left undone.
    let flow = seen(&subject, &session, |flow| flow.map.as_ref().is_some_and(|map| map.most > 0.0));
    let map = flow.map.as_ref().unwrap();
    assert!(map.values.iter().all(|v| *v >= 0.0));
    // No photon is near the corners.
    assert_eq!((map.values[0], map.values[map.values.len() - 1]), (0.0, 0.0));
}

#[test]
fn the_map_of_tears_shows_a_body_that_is_scrambled_and_none_that_stays_whole() {
    let session = session(|session| (session.playhead, session.overlays.map) = (6, Some(FieldMap::Tears)));
    let torn = |matching: &str, method: MotionMethod| {
        let (_folder, subject) = disc(matching, 1.0);
        let project = Project { method, ..(*subject.project).clone() };
        let subject = Subject { project: Arc::new(project), ..subject };
        let flow = seen(&subject, &session, |flow| flow.map.is_some());
        let map = flow.map.clone().unwrap();
        map.values.iter().filter(|value| **value > 0.5).count()
    };
    // A field would hold even pairs by chance together for a while.
    let (whole, scrambled) = (torn("transport", MotionMethod::Flow), torn("given", MotionMethod::Linear));
    assert!(whole < 10 && scrambled > 100, "{whole} and {scrambled} of 300 photons are torn off");
}

#[test]
fn the_photon_that_is_followed_has_its_way_its_target_and_a_detour_around_walls() {
    let wall = Wall::new(vec![[0.5, 0.3], [0.5, 0.9]]);
    for walls in [Vec::new(), vec![Constraint::Wall(wall.clone())]] {
        let (_folder, subject) = subject(0.5, walls.clone());
        let session = session(|session| (session.probe, session.overlays.trails) = (Some(7), true));
        let whole =
            |flow: &FlowPicture| flow.followed.as_ref().is_some_and(|photon| photon.trajectory.len() == 11);
        let flow = seen(&subject, &session, whole);
        let photon = flow.followed.as_ref().unwrap();
        assert!(photon.trajectory.contains(&photon.at));
        // The way ends at the next key.
        assert!(photon.trajectory[10].distance(photon.target) < 1e-6);
        let (first, last) =
            (photon.path_around_walls[0], photon.path_around_walls[photon.path_around_walls.len() - 1]);
        assert_eq!((first, last), (photon.at, photon.target));
        let active = wall.active(Window::ALWAYS).unwrap();
        let barriers = Barriers::new(&[&active], Vec2::ONE);
        if walls.is_empty() {
            assert_eq!(photon.path_around_walls.len(), 2);
        } else {
            assert!(barriers.blocks(first, last), "the straight way shall be blocked for this test");
            assert!(photon.path_around_walls.windows(2).all(|piece| !barriers.blocks(piece[0], piece[1])));
        }
        assert!(!flow.trails.is_empty());
    }
}

#[test]
fn a_row_that_there_is_not_is_not_followed() {
    let (_folder, subject) = subject(0.5, Vec::new());
    // The residual comes with the followed photon, in the second answer.
    let session = session(|session| {
        (session.probe, session.overlays.map) = (Some(usize::MAX), Some(FieldMap::Residual));
    });
    let flow = seen(&subject, &session, |flow| flow.map.is_some());
    assert!(flow.followed.is_none());
}
