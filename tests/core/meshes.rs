//! Mesh files come from anywhere: whatever stands in them, the answer is a scene or an error that names the place.

use std::cell::RefCell;

use crate::scenes::{Stage, box_obj, glass, icosphere, obj, sphere_obj};
use glam::Vec3;
use lightloom_core::Error;
use lightloom_core::scene::material::Material;
use lightloom_core::scene::{Ray, Scene, SurfaceId};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 0 -1\n";

/// The error for an OBJ file, as the artist reads it.
fn refusal(content: impl AsRef<[u8]>) -> String {
    let mut stage = Stage::new();
    stage.mesh("bad", content, glass(1.5));
    let error = stage.try_load().err().expect("must be refused");
    let text = error.to_string();
    assert!(text.contains("bad.obj"), "{text} does not name the file");
    text
}

/// The scene and the notes for an OBJ file that must load.
fn loaded(content: impl AsRef<[u8]>, material: Option<Material>) -> (Scene, Vec<String>) {
    let mut stage = Stage::new();
    stage.mesh("mesh", content, material);
    stage.try_load().unwrap()
}

fn triangles(content: impl AsRef<[u8]>) -> usize {
    loaded(content, glass(1.5)).0.meshes()[0].triangles
}

#[test]
fn vertices_that_are_no_finite_numbers_are_counted_and_refused() {
    let text = refusal(format!("{TRIANGLE}v nan 0 0\nv 1e400 0 0\nv 0 -inf 0\nf 1 2 3\n"));
    assert!(text.contains("3 vertices") && text.contains("line 4"), "{text}");
    assert!(refusal(format!("{TRIANGLE}v 1 x 2\nf 1 2 3\n")).contains("line 4"));
    assert!(refusal(format!("{TRIANGLE}v 1 2\nf 1 2 3\n")).contains("line 4"));
}

#[test]
fn indices_out_of_range_are_refused_with_the_line() {
    for face in [
        "0 1 2",
        "1 2 4",
        "1 2 -4",
        "1//1 2//1 3//1",
        "1 2 99999999999999999999",
        "1/1/-6 2 3",
        "a b c",
        "1 2",
    ] {
        let text = refusal(format!("{TRIANGLE}f {face}\n"));
        assert!(text.contains("line 4"), "{face}: {text}");
    }
    let text = refusal("v 0 0 0\nvn 0 0 1\nf 1/1/-6 1/1/-9223372036854775808 1\n");
    assert!(text.contains("line 3"), "{text}");
}

#[test]
fn negative_indices_count_from_the_end() {
    assert_eq!(triangles(format!("{TRIANGLE}f -3 -2 -1\n")), 1);
}

#[test]
fn a_material_library_is_only_read_where_the_path_policy_allows() {
    let mut stage = Stage::new();
    stage.mesh("mesh", format!("mtllib ../../etc/passwd\n{TRIANGLE}usemtl x\nf 1 2 3\n"), None);
    let root = stage.folder.path().to_owned();
    let asked = RefCell::new(Vec::new());
    let policy = |path: &str, place: &str| {
        asked.borrow_mut().push(path.to_owned());
        if path.contains("..") {
            Err(Error::value(place, "outside the project folder"))
        } else {
            Ok(root.join(path))
        }
    };
    let (scene, notes) = Scene::load(&stage.desc, &policy).unwrap();
    // Beside the mesh, too, but nowhere that the policy does not know of.
    assert!(asked.borrow().contains(&"../../etc/passwd".to_owned()));
    assert!(notes.iter().any(|note| note.text.contains("outside the project folder")), "{notes:?}");
    assert!(matches!(scene.meshes()[0].material, Material::Diffuse(_)));
    stage.desc.meshes[0].file = "../mesh.obj".into();
    assert!(matches!(Scene::load(&stage.desc, &policy), Err(Error::Value { .. })));
}

#[test]
fn byte_order_marks_continued_lines_and_foreign_letters_are_read() {
    assert_eq!(triangles(format!("\u{feff}{TRIANGLE}f 1 2 3\n")), 1);
    assert_eq!(triangles("v 0 0 \\\n0\r\nv 1 0 0\r\nv 0 0 -1\r\nf 1 \\\r\n2 \\\n 3"), 1);
    let mut latin = b"o Fl\xfcssigkeit\nusemtl Gr\xfcn\n".to_vec();
    latin.extend(format!("{TRIANGLE}f 1 2 3 # face\n").bytes());
    assert_eq!(triangles(latin), 1);
    assert!(refusal([0xff, 0xfe, b'v', 0]).contains("UTF-16"));
}

