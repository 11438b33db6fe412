//! The scene of a draft, set right: scaled, on its table, lit and looked at.

use std::path::Path;

use glam::Vec3;

use super::draft::{Bounds, Draft};
use super::flat::Rectangle;
use super::imported::Import;
use super::paths::assets_of;
use super::summary::Summary;
use super::{camera, empty, lamp, receiver};
use crate::scene::{Geometry, LightDesc, SceneDesc};
use crate::{Error, Progress, Result};

/// Sizes (m) of things that are taken to be in metres.
const USUAL: std::ops::Range<f32> = 0.02..5.0;
/// The same in a format that is always in metres.
const USUAL_IN_METRES: std::ops::Range<f32> = 0.002..30.0;
/// Units that files are in, in the order in which they are tried (m).
const UNITS: [(f32, &str); 3] = [(0.001, "millimetres"), (0.01, "centimetres"), (0.1, "decimetres")];
/// Makes what the file does not give, and reads all meshes once: what cannot be read is told now.
pub(super) fn complete(mut draft: Draft, path: &Path, progress: &Progress) -> Result<Import> {
    draft.ensure_casters();
    let glass = draft.glass().ok_or_else(|| Error::format(path, "", "has no triangles: nothing to show"))?;
    let table = receiver::found(&mut draft, &glass);
    let own = !draft.lights.is_empty() || draft.camera.is_some() || table.is_some();
    let glass = if own { glass } else { set_down(&mut draft, glass) };
    let has_lamps = !draft.lights.is_empty();
    if !has_lamps {
        let place = draft.lost_lamps.first().copied();
        draft.lights.push(lamp::aimed_at(&glass, place));
        let made =
            if place.is_some() { "a spot stands in the place of the lost lamp" } else { "a spot was made" };
        draft.notes.push(format!("no lamp: {made} and aimed at the glass"));
    }
    unique_lamps(&mut draft.lights);
    draft.notes.extend(lamp::note_on_pools(&draft.lights, &glass));
    let lowest = draft.all().unwrap_or(glass).lower.y;
    let made = Rectangle::horizontal(glass.centre().with_y(lowest));
    let plane = table.as_ref().map_or(made, |(plane, ..)| *plane);
    let needed = receiver::needed(&plane, &glass, &draft.lights);
    let receiver_name = table.as_ref().map(|(_, name, _)| name.clone());
    let receiver = match &table {
        Some((plane, name, albedo)) => receiver::on_plane(plane, name, *albedo, &needed, &mut draft.notes),
        None => receiver::made(&needed),
    };
    let cameras = draft.cameras;
    let (camera, aspect) = draft.camera.unwrap_or_else(|| (camera::framing(&glass, &receiver), None));
    let scene = SceneDesc {
        meshes: draft.objects.into_iter().map(|object| object.desc).collect(),
        lights: draft.lights,
        camera,
        receiver,
        environment: empty::sky(),
    };
    scene.check("scene").map_err(|error| Error::format(path, "", error.to_string()))?;
    let (geometry, more) = Geometry::load(&scene.meshes, &assets_of(path)?, progress)?;
    let mut notes = draft.notes;
    more.into_iter().for_each(|note| {
        if !notes.contains(&note.text) {
            notes.push(note.text);
        }
    });
    let triangles = geometry.meshes().iter().map(|mesh| mesh.triangles as u64).sum();
    let casters = geometry.meshes().iter().filter(|mesh| mesh.material.is_specular()).count();
    let summary = Summary::new(&scene, has_lamps, receiver_name, notes).counting(
        triangles,
        draft.materials,
        casters,
        cameras,
    );
    let folder = path.parent().unwrap_or(Path::new(""));
    let files = std::iter::once(path.to_owned()).chain(draft.files.iter().map(|file| folder.join(file)));
    Ok(Import { files: files.collect(), scene, aspect, summary })
}

/// Scales and moves meshes that stand anywhere to the middle of a table; returns the glass as it is then.
fn set_down(draft: &mut Draft, glass: Bounds) -> Bounds {
    let Some(all) = draft.all() else { return glass };
    let size = (all.upper - all.lower).max_element();
    let usual = if draft.in_metres { USUAL_IN_METRES } else { USUAL };
    let scale = match usual.contains(&size) {
        true => 1.0,
        false => scale_of(size, &mut draft.notes),
    };
    let middle = all.centre().with_y(all.lower.y);
    let by: Vec3 = -middle * scale;
    for object in &mut draft.objects {
        object.desc.transform.scale = scale;
        object.desc.transform.translate = by.to_array().map(|n| f64::from(n) + 0.0);
        object.bounds = object.bounds.moved(scale, by);
    }
    glass.moved(scale, by)
}

/// The factor for a file of another unit.
fn scale_of(size: f32, notes: &mut Vec<String>) -> f32 {
    let unit = UNITS.iter().find(|(metres, _)| USUAL.contains(&(size * metres)));
    if let Some((metres, name)) = unit.filter(|_| size > USUAL.start) {
        notes.push(format!("is {size:.3} wide, taken as {name}: scaled by {metres} (transform.scale)"));
        return *metres;
    }
    let factor = 10_f32.powi((0.1 / size).log10().round().clamp(-11.0, 11.0) as i32);
    notes.push(format!("is {size:.3e} wide: scaled by {factor:e} to be seen (transform.scale)"));
    factor
}

/// Gives lamps of the same name numbers.
fn unique_lamps(lights: &mut [LightDesc]) {
    for index in 1..lights.len() {
        let (before, rest) = lights.split_at_mut(index);
        let name = rest[0].name().to_owned();
        if before.iter().any(|other| other.name() == name) {
            rest[0].rename(format!("{name} {}", index + 1));
        }
    }
}
