//! Building the scene by hand: picking, transforms by pointer and by typed numbers, and the actions of one step.

#[path = "../scenes/mod.rs"]
mod scenes;

use crate::window::{self, Editor, examples, until, window};
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, pos2};
use egui_kittest::kittest::Queryable as _;
use glam::{DMat3, DVec3, Vec3};
use lightloom::editor::App;
use lightloom::editor::action::Action;
use lightloom::editor::command::Command;
use lightloom::editor::document::Edit;
use lightloom::editor::look::arrange::{self, Aim};
use lightloom::editor::look::bounds::Loaded;
use lightloom::editor::look::object::SceneObject;
use lightloom::editor::look::pick::pick;
use lightloom::editor::look::transforming::{End, TransformKind, Transforming};
use lightloom::editor::look::viewpoint::Viewpoint;
use lightloom::editor::session::ViewLayout;
use lightloom_core::project::Project;
use lightloom_core::scene::light::{DirectionalLight, PointLight, SpotLight};
use lightloom_core::scene::mesh::Transform;
use lightloom_core::scene::{CameraDesc, LightDesc, Scene, SceneDesc};
use scenes::{Stage, box_obj, glass};
use serde_json::json;

const MESH: SceneObject = SceneObject::Mesh(0);

/// A block of glass off the origin, another one, a spot, a point light, the sun.
fn stage() -> Stage {
    let mut stage = Stage::new();
    let block = box_obj(Vec3::new(0.1, 0.05, -0.1), Vec3::new(0.3, 0.25, 0.1));
    stage.mesh("block", block, glass(1.5));
    let other = box_obj(Vec3::new(-0.4, 0.0, -0.1), Vec3::new(-0.3, 0.1, 0.1));
    stage.mesh("other", other, glass(1.5));
    stage.desc.lights = vec![
        LightDesc::Spot(SpotLight { name: "spot".into(), position: [0.5, 1.0, 0.0], ..Default::default() }),
        LightDesc::Point(PointLight {
            name: "bulb".into(),
            position: [-0.5, 0.6, 0.0],
            ..Default::default()
        }),
        LightDesc::Directional(DirectionalLight { name: "sun".into(), ..Default::default() }),
    ];
    stage
}

fn project(desc: &SceneDesc) -> Project {
    let keys = json!([{ "frame": 1, "shows": "physical_caustic" }]);
    serde_json::from_value(json!({ "lightloom": 1, "scene": desc, "keys": keys })).unwrap()
}

fn view() -> Viewpoint {
    let camera = CameraDesc { position: [0.4, 1.0, 1.6], ..Default::default() };
    Viewpoint::new(&camera, Rect::from_min_size(pos2(50.0, 30.0), egui::vec2(800.0, 500.0))).unwrap()
}

fn typed(
    scene: &SceneDesc,
    object: SceneObject,
    pivot: Vec3,
    kind: TransformKind,
    keys: &str,
) -> Transforming {
    let mut transforming = Transforming::new(object, kind, scene, pivot);
    for letter in keys.chars() {
        let key = match letter {
            'x' => Key::X,
            'y' => Key::Y,
            'z' => Key::Z,
            '<' => Key::Backspace,
            _ => {
                transforming.text(&letter.to_string());
                continue;
            }
        };
        assert_eq!(transforming.key(key, false), None);
    }
    transforming
}

fn translate(scene: &SceneDesc) -> [f64; 3] {
    scene.meshes[0].transform.translate
}

#[test]
fn typed_numbers_move_exactly_along_the_axis() {
    let desc = stage().desc;
    let moved = |keys| translate(&typed(&desc, MESH, Vec3::ZERO, TransformKind::Move, keys).scene().unwrap());
    assert_eq!(moved("x0.2"), [0.2, 0.0, 0.0]);
    assert_eq!(moved("y1,5-"), [0.0, -1.5, 0.0]);
    assert_eq!(moved("z-.25<"), [0.0, 0.0, -0.2]);
    // Without a lock it is X; a second axis replaces the first, the same one twice lifts it.
    assert_eq!(moved("0.1"), [0.1, 0.0, 0.0]);
    assert_eq!(moved("xz0.1"), [0.0, 0.0, 0.1]);
    assert_eq!(moved("zz0.1"), [0.1, 0.0, 0.0]);
    assert_eq!(moved("abc"), [0.0; 3]);
    let words = typed(&desc, MESH, Vec3::ZERO, TransformKind::Move, "x0.2").words();
    assert_eq!(words, "Move block along X: 0.2| m");
}

