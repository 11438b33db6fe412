//! Where a new picture lies: on the light that becomes it, as large as that, in view and upright.

use std::path::Path;

use lightloom_core::Progress;
use lightloom_core::engine::Engine;
use lightloom_core::glam::{Vec2, vec2};
use lightloom_core::project::{AssetFolder, Project, Shows};
use lightloom_core::targets::{ImageTarget, Placement};

use crate::root;

/// The example of a goblet, on a table of `side` metres.
fn goblet(side: f32) -> Project {
    let mut project = Project::load(&root().join("projects/dark_glass.json")).unwrap();
    let scene = project.scene.as_mut().unwrap();
    scene.receiver.size = [side, side];
    project.keys[1].shows = Shows::PhysicalCaustic;
    project
}

fn placed(project: &Project, rotate: f32) -> Placement {
    let place = root().join("projects/dark_glass.json");
    let engine = Engine::new(AssetFolder::new(&place, false).unwrap());
    let mut target = ImageTarget::new("../assets/targets/star.png");
    target.placement.rotate = rotate;
    let picture: &Path = &root().join("assets/targets/star.png");
    engine.placement(project, (1, None), (picture, &target), &Progress::new()).unwrap()
}

/// Width in metres and centre in the world of a placement.
fn in_world(project: &Project, placement: &Placement) -> (f32, Vec2) {
    let receiver = &project.scene.as_ref().unwrap().receiver;
    let side = receiver.size[0];
    let [x, y] = placement.centre.unwrap();
    let from_middle = (vec2(x, y) - 0.5) * side;
    (
        placement.width.unwrap() * side,
        vec2(receiver.centre[0] + from_middle.x, receiver.centre[2] - from_middle.y),
    )
}

#[test]
fn a_picture_is_as_large_as_its_light_however_large_the_table() {
    let (small, large) = (goblet(1.0), goblet(1.6));
    let [(width, centre), (on_large, there)] =
        [&small, &large].map(|project| in_world(project, &placed(project, 0.0)));
    // The soft border takes light of the small table, and other photons tell where it lies.
    assert!((on_large / width - 1.0).abs() < 0.3, "{width} m and {on_large} m");
    assert!(centre.distance(there) < 0.05, "{centre} {there}");
    // By itself it would fill the table.
    assert!(on_large < 0.5, "{on_large} m");
}

#[test]
fn all_of_a_picture_is_in_view_and_upright() {
    let mut project = goblet(1.5);
    let receiver = project.scene.as_ref().unwrap().receiver.clone();
    let (camera_height, distance) = (0.9, 0.9);
    // From each side of the table, looking beside the light.
    for (side, rotate) in [([0.0, 1.0], 0.0), ([1.0, 0.0], 90.0), ([0.0, -1.0], 180.0), ([-1.0, 0.0], -90.0)]
    {
        let camera = &mut project.scene.as_mut().unwrap().camera;
        let at = |share: f32| [receiver.centre[0] + share * side[0], receiver.centre[2] + share * side[1]];
        let ([x, z], [u, w]) = (at(distance), at(0.1));
        camera.position = [x, receiver.centre[1] + camera_height, z];
        camera.look_at = [u + 0.05, receiver.centre[1], w];
        camera.up = [0.0, 1.0, 0.0];
        camera.fov_deg = 22.0;
        let placement = placed(&project, 0.0);
        assert!(
            (placement.rotate.rem_euclid(360.0) - f32::rem_euclid(rotate, 360.0)).abs() < 1e-3,
            "{placement:?}"
        );
        let scene = project.scene.as_ref().unwrap();
        let camera = scene.camera.resolve("camera").unwrap();
        let (width, centre) = in_world(&project, &placement);
        let aspect = project.render.width as f32 / project.render.height as f32;
        // The star fills its picture but for a small rim; a quarter turn leaves a square where it is.
        for corner in [vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, 1.0)] {
            let on_table = centre + corner * 0.45 * width;
            let world = [on_table.x, receiver.centre[1], on_table.y].into();
            let seen = camera.project(world, aspect).unwrap();
            assert!(seen.abs().max_element() < 1.0, "{seen} from {side:?}");
        }
    }
}

#[test]
fn without_a_physical_caustic_a_picture_stays_where_it_was_put() {
    let mut project = goblet(1.0);
    for key in &mut project.keys {
        key.shows = Shows::Image(ImageTarget::new("../assets/targets/star.png"));
    }
    assert_eq!(placed(&project, 30.0), Placement { rotate: 30.0, ..Placement::default() });
    // What is turned by hand stays turned.
    assert_eq!(placed(&goblet(1.0), 30.0).rotate, 30.0);
}
