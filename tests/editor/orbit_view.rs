//! The orbit view of a scene that gives no light: there it is put right, so nothing lies over it.

use egui::{Color32, Rect, Shape};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use lightloom::editor::App;
use lightloom::editor::action::Action;
use lightloom::editor::command::Command;
use lightloom::editor::document::Edit;
use lightloom::editor::look::object::SceneObject;
use lightloom::editor::session::Panel;
use lightloom::editor::theme;
use lightloom_core::scene::{LightDesc, SceneDesc};

use crate::window::{examples, until, window};

/// The window in the orbit view, on a goblet with a lamp.
fn orbit_view(folder: &tempfile::TempDir) -> Harness<'static, App> {
    let mut harness = window(folder, "dark_glass", Vec::new());
    harness.state_mut().ask(Command::OrbitView.into());
    until(&mut harness, "the light on the table", |app| app.preview().look().light.is_some());
    harness
}

fn change(harness: &mut Harness<App>, change: impl FnOnce(&mut SceneDesc)) {
    let mut scene = harness.state().document().project().scene.clone().unwrap();
    change(&mut scene);
    harness.state_mut().ask(Action::Edit(Edit::Scene(Some(Box::new(scene)))));
    until(harness, "what is wrong", |app| app.preview().problem().is_some());
}

/// Whether something translucent in the colour of the surround covers a place.
fn is_veiled(harness: &Harness<App>, place: Rect) -> bool {
    let is_surround = |colour: Color32| {
        let [r, g, b, a] = colour.to_srgba_unmultiplied();
        let [x, y, z, _] = theme::SURROUND.to_array();
        (1..255).contains(&a) && [r.abs_diff(x), g.abs_diff(y), b.abs_diff(z)].into_iter().all(|off| off < 4)
    };
    harness.output().shapes.iter().any(|clipped| match &clipped.shape {
        Shape::Rect(shape) => shape.rect.contains_rect(place) && is_surround(shape.fill),
        _ => false,
    })
}

#[test]
fn a_lamp_that_misses_the_glass_is_seen_without_veil_and_without_the_light_that_was() {
    let folder = examples();
    let mut harness = orbit_view(&folder);
    change(&mut harness, |scene| {
        let LightDesc::Spot(lamp) = &mut scene.lights[0] else { panic!("the first lamp is no spot") };
        lamp.target = [-3.0, 0.6, -0.8];
    });
    until(&mut harness, "the scene as it is, dark", |app| {
        let seen = app.preview().look();
        let is_newest = seen.scene.is_some_and(|(_, of)| of.scene == app.document().project().scene);
        is_newest && seen.light.is_none()
    });
    harness.run_steps(3);
    let middle = harness.get_by_label("Orbit view").rect().shrink(80.0);
    assert!(!is_veiled(&harness, middle), "the lamp is turned back through a veil");
    harness.state_mut().ask(Command::BothViews.into());
    harness.run_steps(3);
    let plane = harness.get_by_label("Plane").rect().shrink(20.0);
    assert!(is_veiled(&harness, plane), "the plane shows the light that was");
}

#[test]
fn a_picture_of_another_scene_is_veiled() {
    let folder = examples();
    let mut harness = orbit_view(&folder);
    change(&mut harness, |scene| scene.meshes[0].file = "../assets/meshes/none.obj".into());
    harness.run_steps(3);
    let middle = harness.get_by_label("Orbit view").rect().shrink(80.0);
    assert!(is_veiled(&harness, middle), "the goblet is not there");
}

#[test]
fn a_lamp_of_the_background_says_that_it_casts_no_caustics() {
    let folder = examples();
    let mut harness = orbit_view(&folder);
    harness.state_mut().ask(Action::Panel(Panel::Scene));
    harness.state_mut().ask(Action::SelectObject(SceneObject::Light(1)));
    harness.run_steps(3);
    let words = "casts no caustics, by its role";
    assert!(harness.query_all_by_label_contains(words).next().is_some());
}