#[test]
fn keys_end_a_transform_and_change_what_it_does() {
    let desc = stage().desc;
    let mut transforming = typed(&desc, MESH, Vec3::ZERO, TransformKind::Move, "x3");
    assert_eq!(transforming.key(Key::R, false), None);
    transforming.text("90");
    assert_eq!(transforming.scene().unwrap().meshes[0].transform.rotate, [90.0, 0.0, 0.0]);
    assert_eq!(transforming.key(Key::Enter, false), Some(End::Confirmed));
    assert_eq!(transforming.key(Key::Escape, false), Some(End::Cancelled));
}

/// Where a point of a mesh file comes to lie, by the documented order: scaled, turned about X, Y, Z, moved.
fn world(transform: &Transform, p: DVec3) -> DVec3 {
    let [x, y, z] = transform.rotate.map(|degrees| f64::from(degrees).to_radians());
    let turn = DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
    turn * (p * f64::from(transform.scale)) + DVec3::from(transform.translate)
}

#[test]
fn turning_and_scaling_keep_the_pivot_and_move_all_else_by_the_rotation() {
    let mut desc = stage().desc;
    desc.meshes[0].transform =
        Transform { translate: [0.1, 0.2, 0.3], rotate: [20.0, -35.0, 50.0], scale: 1.5 };
    let before = desc.meshes[0].transform.clone();
    let pivot = Vec3::new(0.4, 0.1, -0.2);
    let turns: [fn(f64) -> DMat3; 3] =
        [DMat3::from_rotation_x, DMat3::from_rotation_y, DMat3::from_rotation_z];
    for (axis, turn) in ["x", "y", "z"].into_iter().zip(turns) {
        let keys = format!("{axis}75");
        let turned = typed(&desc, MESH, pivot, TransformKind::Turn, &keys).scene().unwrap();
        for p in [DVec3::ZERO, DVec3::X, DVec3::new(-0.3, 0.7, 2.0)] {
            let wanted =
                turn(75_f64.to_radians()) * (world(&before, p) - pivot.as_dvec3()) + pivot.as_dvec3();
            let off = world(&turned.meshes[0].transform, p).distance(wanted);
            // Angles to 1e-4 degrees over 3 m.
            assert!(off < 2e-5, "{axis}: {off} m off");
        }
    }
    let scaled = typed(&desc, MESH, pivot, TransformKind::Scale, "2").scene().unwrap();
    let p = DVec3::new(-0.3, 0.7, 2.0);
    let wanted = (world(&before, p) - pivot.as_dvec3()) * 2.0 + pivot.as_dvec3();
    assert!(world(&scaled.meshes[0].transform, p).distance(wanted) < 1e-5);
}

#[test]
fn the_object_stays_under_the_pointer_and_on_its_axis() {
    let (desc, view) = (stage().desc, view());
    let pivot = Vec3::new(0.2, 0.15, 0.0);
    let from = view.screen(pivot).unwrap();
    let moved = |lock: &[(Key, bool)], to: Pos2| {
        let mut transforming = Transforming::new(MESH, TransformKind::Move, &desc, pivot);
        for (key, shift) in lock {
            assert_eq!(transforming.key(*key, *shift), None);
        }
        transforming.point(&view, from);
        transforming.point(&view, to);
        DVec3::from(translate(&transforming.scene().unwrap())).as_vec3()
    };
    let to = from + egui::vec2(120.0, -70.0);
    // Micrometres, as they are written, and f32 through the camera.
    assert!(view.screen(pivot + moved(&[], to)).unwrap().distance(to) < 0.05);
    let on_floor = moved(&[(Key::Y, true)], to);
    assert!(on_floor.y == 0.0 && view.screen(pivot + on_floor).unwrap().distance(to) < 0.05);
    // On a point of the axis the pointer leads exactly there.
    for (key, axis) in [(Key::X, Vec3::X), (Key::Y, Vec3::Y), (Key::Z, Vec3::Z)] {
        let on_axis = view.screen(pivot + axis * 0.17).unwrap();
        assert!(moved(&[(key, false)], on_axis).distance(axis * 0.17) < 1e-4, "{key:?}");
    }
}

#[test]
fn the_pointer_turns_as_far_as_it_goes_around() {
    let (desc, view) = (stage().desc, view());
    let pivot = Vec3::new(0.2, 0.15, 0.0);
    let centre = view.screen(pivot).unwrap();
    let mut transforming = Transforming::new(MESH, TransformKind::Turn, &desc, pivot);
    transforming.key(Key::Y, false);
    // One and an eighth of a turn against the clock, seen from above.
    for step in 0..=81 {
        let angle = -5.0 * f32::to_radians(step as f32);
        transforming.point(&view, centre + egui::vec2(angle.cos(), angle.sin()) * 100.0);
    }
    let [x, y, z] = transforming.scene().unwrap().meshes[0].transform.rotate;
    assert!((y - 45.0).abs() < 0.01 && x.abs() < 0.01 && z.abs() < 0.01, "{x} {y} {z}");
}

