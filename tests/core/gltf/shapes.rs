//! One ball, written in all ways that the format has: the same triangles.

use glam::{DMat4, Vec3, vec3};
use serde_json::json;

use super::{Glb, Written, ball, glass, loaded};
use crate::scenes::icosphere;

/// Writes the positions of a ball and returns their accessor.
type Write<'a> = &'a dyn Fn(&mut Glb) -> usize;

/// A square of glass with its corners in the order of a fan.
const SQUARE: [Vec3; 4] =
    [vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(1.0, 1.0, 0.5), vec3(0.0, 1.0, 0.0)];

/// Triangles, lower and upper corner of all meshes.
fn extent(glb: &Glb) -> (usize, Vec3, Vec3) {
    let written = Written::new(&glb.bytes());
    let import = written.import().unwrap();
    let scene = loaded(&import, written.folder.path());
    let meshes = scene.meshes();
    let lower = meshes.iter().map(|mesh| mesh.lower).reduce(Vec3::min).unwrap();
    let upper = meshes.iter().map(|mesh| mesh.upper).reduce(Vec3::max).unwrap();
    (meshes.iter().map(|mesh| mesh.triangles).sum(), lower, upper)
}

fn close(a: Vec3, b: Vec3) -> bool {
    // Rounding of 32 bits at metres.
    a.distance(b) < 1e-5
}

#[test]
fn all_ways_to_write_triangles_give_the_same() {
    let corners = |order: &[usize]| order.iter().map(|i| SQUARE[*i]).collect::<Vec<_>>();
    for (name, mode, vertices, indices) in [
        ("triangles", 4, corners(&[0, 1, 2, 3]), Some(vec![0, 1, 2, 0, 2, 3])),
        ("without indices", 4, corners(&[0, 1, 2, 0, 2, 3]), None),
        ("strip", 5, corners(&[1, 2, 0, 3]), None),
        ("fan", 6, corners(&[0, 1, 2, 3]), None),
        ("fan with indices", 6, corners(&[3, 2, 1, 0]), Some(vec![3, 2, 1, 0])),
    ] {
        let mut glb = Glb::new();
        let material = glb.push("materials", glass());
        let position = glb.vectors(&vertices);
        let mut primitive =
            json!({ "attributes": { "POSITION": position }, "mode": mode, "material": material });
        if let Some(indices) = indices {
            primitive["indices"] = glb.indices(&indices).into();
        }
        let mesh = glb.push("meshes", json!({ "primitives": [primitive] }));
        glb.node(json!({ "name": "square", "mesh": mesh }));
        // A camera, so that nothing is set down.
        let camera = glb
            .push("cameras", json!({ "type": "perspective", "perspective": { "yfov": 0.6, "znear": 0.1 } }));
        glb.node(json!({ "camera": camera, "translation": [0, 1, 3] }));
        let (triangles, lower, upper) = extent(&glb);
        assert_eq!(triangles, 2, "{name}");
        assert!(close(lower, Vec3::ZERO) && close(upper, vec3(1.0, 1.0, 0.5)), "{name}: {lower} {upper}");
    }
}