#[test]
fn a_file_without_faces_is_refused() {
    for content in ["", "# nothing\n", TRIANGLE, "v 0 0 0\nv 1 0 0\nl 1 2\n", "\u{0}\u{1}\u{2}"] {
        assert!(refusal(content).contains("no faces"));
    }
    assert!(refusal(format!("{TRIANGLE}f 1 1 2\nf 1 2 2\n")).contains("no triangle of any size"));
}

#[test]
fn triangles_without_area_are_dropped_and_counted() {
    let (scene, notes) = loaded(format!("{TRIANGLE}v 2 0 0\nf 1 2 3\nf 1 2 4\nf 2 2 3\n"), glass(1.5));
    assert_eq!(scene.meshes()[0].triangles, 1);
    assert!(notes.iter().any(|note| note.contains("2 triangles without area")), "{notes:?}");
}

#[test]
fn a_polygon_of_200_000_corners_is_split_at_once() {
    let count = 200_000;
    let mut text = String::new();
    for k in 0..count {
        let (z, x) = (std::f64::consts::TAU * f64::from(k) / f64::from(count)).sin_cos();
        text.push_str(&format!("v {x} 0 {z}\n"));
    }
    let corners: Vec<String> = (1..=count).map(|k| k.to_string()).collect();
    text.push_str(&format!("f {}\n", corners.join(" ")));
    let (scene, _) = loaded(text, glass(1.5));
    assert!(scene.meshes()[0].triangles > 199_000);
}

#[test]
fn odd_glass_is_told() {
    let open = loaded(format!("{TRIANGLE}f 1 2 3\n"), glass(1.5)).1;
    assert!(open.iter().any(|note| note.contains("3 open edges")), "{open:?}");
    // Above the receiver: what stands on it is told, too.
    let closed = box_obj(Vec3::splat(0.5), Vec3::ONE);
    assert_eq!(loaded(&closed, glass(1.5)).1, Vec::<String>::new());
    let one_flipped = closed.replacen("f 1 5 7", "f 7 5 1", 1);
    let notes = loaded(one_flipped, glass(1.5)).1;
    assert!(notes.iter().any(|note| note.contains("1 of 12 triangles faced inward")), "{notes:?}");
    // A Moebius strip has no outside.
    let strip = [[0, 3, 1], [1, 3, 4], [1, 4, 2], [2, 4, 5], [2, 5, 3], [3, 5, 0]];
    let corners: Vec<Vec3> = (0..6)
        .map(|k| Vec3::new((k % 3) as f32, (k / 3) as f32, if k % 3 == 1 { 1.0 } else { 0.0 }))
        .collect();
    let notes = loaded(obj(&corners, None, &strip), glass(1.5)).1;
    assert!(notes.iter().any(|note| note.contains("wound against each other")), "{notes:?}");
}

#[test]
fn glass_inside_out_is_turned() {
    let (vertices, faces) = icosphere(2);
    let inward: Vec<_> = faces.iter().map(|[a, b, c]| [*c, *b, *a]).collect();
    let (scene, notes) = loaded(obj(&vertices, None, &inward), glass(1.5));
    assert!(notes.iter().any(|note| note.contains("turned inside out")), "{notes:?}");
    let hit = scene.intersect(&Ray::new(Vec3::Y * 5.0, Vec3::NEG_Y)).unwrap();
    assert!(hit.geometric_normal.y > 0.9 && hit.shading_normal.y > 0.9);
}

#[test]
fn a_mesh_in_other_units_gets_a_hint() {
    for scale in [1e-6, 1e6] {
        let mut stage = Stage::new();
        stage.mesh("mesh", box_obj(Vec3::ZERO, Vec3::ONE), glass(1.5)).transform.scale = scale;
        let (_, notes) = stage.try_load().unwrap();
        assert!(notes.iter().any(|note| note.contains("other units")), "{notes:?}");
    }
    for scale in [1e-12, 1e12, f32::NAN, 0.0, -1.0] {
        let mut stage = Stage::new();
        stage.mesh("mesh", box_obj(Vec3::ZERO, Vec3::ONE), glass(1.5)).transform.scale = scale;
        assert!(stage.try_load().is_err(), "scale {scale}");
    }
}

#[test]
fn only_regular_files_are_read() {
    let mut stage = Stage::new();
    stage.mesh("mesh", box_obj(Vec3::ZERO, Vec3::ONE), glass(1.5));
    for file in ["", "absent.obj", "."] {
        stage.desc.meshes[0].file = file.into();
        assert!(stage.try_load().is_err(), "{file}");
    }
    #[cfg(unix)]
    {
        let load = Scene::load(&stage.desc, &|_: &str, _: &str| Ok("/dev/zero".into()));
        assert!(load.is_err());
    }
}