#[test]
fn what_cannot_be_done_says_why() {
    let desc = stage().desc;
    let refused = |object, kind, keys| typed(&desc, object, Vec3::ZERO, kind, keys).scene().err();
    assert!(refused(SceneObject::Light(2), TransformKind::Move, "1").is_some(), "the sun stands nowhere");
    assert!(refused(SceneObject::Light(1), TransformKind::Turn, "1").is_some(), "a bulb has no direction");
    assert!(refused(SceneObject::Light(1), TransformKind::Scale, "2").is_some(), "a point has no size");
    assert!(refused(SceneObject::CameraTarget, TransformKind::Turn, "1").is_some());
    assert!(refused(SceneObject::Light(2), TransformKind::Turn, "x30").is_none());
    assert!(arrange::deleted(&desc, SceneObject::Camera).is_err());
    assert!(arrange::aimed(&desc, MESH, Aim::Receiver, None).is_err());
}

#[test]
fn lamps_keep_looking_at_their_target_and_turn_about_themselves() {
    let desc = stage().desc;
    let spot = |scene: &SceneDesc| match &scene.lights[0] {
        LightDesc::Spot(spot) => spot.clone(),
        _ => panic!(),
    };
    let before = spot(&desc);
    let moved = typed(&desc, SceneObject::Light(0), Vec3::ZERO, TransformKind::Move, "z0.4").scene().unwrap();
    assert_eq!((spot(&moved).position, spot(&moved).target), ([0.5, 1.0, 0.4], before.target));
    let aimed =
        typed(&desc, SceneObject::LightTarget(0), Vec3::ZERO, TransformKind::Move, "y0.1").scene().unwrap();
    assert_eq!((spot(&aimed).position, spot(&aimed).target), (before.position, [0.0, 0.1, 0.0]));
    let turned = typed(&desc, SceneObject::Light(0), Vec3::ZERO, TransformKind::Turn, "z90").scene().unwrap();
    // From (0.5, 1, 0) to the origin, a quarter turn about Z: (-0.5, -1) becomes (1, -0.5).
    assert_eq!(spot(&turned).target, [1.5, 0.5, 0.0]);
    let wide = typed(&desc, SceneObject::Light(0), Vec3::ZERO, TransformKind::Scale, "100").scene().unwrap();
    assert_eq!(spot(&wide).angle_deg, 360.0);
}

fn loaded<'a>(scene: &'a Scene, project: &'a Project) -> Option<Loaded<'a>> {
    Some(Loaded { scene, project })
}

#[test]
fn a_click_finds_lamps_meshes_and_the_receiver() {
    let mut stage = stage();
    // An object that is off shifts no number.
    stage.desc.meshes.swap(0, 1);
    stage.desc.meshes[0].enabled = false;
    let (scene, desc, view) = (stage.load(), stage.desc.clone(), view());
    let project = project(&desc);
    let at = |p: Vec3| pick(view.screen(p).unwrap(), &view, &desc, loaded(&scene, &project), None);
    assert_eq!(at(Vec3::new(0.2, 0.15, 0.0)), Some(SceneObject::Mesh(1)));
    assert_eq!(at(Vec3::new(-0.35, 0.05, 0.0)), Some(SceneObject::Receiver), "the block there is off");
    assert_eq!(at(Vec3::new(0.5, 1.0, 0.0)), Some(SceneObject::Light(0)));
    assert_eq!(at(Vec3::new(-0.45, 0.0, 0.3)), Some(SceneObject::Receiver));
    assert_eq!(at(Vec3::new(-0.9, 0.0, 0.0)), None, "the floor is no object");
    let target = view.screen(Vec3::ZERO).unwrap();
    let of = |selected| pick(target, &view, &desc, loaded(&scene, &project), selected);
    assert_eq!(of(None), Some(SceneObject::Receiver));
    assert_eq!(of(Some(SceneObject::Light(0))), Some(SceneObject::LightTarget(0)));
}

