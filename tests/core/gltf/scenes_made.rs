//! What an import makes of a file: a scene that casts a caustic at once.

use lightloom_core::import;
use lightloom_core::photon::Tracer;
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::scene::LightDesc;
use lightloom_core::{Progress, engine::Engine};
use serde_json::json;

use super::{Glb, Written, ball, imported, loaded, with_table};
use crate::scenes::sphere_obj;

/// The cone holds the box around the ball and a little more: a quarter of its light meets the ball, and glass reflects some.
const HELD: f64 = 0.18;

/// Share of all lamps' power that reaches the receiver through glass.
fn share(glb: &Glb) -> f64 {
    let written = Written::new(&glb.bytes());
    let import = written.import().unwrap();
    let scene = loaded(&import, written.folder.path());
    let tracer = Tracer::new(&scene, 7, &Progress::new()).unwrap();
    let flux = tracer.trace(0, 4096, &Progress::new()).unwrap().0.total_flux().x;
    let LightDesc::Spot(lamp) = &import.scene.lights[0] else { panic!("{:?}", import.scene.lights) };
    flux / f64::from(lamp.watts)
}

#[test]
fn a_ball_alone_casts_a_caustic_at_once() {
    let import = imported(&ball());
    assert_eq!(import.summary.casters, 1);
    let share = share(&ball());
    assert!((HELD..1.0).contains(&share), "{share}");
    // The camera sees the whole ball and the middle of the table.
    let (camera, receiver) = import.scene.camera_and_receiver().unwrap();
    let middle = receiver.world_from_plane(receiver.extent() / 2.0);
    for point in [glam::vec3(-0.1, 0.1, 0.0), glam::vec3(0.1, 0.1, 0.0), glam::vec3(0.0, 0.2, 0.0), middle] {
        let seen = camera.project(point, 16.0 / 9.0).unwrap();
        assert!(seen.abs().max_element() < 0.9, "{point} at {seen}");
    }
}

#[test]
fn a_matt_plane_beneath_the_glass_is_the_receiver() {
    let mut glb = ball();
    with_table(&mut glb, json!({ "name": "Desk", "scale": [0.5, 1, 0.4] }));
    let scene = imported(&glb).scene;
    assert_eq!(scene.meshes.len(), 1, "{:?}", scene.meshes);
    assert_eq!((scene.receiver.size, scene.receiver.centre), ([1.0, 0.8], [0.0; 3]));
    assert_eq!(scene.receiver.albedo, [0.4, 0.3, 0.2]);
    assert!(share(&glb) > HELD);
    // Turned by 30 degrees about the vertical, it is turned as much; not by 90 more, though it is as deep as wide.
    let half = 15_f32.to_radians();
    let mut glb = ball();
    with_table(&mut glb, json!({ "name": "Desk", "rotation": [0, half.sin(), 0, half.cos()] }));
    let receiver = imported(&glb).scene.receiver;
    assert!((receiver.rotate[1] - 30.0).abs() < 1e-2 && receiver.rotate[0] == 0.0, "{:?}", receiver.rotate);
}

#[test]
fn of_a_large_floor_only_the_part_by_the_glass_receives() {
    let mut glb = ball();
    with_table(&mut glb, json!({ "name": "Floor", "scale": [50, 1, 50] }));
    let import = imported(&glb);
    let [width, height] = import.scene.receiver.size;
    assert!(width.max(height) < 3.0 && import.scene.receiver.surround > 40.0, "{:?}", import.scene.receiver);
    assert!(import.summary.notes.join("\n").contains("the rest is floor"));
    assert!(share(&glb) > HELD);
}

#[test]
fn other_units_are_scaled_and_set_down() {
    let written = Written::new(b"");
    let path = written.folder.path().join("lens.obj");
    // A ball of 120 mm, far away.
    std::fs::write(&path, sphere_obj(2, glam::vec3(900.0, 300.0, -50.0), 60.0)).unwrap();
    let import = import::read(&path, &Progress::new()).unwrap();
    let place = &import.scene.meshes[0].transform;
    assert_eq!(place.scale, 0.001);
    assert!(import.summary.notes.join("\n").contains("taken as millimetres"), "{:?}", import.summary.notes);
    let scene = loaded(&import, written.folder.path());
    let mesh = &scene.meshes()[0];
    assert!(mesh.lower.y.abs() < 1e-4 && (mesh.upper.y - 0.12).abs() < 2e-3, "{} {}", mesh.lower, mesh.upper);
    assert!((mesh.lower.x + mesh.upper.x).abs() < 1e-4);
}

#[test]
fn a_lost_area_light_is_named_and_its_place_is_used() {
    let mut glb = ball();
    glb.node(json!({ "name": "Area.001", "translation": [1, 2, 0] }));
    let import = imported(&glb);
    assert!(import.summary.notes.join("\n").contains("lost: Area.001"), "{:?}", import.summary.notes);
    assert_eq!(import.scene.lights[0].position().map(|p| p.to_array()), Some([1.0, 2.0, 0.0]));
}

#[test]
fn a_folder_gets_a_project_that_passes_its_check() {
    let mut glb = ball();
    // The buffer in a file of its own, its name in percents.
    glb.json["buffers"] = json!([ { "uri": "my%20scene.bin", "byteLength": glb.bin.len() } ]);
    let from = tempfile::tempdir().unwrap();
    std::fs::write(from.path().join("my scene.bin"), &glb.bin).unwrap();
    let path = from.path().join("ball.gltf");
    std::fs::write(&path, glb.json.to_string()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let into = folder.path().join("new");
    let (_, project_path) = import::into_folder(&path, None, &into, &Progress::new()).unwrap();
    assert!(into.join("my scene.bin").is_file() && into.join("ball.gltf").is_file());
    let project = Project::load(&project_path).unwrap();
    Engine::new(AssetFolder::new(&project_path, false).unwrap()).check(&project).unwrap();
    // Once more: nothing is written over.
    let again = import::into_folder(&path, None, &into, &Progress::new()).unwrap_err().to_string();
    assert!(again.contains("is there already"), "{again}");
}

#[test]
fn buffers_may_stand_in_the_file_itself() {
    let mut glb = ball();
    let text: String = glb.bin.iter().map(|byte| format!("%{byte:02x}")).collect();
    glb.json["buffers"] =
        json!([ { "uri": format!("data:application/octet-stream,{text}"), "byteLength": glb.bin.len() } ]);
    glb.bin.clear();
    assert_eq!(imported(&glb).summary.triangles, 80);
}

#[test]
fn a_second_import_comes_beside_the_first() {
    let import = imported(&ball());
    let mut project = import::empty_project();
    project.check().unwrap();
    import.add_to(&mut project, "ball.glb");
    import.add_to(&mut project, "ball.glb");
    project.check().unwrap();
    let scene = project.scene.unwrap();
    let names: Vec<_> = scene.meshes.iter().map(|mesh| mesh.name.as_str()).collect();
    // The lamp was made, not read: one is enough.
    assert_eq!((names, scene.lights.len()), (vec!["Ball", "Ball 2"], 1));
}