#[test]
fn glass_is_guessed_from_its_material_file_and_reported() {
    let mut stage = Stage::new();
    let materials = [
        ("Wine_Glass", "Ni 1.45\nd 1\nillum 2", true),
        ("Window", "Ni 1.52\nd 0.2", true),
        ("bottle", "Ni 1.5\nabsorption 3 0.5 4", true),
        ("wall", "Ni 1.45\nKd 0.5 0.25 0", false),
        ("glassy paint", "Kd 1 0 0", false),
    ];
    let library: String =
        materials.iter().map(|(name, lines, _)| format!("newmtl {name}\n{lines}\n\n")).collect();
    stage.file("all.mtl", library + "newmtl old mirror\nKs 0.5 0.5 0.5\n");
    let names: Vec<&str> = materials.iter().map(|m| m.0).chain(["old mirror"]).collect();
    let faces: String = names.iter().map(|name| format!("usemtl {name}\nf 1 2 3\n")).collect();
    stage.mesh("room", format!("mtllib all.mtl\n{TRIANGLE}{faces}"), None);
    let (scene, notes) = stage.try_load().unwrap();
    let meshes = scene.meshes();
    assert_eq!(meshes.len(), 6);
    for ((name, _, is_glass), mesh) in materials.iter().zip(meshes) {
        assert_eq!(mesh.name, format!("room/{name}"));
        assert_eq!(matches!(mesh.material, Material::Glass(_)), *is_glass, "{name}");
        let told = notes.iter().any(|note| note.contains(name));
        assert!(told || *name == "wall", "{name}: {notes:?}");
    }
    let Material::Glass(bottle) = &meshes[2].material else { panic!() };
    assert_eq!((bottle.ior, bottle.absorption), (1.5, [3.0, 0.5, 4.0]));
    let Material::Diffuse(wall) = &meshes[3].material else { panic!() };
    assert_eq!(wall.albedo, [0.5, 0.25, 0.0]);
    let Material::Mirror(mirror) = &meshes[5].material else { panic!() };
    assert_eq!(mirror.reflectance, [0.5; 3]);
}

#[test]
fn computed_normals_are_smooth_on_a_sphere_and_sharp_on_a_box() {
    let (vertices, faces) = icosphere(4);
    let (scene, _) = loaded(obj(&vertices, None, &faces), glass(1.5));
    let with_normals = loaded(sphere_obj(4, Vec3::ZERO, 1.0), glass(1.5)).0;
    for direction in [Vec3::new(0.3, -1.0, 0.2), Vec3::new(-0.7, -0.1, 0.9), Vec3::new(0.2, 0.5, -0.9)] {
        let ray = Ray::new(-direction.normalize() * 3.0, direction.normalize());
        let (hit, exact) = (scene.intersect(&ray).unwrap(), with_normals.intersect(&ray).unwrap());
        // Faces of 0.07 turn by 4 degrees each; their average is 20 times closer to the sphere.
        assert!(hit.shading_normal.angle_between(hit.point.normalize()) < 0.004);
        assert!(exact.shading_normal.angle_between(exact.point.normalize()) < 1e-3);
        assert!(hit.geometric_normal.angle_between(hit.point.normalize()) > 0.004);
    }
    let scene = loaded(box_obj(-Vec3::ONE, Vec3::ONE), glass(1.5)).0;
    let hit = scene.intersect(&Ray::new(Vec3::new(0.95, 5.0, 0.9), Vec3::NEG_Y)).unwrap();
    assert_eq!((hit.shading_normal, hit.surface), (Vec3::Y, SurfaceId::Mesh(0)));
}

#[test]
fn placement_scales_then_turns_then_moves() {
    let mut stage = Stage::new();
    let transform =
        &mut stage.mesh("mesh", box_obj(Vec3::ZERO, Vec3::new(1.0, 2.0, 3.0)), glass(1.5)).transform;
    transform.scale = 2.0;
    transform.rotate = [90.0, 0.0, 90.0];
    transform.translate = [10.0, 0.0, 0.0];
    let scene = stage.load();
    // About X: (x, y, z) -> (x, -z, y); then about Z: (x, y, z) -> (-y, x, z).
    let (lower, upper) = (scene.meshes()[0].lower, scene.meshes()[0].upper);
    assert!(lower.distance(Vec3::new(10.0, 0.0, 0.0)) < 1e-5, "{lower}");
    assert!(upper.distance(Vec3::new(16.0, 2.0, 4.0)) < 1e-5, "{upper}");
}