#[test]
fn bounds_follow_a_mesh_that_moved_since_it_was_loaded() {
    let mut stage = stage();
    let (old, before) = (stage.load(), project(&stage.desc));
    let transform = Transform { translate: [0.3, 0.1, -0.2], rotate: [0.0, 90.0, 0.0], scale: 2.0 };
    stage.desc.meshes[0].transform = transform;
    let (new, after) = (stage.load(), project(&stage.desc));
    let ends = |loaded: Option<Loaded>| {
        let corners = loaded.unwrap().corners(&stage.desc, 0).unwrap();
        [corners.into_iter().reduce(Vec3::min).unwrap(), corners.into_iter().reduce(Vec3::max).unwrap()]
    };
    let (followed, read) = (ends(loaded(&old, &before)), ends(loaded(&new, &after)));
    assert!((0..2).all(|i| followed[i].distance(read[i]) < 1e-6), "{followed:?}, {read:?}");
}

#[test]
fn snapping_puts_the_lowest_corner_onto_the_table() {
    let mut stage = stage();
    stage.desc.receiver.rotate = [12.0, 0.0, 20.0];
    stage.desc.receiver.centre = [0.0, 0.3, 0.0];
    stage.desc.meshes[0].transform.rotate = [0.0, 0.0, 20.0];
    let (scene, project) = (stage.load(), project(&stage.desc));
    stage.desc = arrange::on_table(&stage.desc, MESH, loaded(&scene, &project)).unwrap();
    let snapped = stage.load();
    let receiver = snapped.receiver();
    let floor = receiver.world_from_plane(receiver.extent() / 2.0);
    // The box around a turned block is larger than the block: what stands on the table is the box that is drawn.
    let (low, high) = (snapped.meshes()[0].lower, snapped.meshes()[0].upper);
    let height = |i: usize| {
        let corner = Vec3::select(glam::BVec3::new(i & 1 != 0, i & 2 != 0, i & 4 != 0), high, low);
        (corner - floor).dot(receiver.normal())
    };
    let lowest = (0..8).map(height).fold(f32::INFINITY, f32::min);
    assert!(lowest.abs() < 1e-5, "{lowest} m above the table");
}

#[test]
fn aiming_duplicating_switching_and_solo() {
    let stage = stage();
    let scene = stage.load();
    let desc = stage.desc;
    let project = project(&desc);
    let loaded = loaded(&scene, &project);
    let aimed = arrange::aimed(&desc, SceneObject::Light(0), Aim::Glass, loaded).unwrap();
    let LightDesc::Spot(spot) = &aimed.lights[0] else { panic!() };
    assert!(Vec3::from(spot.target).distance(Vec3::new(0.2, 0.15, 0.0)) < 1e-6, "the nearest block's middle");
    let (copied, copy) = arrange::duplicated(&desc, MESH, loaded).unwrap();
    assert_eq!((copy, copied.meshes[2].name.as_str()), (SceneObject::Mesh(2), "block 2"));
    assert!((copied.meshes[2].transform.translate[0] - 0.22).abs() < 1e-6, "a tenth of its width beside it");
    let on = |scene: &SceneDesc| scene.lights.iter().map(LightDesc::is_enabled).collect::<Vec<_>>();
    let alone = arrange::alone(&desc, SceneObject::Light(1)).unwrap();
    assert_eq!(on(&alone), [false, true, false]);
    assert!(arrange::is_alone(&alone, SceneObject::Light(1)));
    assert_eq!(on(&arrange::alone(&alone, SceneObject::Light(1)).unwrap()), [true; 3]);
    assert_eq!(on(&arrange::switched(&desc, SceneObject::Light(2)).unwrap()), [true, true, false]);
}

#[test]
fn every_action_is_one_step_of_undo() {
    let mut editor = Editor::with_project(project(&stage().desc));
    let before = editor.document.project().clone();
    editor.session.focus.object = Some(SceneObject::Light(0));
    for command in [
        Command::AimAtReceiver,
        Command::DuplicateObject,
        Command::SwitchObject,
        Command::SoloObject,
        Command::DeleteObject,
    ] {
        editor.session.focus.object = Some(SceneObject::Light(0));
        // Aimed at the receiver already: nothing to do, and no step.
        let changes = command != Command::AimAtReceiver;
        editor.apply(command.into());
        assert_eq!(*editor.document.project() != before, changes, "{command:?}");
        if command == Command::DuplicateObject {
            assert_eq!(
                editor.session.focus.object,
                Some(SceneObject::Light(3)),
                "the copy is what is moved next"
            );
        }
        editor.apply(Command::Undo.into());
        assert_eq!(*editor.document.project(), before, "{command:?}");
    }
    // A transform: many edits, one step.
    editor.session.focus.object = Some(SceneObject::Light(0));
    editor.apply(Command::MoveObject.into());
    let mut transforming = editor.session.transforming.take().unwrap();
    assert_eq!(editor.session.layout, ViewLayout::Orbit);
    for digits in ["0", ".", "3"] {
        transforming.text(digits);
        editor.apply(Edit::Scene(Some(Box::new(transforming.scene().unwrap()))).into());
    }
    editor.apply(Action::Settle);
    assert_eq!(editor.document.project().scene.as_ref().unwrap().lights[0].position().unwrap().x, 0.8);
    editor.apply(Command::Undo.into());
    assert_eq!(*editor.document.project(), before);
    assert!(editor.document.history().undoes().is_none());
    // Without a selection there is nothing to transform.
    editor.session.focus.object = None;
    editor.apply(Command::MoveObject.into());
    assert!(editor.session.transforming.is_none() && !editor.status.is_empty());
}