#[test]
fn whole_numbers_strides_and_sparse_elements_are_read() {
    let (unit, faces) = icosphere(1);
    let (_, lower, upper) = extent(&ball());
    let variants: [(&str, Write<'_>); 3] = [
        ("normalized shorts", &|glb| {
            let bytes: Vec<u8> = unit
                .iter()
                .flat_map(|v| v.to_array().into_iter().chain([0.0]))
                .flat_map(|n| ((n * 32_767.0).round() as i16).to_le_bytes())
                .collect();
            let accessor = glb.accessor(&bytes, (5122, unit.len(), "VEC3"));
            glb.json["accessors"][accessor]["normalized"] = true.into();
            let view = glb.json["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize;
            glb.json["bufferViews"][view]["byteStride"] = 8.into();
            accessor
        }),
        ("interleaved", &|glb| {
            let bytes: Vec<u8> =
                unit.iter().flat_map(|v| [v.x, v.y, v.z, 7.0, 8.0]).flat_map(f32::to_le_bytes).collect();
            let accessor = glb.accessor(&bytes, (5126, unit.len(), "VEC3"));
            let view = glb.json["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize;
            glb.json["bufferViews"][view]["byteStride"] = 20.into();
            accessor
        }),
        ("sparse over zeros", &|glb| {
            let indices: Vec<u8> = (0..unit.len()).flat_map(|i| (i as u16).to_le_bytes()).collect();
            let values: Vec<u8> = unit.iter().flat_map(|v| v.to_array()).flat_map(f32::to_le_bytes).collect();
            let (indices, values) = (glb.view(&indices), glb.view(&values));
            glb.push(
                "accessors",
                json!({ "componentType": 5126, "count": unit.len(), "type": "VEC3",
                "sparse": { "count": unit.len(), "indices": { "bufferView": indices, "componentType": 5123 },
                    "values": { "bufferView": values } } }),
            )
        }),
    ];
    for (name, write) in variants {
        let mut glb = Glb::new();
        let material = glb.push("materials", glass());
        let position = write(&mut glb);
        let indices = glb.indices(faces.as_flattened());
        let primitive =
            json!({ "attributes": { "POSITION": position }, "indices": indices, "material": material });
        let mesh = glb.push("meshes", json!({ "primitives": [primitive] }));
        glb.node(
            json!({ "name": "Ball", "mesh": mesh, "translation": [0, 0.1, 0], "scale": [0.1, 0.1, 0.1] }),
        );
        let (triangles, low, up) = extent(&glb);
        assert_eq!(triangles, 80, "{name}");
        assert!(close(low, lower) && close(up, upper), "{name}: {low} {up}");
    }
}

#[test]
fn nodes_stand_where_their_parents_put_them() {
    let mut glb = ball();
    let turn = std::f32::consts::FRAC_PI_4.sin();
    // Turned by 90 degrees about z: what is up goes to the left; then the parent mirrors it and moves it.
    glb.json["nodes"][0]["rotation"] = json!([0, 0, turn, turn]);
    glb.json["nodes"][0]["scale"] = json!([1, 3, 1]);
    let mirror =
        DMat4::from_translation(glam::dvec3(5.0, 0.0, 0.0)) * DMat4::from_scale(glam::dvec3(-1.0, 1.0, 1.0));
    let parent = glb.node(json!({ "children": [0], "matrix": mirror.to_cols_array() }));
    glb.json["scenes"][0]["nodes"] = json!([parent]);
    let camera =
        glb.push("cameras", json!({ "type": "perspective", "perspective": { "yfov": 0.6, "znear": 0.1 } }));
    glb.node(json!({ "camera": camera, "translation": [0, 1, 3] }));
    let (triangles, lower, upper) = extent(&glb);
    let (ball_lower, ball_upper) =
        icosphere(1).0.iter().fold((Vec3::MAX, Vec3::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
    assert_eq!(triangles, 80);
    let expected = |low: Vec3| vec3(5.0 + 0.3 * low.y, 0.1 + 0.1 * low.x, 0.1 * low.z);
    assert!(close(lower, expected(ball_lower)) && close(upper, expected(ball_upper)), "{lower} {upper}");
}

#[test]
fn a_mesh_of_a_project_is_one_node_or_all() {
    let mut glb = ball();
    glb.node(json!({ "name": "Other", "mesh": 0, "translation": [1, 0.1, 0] }));
    let written = Written::new(&glb.bytes());
    let mut import = written.import().unwrap();
    assert_eq!(import.scene.meshes.len(), 2);
    assert_eq!(import.scene.meshes[1].node.as_deref(), Some("Other"));
    import.scene.meshes.truncate(1);
    let scene = loaded(&import, written.folder.path());
    assert_eq!(scene.meshes().iter().map(|mesh| mesh.triangles).sum::<usize>(), 80);
    import.scene.meshes[0].node = None;
    let scene = loaded(&import, written.folder.path());
    assert_eq!(scene.meshes().iter().map(|mesh| mesh.triangles).sum::<usize>(), 160);
}
