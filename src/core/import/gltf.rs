//! What a glTF file gives: a mesh for each of its objects, its lamps, its first camera.

use std::collections::BTreeSet;
use std::path::Path;

use glam::{DVec3, Vec3};

use super::draft::{Bounds, Draft, Object, shortened};
use super::flat;
use super::paths::file_name;
use crate::scene::gltf::{GltfFile, Node, Shape, mean_thickness};
use crate::scene::material::{Diffuse, Glass};
use crate::scene::{Material, MeshDesc};
use crate::{Progress, Result};

pub(super) fn read(path: &Path, progress: &Progress) -> Result<Draft> {
    let file = GltfFile::read(path, progress)?;
    let mut draft = Draft { in_metres: true, notes: file.left_out().to_vec(), ..Draft::default() };
    draft.files = file.buffer_files();
    let (mut materials, mut unsaid) = (BTreeSet::new(), Vec::new());
    for (node, shapes) in file.shapes(None, &mut draft.notes, progress)? {
        progress.check()?;
        materials.extend(shapes.iter().map(|shape| shape.material));
        let made = object(&file, (node, path), &shapes, &mut draft.notes, &mut unsaid)?;
        draft.objects.extend(made);
    }
    draft.materials = materials.into_iter().flatten().count();
    if !unsaid.is_empty() {
        draft.notes.push(format!("no material, or an empty one: taken as glass: {}", shortened(&unsaid)));
    }
    let (mut lost, mut bare) = (Vec::new(), Vec::new());
    for node in file.nodes() {
        draft.lights.extend(file.light(node, &mut draft.notes)?);
        if let Some(camera) = file.camera(node, &mut draft.notes)? {
            draft.cameras += 1;
            draft.camera.get_or_insert(camera);
        }
        if file.is_lost_lamp(node) {
            draft.lost_lamps.push(node.world.transform_point3(DVec3::ZERO).as_vec3());
            lost.push(node.name.clone());
        } else if file.is_bare(node) {
            bare.push(node.name.clone());
        }
    }
    if !lost.is_empty() {
        draft.notes.push(format!(
            "looks like a lamp that was lost: {}; glTF has no area lights: use a point or a spot, or Lightloom's add-on \
             for Blender, which keeps them",
            shortened(&lost)
        ));
    }
    if !bare.is_empty() {
        draft.notes.push(format!(
            "holds nothing: {}; was it an area light, set it anew: glTF has none, and Lightloom's add-on for Blender keeps them",
            shortened(&bare)
        ));
    }
    if draft.cameras > 1 {
        draft.notes.push(format!("of {} cameras the first is taken", draft.cameras));
    }
    Ok(draft)
}

/// The mesh of a node; none without triangles.
fn object(
    file: &GltfFile,
    (node, path): (&Node, &Path),
    shapes: &[Shape],
    notes: &mut Vec<String>,
    unsaid: &mut Vec<String>,
) -> Result<Option<Object>> {
    let points = shapes.iter().flat_map(|shape| &shape.positions).map(|point| point.as_vec3());
    let Some(bounds) = Bounds::of_points(points) else { return Ok(None) };
    let flat = flat::rectangle(shapes);
    let mut desc = MeshDesc { node: Some(node.name.clone()), ..MeshDesc::new(&node.name, file_name(path)?) };
    let used: BTreeSet<Option<usize>> = shapes.iter().map(|shape| shape.material).collect();
    let faces = shapes
        .iter()
        .flat_map(|shape| shape.faces.iter().map(|face| face.map(|vertex| shape.positions[vertex as usize])));
    let thickness = mean_thickness(faces);
    let looks: Vec<_> = used.iter().map(|index| file.looks(*index, thickness)).collect();
    let said: Vec<&Material> = looks.iter().filter_map(|looks| looks.material.as_ref()).collect();
    let mut is_caster = said.iter().any(|material| material.is_specular());
    match (said.as_slice(), looks.as_slice()) {
        ([], _) if flat.is_some() => desc.material = Some(Material::Diffuse(Diffuse::default())),
        ([], _) => {
            unsaid.push(node.name.clone());
            desc.material = Some(Material::Glass(Glass::default()));
            is_caster = true;
        }
        ([one], [_]) => desc.material = Some((*one).clone()),
        // One object for each material of the file.
        _ => (),
    }
    notes.extend(looks.iter().flat_map(|looks| &looks.notes).map(|note| format!("{}: {note}", node.name)));
    // What is seen from far outside of a scene is its sky or its room.
    let finite = bounds.lower.is_finite() && bounds.upper.cmplt(Vec3::INFINITY).all();
    Ok(finite.then_some(Object { desc, bounds, flat, is_caster }))
}