fn press(harness: &mut egui_kittest::Harness<App>, at: Pos2, button: PointerButton) {
    harness.event(Event::PointerMoved(at));
    harness.run_steps(2);
    for pressed in [true, false] {
        harness.event(Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE });
        harness.run_steps(2);
    }
}

#[test]
fn a_click_selects_and_typed_keys_move_in_the_window() {
    let folder = examples();
    let mut harness = window(&folder, "dark_glass", Vec::new());
    harness.state_mut().ask(Command::OrbitView.into());
    until(&mut harness, "the orbit view", |app| app.preview().look().picture.is_some());
    harness.run_steps(4);
    let view = harness.get_by_label("Orbit view").rect();
    let desc = |app: &App| app.document().project().scene.clone().unwrap();
    let before = desc(harness.state());
    // Any point of the picture at which a mesh is seen.
    let seen = harness.state().preview().look();
    let shown = Viewpoint::new(seen.camera.as_ref().unwrap(), view).unwrap();
    let grid = (1..20).flat_map(|x| (1..20).map(move |y| [x, y].map(|n| n as f32 / 20.0)));
    let mut places = grid.map(|[x, y]| view.min + view.size() * egui::vec2(x, y));
    let is_mesh =
        |at: Pos2| matches!(pick(at, &shown, &before, seen.loaded(), None), Some(SceneObject::Mesh(_)));
    // Well inside of it: the picture's pixels are larger than points.
    let around = [[0.0, 0.0], [5.0, 0.0], [-5.0, 0.0], [0.0, 5.0], [0.0, -5.0]];
    let at = places.find(|at| around.iter().all(|by| is_mesh(*at + egui::Vec2::from(*by)))).unwrap();
    press(&mut harness, at, PointerButton::Primary);
    let selected = harness.state().session().focus.object;
    let index = selected.and_then(SceneObject::mesh).unwrap();
    let place = |app: &App| desc(app).meshes[index].transform.translate;
    let type_in = |harness: &mut egui_kittest::Harness<App>, text: &str| {
        harness.event(Event::Text(text.into()));
        harness.run_steps(2);
    };
    // G is the flow's grid elsewhere; here it moves. Digits are views elsewhere; here they are numbers.
    harness.key_press(Key::G);
    harness.key_press(Key::X);
    harness.run_steps(2);
    type_in(&mut harness, "0.25");
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    assert!(!harness.state().session().overlays.grid && harness.state().session().transforming.is_none());
    let [x, y, z] = before.meshes[index].transform.translate;
    let off = DVec3::from(place(harness.state())).distance(DVec3::new(x + 0.25, y, z));
    assert!(off < 1e-6, "{off} m off: places are written to the micrometre");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(3);
    assert_eq!(place(harness.state()), [x, y, z]);
    // Escape and the right button leave everything as it was, and no step of undo.
    harness.key_press(Key::S);
    harness.run_steps(2);
    type_in(&mut harness, "3");
    assert!(desc(harness.state()) != before, "the scene follows while it is typed");
    press(&mut harness, at + egui::vec2(5.0, 5.0), PointerButton::Secondary);
    assert_eq!(desc(harness.state()), before);
    assert!(harness.state().document().history().undoes().is_none());
    // F frames what is selected also where the pointer comes in with it.
    let outside = pos2(view.center().x, window::SIZE[1] - 60.0);
    harness.event(Event::PointerMoved(outside));
    harness.run_steps(3);
    let arrows = harness.state().session().overlays.arrows;
    let pressed = |pressed| Event::Key {
        key: Key::F,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    harness.input_mut().events.extend([Event::PointerMoved(at), pressed(true), pressed(false)]);
    harness.run_steps(3);
    assert_eq!(harness.state().session().overlays.arrows, arrows);
    // Away from the view G is what it always was.
    harness.event(Event::PointerMoved(outside));
    harness.run_steps(3);
    harness.key_press(Key::G);
    harness.run_steps(3);
    assert!(harness.state().session().overlays.grid);
}
