//! Scene actions of one step: on the table, aimed, duplicated, deleted, switched off, alone.

use glam::{DVec3, Vec3};
use lightloom_core::scene::SceneDesc;

use super::bounds::{Loaded, pivot};
use super::change::{Change, changed, place};
use super::lamp;
use super::object::SceneObject;
use crate::editor::unique_name::unique_name;

/// A scene after an action, or the reason why there is none.
pub type Arranged = Result<SceneDesc, &'static str>;

/// Where a lamp or the camera is aimed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// At the middle of the glass or mirror that is nearest.
    Glass,
    /// At the centre of the receiver.
    Receiver,
}

/// A mesh set onto the receiver's plane, along its normal.
pub fn on_table(scene: &SceneDesc, object: SceneObject, loaded: Option<Loaded>) -> Arranged {
    let SceneObject::Mesh(index) = object else { return Err("Only meshes stand on the table") };
    let corners = loaded.and_then(|loaded| loaded.corners(scene, index));
    let corners = corners.ok_or("The mesh is not loaded yet")?;
    let (_, receiver) = scene.camera_and_receiver().map_err(|_| "The receiver has no plane")?;
    let floor = Vec3::from(scene.receiver.centre);
    let height = |corner: &Vec3| (*corner - floor).dot(receiver.normal());
    let lowest = corners.iter().map(height).fold(f32::INFINITY, f32::min);
    changed(scene, object, Change::Move(-lowest * receiver.normal()), Vec3::ZERO)
}

/// A lamp or the camera aimed at something else.
pub fn aimed(scene: &SceneDesc, object: SceneObject, aim: Aim, loaded: Option<Loaded>) -> Arranged {
    let from = pivot(scene, object, loaded).ok_or("Nothing is selected")?;
    let at = match aim {
        Aim::Receiver => scene.receiver.centre.into(),
        Aim::Glass => nearest_glass(scene, from, loaded)
            .ok_or("There is no glass or mirror, or it is not loaded yet")?,
    };
    let mut scene = scene.clone();
    let written = place(at.as_dvec3());
    match object {
        SceneObject::Light(index) | SceneObject::LightTarget(index) => {
            let light = scene.lights.get_mut(index).ok_or("Nothing is selected")?;
            if let lightloom_core::scene::LightDesc::Directional(_) = light {
                return Err("A directional light shines everywhere alike; turn it");
            }
            *lamp::target_of(light).ok_or("A light that shines to all sides needs no aim")? = written;
        }
        SceneObject::Camera | SceneObject::CameraTarget => scene.camera.look_at = written,
        SceneObject::Mesh(_) | SceneObject::Receiver => return Err("Only lamps and the camera are aimed"),
    }
    Ok(scene)
}

fn nearest_glass(scene: &SceneDesc, from: Vec3, loaded: Option<Loaded>) -> Option<Vec3> {
    let loaded = loaded?;
    let glass = loaded.scene.meshes().iter().filter(|mesh| mesh.material.is_specular());
    let middles = glass.filter_map(|mesh| pivot(scene, SceneObject::Mesh(mesh.desc), Some(loaded)));
    middles.min_by(|a, b| a.distance(from).total_cmp(&b.distance(from)))
}

