//! The meshes of glTF files as groups of faces by material. A file that several meshes of a project name is read once.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::desc::MeshDesc;
use super::obj::{Face, Group, NONE, Placement};
use crate::scene::gltf::{GltfFile, Shape};
use crate::scene::material::{Diffuse, Material};
use crate::{Progress, Result};

/// The files that were read, by their paths.
#[derive(Default)]
pub(in crate::scene) struct GltfFiles(HashMap<PathBuf, GltfFile>);

impl GltfFiles {
    fn file(&mut self, path: &Path, progress: &Progress) -> Result<&GltfFile> {
        if !self.0.contains_key(path) {
            self.0.insert(path.to_owned(), GltfFile::read(path, progress)?);
        }
        Ok(&self.0[path])
    }

    /// Index of the material and faces of each material, as placed; in the order of the file.
    pub(super) fn groups(
        &mut self,
        desc: &MeshDesc,
        path: &Path,
        placement: &impl Placement,
        notes: &mut Vec<String>,
        progress: &Progress,
    ) -> Result<Vec<(Option<usize>, Group)>> {
        let file = self.file(path, progress)?;
        let mut groups: Vec<(Option<usize>, Group)> = Vec::new();
        let mut by_material: HashMap<Option<usize>, usize> = HashMap::new();
        for (_, shapes) in file.shapes(desc.node.as_deref(), notes, progress)? {
            for shape in shapes {
                let material = shape.material;
                let at = *by_material.entry(material).or_insert(groups.len());
                if at == groups.len() {
                    groups.push((material, Group::default()));
                }
                groups[at].1.append(group(shape, placement));
            }
        }
        Ok(groups)
    }

    /// Name, material and faces of the objects of a mesh that were read by [`Self::groups`].
    pub(super) fn objects(
        &mut self,
        desc: &MeshDesc,
        path: &Path,
        groups: Vec<(Option<usize>, Group)>,
        notes: &mut Vec<String>,
    ) -> Result<Vec<(String, Material, Group)>> {
        if let Some(material) = &desc.material {
            let all = Group::joined(groups.into_iter().map(|(_, group)| group));
            return Ok(vec![(desc.name.clone(), material.clone(), all)]);
        }
        let file = self.file(path, &Progress::new())?;
        let single = groups.len() == 1;
        let object = |(index, group): (Option<usize>, Group)| {
            let looks = file.looks(index, mean_thickness(&group));
            let name = if looks.name.is_empty() { "no material" } else { &looks.name };
            let label = if single { desc.name.clone() } else { format!("{}/{name}", desc.name) };
            notes.extend(looks.notes.iter().map(|note| format!("{label}: {note}")));
            let material = looks.material.unwrap_or_else(|| {
                notes.push(format!("{label}: its material says nothing; taken as matt grey"));
                Material::Diffuse(Diffuse::default())
            });
            (label, material, group)
        };
        Ok(groups.into_iter().map(object).collect())
    }
}

fn group(shape: Shape, placement: &impl Placement) -> Group {
    let with_normals = !shape.normals.is_empty();
    let normal = |normal: &glam::Vec3| placement.normal(normal.as_dvec3()).as_vec3();
    Group {
        positions: shape.positions.iter().map(|p| placement.position(*p).as_vec3()).collect(),
        normals: shape.normals.iter().map(normal).collect(),
        faces: shape
            .faces
            .into_iter()
            .map(|vertices| Face { vertices, normals: if with_normals { vertices } else { [NONE; 3] } })
            .collect(),
        crossed: 0,
    }
}

fn mean_thickness(group: &Group) -> f64 {
    let corners = |face: &Face| face.vertices.map(|vertex| group.positions[vertex as usize].as_dvec3());
    crate::scene::gltf::mean_thickness(group.faces.iter().map(corners))
}
