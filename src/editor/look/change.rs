//! Changes of objects: moved, turned, scaled.

use glam::{DMat3, DQuat, DVec3, EulerRot, Vec3};
use lightloom_core::scene::light::{DirectionalLight, RectangleLight, SphereLight, SpotLight};
use lightloom_core::scene::mesh::Transform;
use lightloom_core::scene::{CameraDesc, LightDesc, ReceiverDesc, SceneDesc};
use lightloom_core::setting::Setting;

use super::lamp;
use super::object::SceneObject;

/// Places are written to the micrometre, angles to a ten thousandth of a degree.
const PLACE: f64 = 1e6;
const ANGLE: f64 = 1e4;

/// A change of one object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// Moved by a vector (m).
    Move(Vec3),
    /// Turned about an axis (unit), degrees.
    Turn(Vec3, f32),
    /// Scaled by a factor above 0.
    Scale(f32),
}

/// The scene after a change of an object about `pivot`.
///
/// # Errors
/// The reason why the object cannot be changed like this.
pub fn changed(
    scene: &SceneDesc,
    object: SceneObject,
    change: Change,
    pivot: Vec3,
) -> Result<SceneDesc, &'static str> {
    let mut scene = scene.clone();
    match object {
        SceneObject::Mesh(index) => {
            let mesh = scene.meshes.get_mut(index).ok_or("Nothing is selected")?;
            placed(&mut mesh.transform, change, pivot.as_dvec3());
        }
        SceneObject::Light(index) => {
            of_light(scene.lights.get_mut(index).ok_or("Nothing is selected")?, change)?;
        }
        SceneObject::LightTarget(index) => {
            let target = scene.lights.get_mut(index).and_then(lamp::target_of);
            of_target(target.ok_or("Nothing is selected")?, change)?;
        }
        SceneObject::Camera => of_camera(&mut scene.camera, change)?,
        SceneObject::CameraTarget => of_target(&mut scene.camera.look_at, change)?,
        SceneObject::Receiver => of_receiver(&mut scene.receiver, change),
    }
    Ok(scene)
}

/// A turn of so many degrees.
fn turn(axis: Vec3, degrees: f32) -> DQuat {
    DQuat::from_axis_angle(axis.as_dvec3().normalize_or(DVec3::Y), f64::from(degrees).to_radians())
}

/// Rounded, and never a negative zero.
fn rounded(value: f64, steps: f64) -> f64 {
    (value * steps).round() / steps + 0.0
}

/// A place, rounded.
pub(super) fn place(of: DVec3) -> [f32; 3] {
    of.to_array().map(|value| rounded(value, PLACE) as f32)
}

fn moved(place_of: &mut [f32; 3], by: Vec3) {
    *place_of = place(Vec3::from(*place_of).as_dvec3() + by.as_dvec3());
}

/// Angles about X, then Y, then Z after a turn, degrees.
fn turned([x, y, z]: [f32; 3], by: DQuat) -> [f32; 3] {
    let [x, y, z] = [x, y, z].map(|degrees| f64::from(degrees).to_radians());
    let matrix = DMat3::from_quat(by) * DMat3::from_euler(EulerRot::ZYX, z, y, x);
    let (z, y, x) = matrix.to_euler(EulerRot::ZYX);
    // + 0.0: no "-0".
    [x, y, z].map(|radians| rounded(radians.to_degrees(), ANGLE) as f32)
}

fn placed(transform: &mut Transform, change: Change, pivot: DVec3) {
    let offset = DVec3::from(transform.translate) - pivot;
    let offset = match change {
        Change::Move(by) => offset + by.as_dvec3(),
        Change::Turn(axis, degrees) => {
            transform.rotate = turned(transform.rotate, turn(axis, degrees));
            turn(axis, degrees) * offset
        }
        Change::Scale(factor) => {
            let scale = clamped(Transform::SCALE, transform.scale * factor);
            let offset = offset * f64::from(scale / transform.scale);
            transform.scale = scale;
            offset
        }
    };
    transform.translate = (pivot + offset).to_array().map(|value| rounded(value, PLACE));
}

/// Within the range of a setting.
fn clamped(setting: Setting, value: f32) -> f32 {
    let [low, high] = setting.range.map(|end| end as f32);
    value.clamp(low, high)
}

fn of_light(light: &mut LightDesc, change: Change) -> Result<(), &'static str> {
    match change {
        Change::Move(by) => {
            let position = lamp::position_of(light);
            moved(position.ok_or("A directional light stands nowhere; turn it")?, by);
        }
        Change::Turn(axis, degrees) => turn_light(light, turn(axis, degrees))?,
        Change::Scale(factor) => match light {
            LightDesc::Point(_) => return Err("A point light has no size"),
            LightDesc::Spot(light) => light.angle_deg = clamped(SpotLight::ANGLE, light.angle_deg * factor),
            LightDesc::Directional(light) => {
                light.angle_deg = clamped(DirectionalLight::ANGLE, light.angle_deg * factor);
            }
            LightDesc::Rectangle(light) => {
                light.size = light.size.map(|side| clamped(RectangleLight::SIZE, side * factor));
            }
            LightDesc::Sphere(light) => light.radius = clamped(SphereLight::RADIUS, light.radius * factor),
        },
    }
    Ok(())
}

fn turn_light(light: &mut LightDesc, by: DQuat) -> Result<(), &'static str> {
    if let LightDesc::Directional(light) = light {
        light.direction = place(by * Vec3::from(light.direction).as_dvec3());
        return Ok(());
    }
    let Some(position) = light.position().map(Vec3::as_dvec3) else { return Ok(()) };
    let target = lamp::target_of(light).ok_or("A light that shines to all sides cannot be turned")?;
    *target = place(position + by * (Vec3::from(*target).as_dvec3() - position));
    Ok(())
}

fn of_target(target: &mut [f32; 3], change: Change) -> Result<(), &'static str> {
    let Change::Move(by) = change else { return Err("A target can only be moved") };
    moved(target, by);
    Ok(())
}

fn of_camera(camera: &mut CameraDesc, change: Change) -> Result<(), &'static str> {
    match change {
        Change::Move(by) => moved(&mut camera.position, by),
        Change::Scale(_) => return Err("The camera has no size; change its field of view in the panel"),
        Change::Turn(axis, degrees) => {
            let (by, position) = (turn(axis, degrees), Vec3::from(camera.position).as_dvec3());
            let view = Vec3::from(camera.look_at).as_dvec3() - position;
            let turned = by * view;
            if turned.distance(view) < 1e-5 * view.length() {
                // About its own view: the horizon tilts.
                camera.up = place(by * Vec3::from(camera.up).as_dvec3());
            } else {
                camera.look_at = place(position + turned);
            }
        }
    }
    Ok(())
}

fn of_receiver(receiver: &mut ReceiverDesc, change: Change) {
    match change {
        Change::Move(by) => moved(&mut receiver.centre, by),
        Change::Turn(axis, degrees) => receiver.rotate = turned(receiver.rotate, turn(axis, degrees)),
        Change::Scale(factor) => {
            receiver.size = receiver.size.map(|side| clamped(ReceiverDesc::SIZE, side * factor));
        }
    }
}