/// A copy of an object beside it, and the copy.
///
/// # Errors
/// The camera and the receiver stand once.
pub fn duplicated(
    scene: &SceneDesc,
    object: SceneObject,
    loaded: Option<Loaded>,
) -> Result<(SceneDesc, SceneObject), &'static str> {
    let mut copy = scene.clone();
    match object {
        SceneObject::Mesh(index) => {
            let mut mesh = scene.meshes.get(index).ok_or("Nothing is selected")?.clone();
            let corners = loaded.and_then(|loaded| loaded.corners(scene, index));
            let width = corners.map_or(0.1, |corners| {
                let x = corners.map(|corner| corner.x);
                x.into_iter().fold(f32::MIN, f32::max) - x.into_iter().fold(f32::MAX, f32::min)
            });
            mesh.name = unique_name(&mesh.name, |name| scene.meshes.iter().any(|mesh| mesh.name == name));
            // Beside it: glass in glass would merge.
            let beside = DVec3::from(mesh.transform.translate) + DVec3::X * f64::from(width * 1.1);
            mesh.transform.translate = beside.to_array().map(|value| (value * 1e6).round() / 1e6);
            copy.meshes.push(mesh);
            Ok((copy, SceneObject::Mesh(scene.meshes.len())))
        }
        SceneObject::Light(index) | SceneObject::LightTarget(index) => {
            let mut light = scene.lights.get(index).ok_or("Nothing is selected")?.clone();
            let name =
                unique_name(light.name(), |name| scene.lights.iter().any(|light| light.name() == name));
            *lamp::name_of(&mut light) = name;
            if let Some(position) = lamp::position_of(&mut light) {
                position[0] += 0.2 * scene.receiver.size[0].max(scene.receiver.size[1]);
            }
            copy.lights.push(light);
            Ok((copy, SceneObject::Light(scene.lights.len())))
        }
        SceneObject::Camera | SceneObject::CameraTarget | SceneObject::Receiver => {
            Err("A scene has one camera and one receiver")
        }
    }
}

/// The scene without an object.
pub fn deleted(scene: &SceneDesc, object: SceneObject) -> Arranged {
    if !object.is_in(scene) {
        return Err("Nothing is selected");
    }
    let mut scene = scene.clone();
    match object {
        SceneObject::Mesh(index) => drop(scene.meshes.remove(index)),
        SceneObject::Light(index) => drop(scene.lights.remove(index)),
        SceneObject::LightTarget(_)
        | SceneObject::Camera
        | SceneObject::CameraTarget
        | SceneObject::Receiver => {
            return Err("A scene keeps its camera and its receiver");
        }
    }
    Ok(scene)
}

/// Which lights, or which meshes, are on.
fn switches(scene: &mut SceneDesc, object: SceneObject) -> Vec<&mut bool> {
    match object {
        SceneObject::Mesh(_) => scene.meshes.iter_mut().map(|mesh| &mut mesh.enabled).collect(),
        SceneObject::Light(_) | SceneObject::LightTarget(_) => {
            scene.lights.iter_mut().map(lamp::enabled_of).collect()
        }
        SceneObject::Camera | SceneObject::CameraTarget | SceneObject::Receiver => Vec::new(),
    }
}

fn number(object: SceneObject) -> usize {
    object.mesh().or(object.light()).unwrap_or(0)
}

/// A light or mesh switched off, or on again.
pub fn switched(scene: &SceneDesc, object: SceneObject) -> Arranged {
    let mut scene = scene.clone();
    let mut switches = switches(&mut scene, object);
    let own = switches.get_mut(number(object)).ok_or("Only lights and meshes are switched off")?;
    **own = !**own;
    Ok(scene)
}

/// A light or mesh on, and all others of its kind off; where that is so already, all on.
pub fn alone(scene: &SceneDesc, object: SceneObject) -> Arranged {
    let is_alone = is_alone(scene, object);
    let mut scene = scene.clone();
    let switches = switches(&mut scene, object);
    if switches.is_empty() {
        return Err("Only lights and meshes are soloed");
    }
    for (index, switch) in switches.into_iter().enumerate() {
        *switch = is_alone || index == number(object);
    }
    Ok(scene)
}

/// Whether a light or mesh is the only one of its kind that is on, of several.
pub fn is_alone(scene: &SceneDesc, object: SceneObject) -> bool {
    let on: Vec<bool> = match object {
        SceneObject::Mesh(_) => scene.meshes.iter().map(|mesh| mesh.enabled).collect(),
        _ => scene.lights.iter().map(|light| light.is_enabled()).collect(),
    };
    let only = |(index, on): (usize, &bool)| *on == (index == number(object));
    on.len() > 1 && on.iter().enumerate().all(only)
}
