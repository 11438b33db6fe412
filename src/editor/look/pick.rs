//! Picking: what is under the pointer.

use egui::Pos2;
use glam::Vec3;
use lightloom_core::scene::{SceneDesc, SurfaceId};

use super::bounds::{Loaded, lamp_place, pivot};
use super::object::SceneObject;
use super::viewpoint::Viewpoint;

/// Reach of the handle of a lamp, the camera or a target, points.
const REACH: f32 = 11.0;

/// The object at a point of the screen: handles before surfaces, which are found by the scene's own hierarchy. The targets of
/// a `selected` lamp or camera are handles, too.
pub fn pick(
    at: Pos2,
    view: &Viewpoint,
    scene: &SceneDesc,
    loaded: Option<Loaded>,
    selected: Option<SceneObject>,
) -> Option<SceneObject> {
    handle(at, view, scene, selected).or_else(|| surface(at, view, scene, loaded?))
}

/// The lamps, the camera, and the targets that are drawn, each with its place.
pub(super) fn handles(scene: &SceneDesc, selected: Option<SceneObject>) -> Vec<(SceneObject, Vec3)> {
    let lamp = |(index, light)| (SceneObject::Light(index), lamp_place(scene, light));
    let mut all: Vec<_> = scene.lights.iter().enumerate().map(lamp).collect();
    all.push((SceneObject::Camera, scene.camera.position.into()));
    let target = match selected {
        Some(SceneObject::Light(index) | SceneObject::LightTarget(index)) => {
            Some(SceneObject::LightTarget(index))
        }
        Some(SceneObject::Camera | SceneObject::CameraTarget) => Some(SceneObject::CameraTarget),
        _ => None,
    };
    all.extend(target.and_then(|target| Some((target, pivot(scene, target, None)?))));
    all
}

fn handle(
    at: Pos2,
    view: &Viewpoint,
    scene: &SceneDesc,
    selected: Option<SceneObject>,
) -> Option<SceneObject> {
    let near = handles(scene, selected).into_iter().filter_map(|(object, place)| {
        let distance = view.screen(place)?.distance(at);
        (distance <= REACH).then_some((object, distance))
    });
    near.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(object, _)| object)
}

fn surface(at: Pos2, view: &Viewpoint, scene: &SceneDesc, loaded: Loaded) -> Option<SceneObject> {
    let hit = loaded.scene.intersect(&view.ray(at))?;
    let object = match (hit.surface, loaded.scene.mesh_of(hit.surface)) {
        (SurfaceId::Receiver, _) => SceneObject::Receiver,
        (_, Some(mesh)) => SceneObject::Mesh(loaded.scene.meshes()[usize::from(mesh)].desc),
        _ => return None,
    };
    object.is_in(scene).then_some(object)
}
