//! The camera against the formulas of projection: lens shift.

use lightloom_core::glam::{Vec3, vec2, vec3};
use lightloom_core::scene::CameraDesc;
use lightloom_core::scene::camera::Camera;

fn camera(shift: [f32; 2]) -> Camera {
    let desc =
        CameraDesc { position: [0.3, 1.1, 1.6], look_at: [0.1, 0.2, -0.3], shift, ..Default::default() };
    desc.resolve("camera").unwrap()
}

#[test]
fn a_shifted_picture_is_a_part_of_a_larger_one() {
    // Half the width to the right: the right half of a picture of twice the width, by the same lens.
    let (wide, right) = (camera([0.0; 2]), camera([0.5, 0.0]));
    for (x, y) in [(-1.0, -1.0), (0.2, 0.7), (1.0, 0.0)] {
        let expected = wide.ray((x + 1.0) / 2.0, y, 3.2).direction;
        let found = right.ray(x, y, 1.6).direction;
        assert!(expected.distance(found) < 1e-6, "{expected} {found}");
    }
}

#[test]
fn a_shift_moves_the_picture_by_its_share_of_width_and_height() {
    let (straight, shifted) = (camera([0.0; 2]), camera([0.1, -0.25]));
    for point in [vec3(0.0, 0.1, 0.0), vec3(-0.4, 0.5, -0.2), vec3(0.6, 0.0, 0.4)] {
        let [from, to] = [&straight, &shifted].map(|camera| camera.project(point, 1.5).unwrap());
        // The picture is 2 wide and 2 high; what is seen moves against the shift.
        assert!((to - from - vec2(-0.2, 0.5)).length() < 1e-5, "{from} {to}");
        let ray = shifted.ray(to.x, to.y, 1.5);
        let off = (point - ray.origin).reject_from(ray.direction).length();
        assert!(off < 1e-5, "{off} m beside the ray");
    }
}

#[test]
fn upright_edges_stay_parallel_where_a_level_camera_is_shifted() {
    let desc = CameraDesc {
        position: [0.0, 1.0, 3.0],
        look_at: [0.0, 1.0, 0.0],
        shift: [0.0, -0.4],
        ..Default::default()
    };
    let camera = desc.resolve("camera").unwrap();
    for x in [-0.7, 0.0, 0.5] {
        let ends = [0.0, 0.8].map(|y| camera.project(Vec3::new(x, y, 0.0), 1.0).unwrap().x);
        assert!((ends[0] - ends[1]).abs() < 1e-6, "{ends:?}");
    }
}

#[test]
fn a_shift_out_of_range_is_refused_by_its_place() {
    let desc = CameraDesc { shift: [0.0, f32::NAN], ..Default::default() };
    let error = desc.check("scene.camera").unwrap_err().to_string();
    assert!(error.starts_with("scene.camera.shift"), "{error}");
}
