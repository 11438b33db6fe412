//! Wavefront OBJ: vertices, normals, faces, material names. The package `tobj` reads the format; before it, [`repair`] mends
//! what it refuses. Unknown statements are ignored, as the format requires; errors name the line. Files are untrusted: every
//! index is checked, nothing is allocated by their word.

mod polygon;
mod repair;

use std::path::Path;

use glam::{DVec3, Vec3};
use tobj::{LoadOptions, Model};

use self::polygon::Splitter;
use self::repair::Repair;
use crate::files::read_regular_file;
use crate::{Error, Progress, Result};

/// Largest file read [bytes].
pub(super) const MAX_BYTES: u64 = 8 << 30;
/// No normal given.
pub(super) const NONE: u32 = u32::MAX;

/// A triangle by indices into [`Group`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Face {
    pub vertices: [u32; 3],
    /// [`NONE`] where the file gives none.
    pub normals: [u32; 3],
}

/// All faces of one material; indices are checked.
#[derive(Debug, Default)]
pub(super) struct Group {
    /// As placed; beyond the range of f32 infinite.
    pub positions: Vec<Vec3>,
    /// Not normalized; may be zero.
    pub normals: Vec<Vec3>,
    pub faces: Vec<Face>,
    /// Polygons that cross themselves, or have too many corners to be split along their outline.
    pub crossed: usize,
}

/// The content of a file.
#[derive(Debug, Default)]
pub(super) struct ObjFile {
    /// Name by `usemtl`, empty for faces before any, and faces; in the order of the names in the file.
    pub groups: Vec<(String, Group)>,
    /// The rest of every `mtllib` line.
    pub libraries: Vec<String>,
    /// Normals that are no finite numbers, and the line of the first; they are read as zero.
    pub bad_normals: (usize, usize),
}

/// Where the vertices and normals of a file come to lie.
pub(super) trait Placement {
    fn position(&self, position: DVec3) -> DVec3;
    fn normal(&self, normal: DVec3) -> DVec3;
}

/// Reads a file and places it.
pub(super) fn read(path: &Path, placement: &impl Placement, progress: &Progress) -> Result<ObjFile> {
    parse(&read_regular_file(path, MAX_BYTES)?, path, placement, progress)
}

fn parse(bytes: &[u8], path: &Path, placement: &impl Placement, progress: &Progress) -> Result<ObjFile> {
    let mut repair = Repair::new(bytes, path, progress)?;
    let options = LoadOptions { single_index: false, triangulate: false, ..LoadOptions::default() };
    let (models, _) = tobj::load_obj_buf(&mut repair, &options, |_| Err(tobj::LoadError::ReadError))
        .map_err(|error| {
            repair.failure.take().unwrap_or_else(|| Error::format(path, "", error.to_string()))
        })?;
    let mut groups: Vec<Group> = repair.materials.iter().map(|_| Group::default()).collect();
    let mut splitter = Splitter::default();
    for model in models {
        progress.check()?;
        if let Some(group) = model.name.parse().ok().and_then(|name: usize| groups.get_mut(name)) {
            group.add(model, placement, (&mut splitter, progress))?;
        }
    }
    let groups = repair.materials.into_iter().zip(groups).filter(|(_, group)| !group.faces.is_empty());
    Ok(ObjFile { groups: groups.collect(), libraries: repair.libraries, bad_normals: repair.bad_normals })
}

impl Group {
    /// Adds the polygons of a model, as triangles.
    fn add(
        &mut self,
        model: Model,
        placement: &impl Placement,
        (splitter, progress): (&mut Splitter, &Progress),
    ) -> Result<()> {
        let mesh = model.mesh;
        let (vertex, normal) = (self.positions.len() as u32, self.normals.len() as u32);
        let positions: &[[f64; 3]] = mesh.positions.as_chunks().0;
        let normals: &[[f64; 3]] = mesh.normals.as_chunks().0;
        self.positions.extend(positions.iter().map(|p| placement.position((*p).into()).as_vec3()));
        self.normals.extend(normals.iter().map(|n| placement.normal((*n).into()).as_vec3()));
        let mut polygon = Vec::new();
        let mut begin = 0;
        let triangles = if mesh.face_arities.is_empty() { mesh.indices.len() / 3 } else { 0 };
        let arities = mesh.face_arities.iter().map(|arity| *arity as usize);
        for corners in arities.chain(std::iter::repeat_n(3, triangles)) {
            let indices = &mesh.indices[begin..begin + corners];
            let given = mesh.normal_indices.get(begin..begin + corners);
            polygon.clear();
            polygon.extend(indices.iter().map(|index| DVec3::from(positions[*index as usize])));
            if corners > 4 {
                progress.check()?;
            }
            let (split, whole) = splitter.split(&polygon);
            self.crossed += usize::from(!whole);
            self.faces.extend(split.as_chunks().0.iter().map(|triangle: &[u32; 3]| Face {
                vertices: triangle.map(|corner| vertex + indices[corner as usize]),
                normals:
                    given.map_or([NONE; 3], |given| triangle.map(|corner| normal + given[corner as usize])),
            }));
            begin += corners;
        }
        Ok(())
    }

    /// The faces of several groups as one.
    pub(super) fn joined(groups: impl Iterator<Item = Self>) -> Self {
        let mut all = Self::default();
        groups.for_each(|group| all.append(group));
        all
    }

    /// Adds the faces of another group.
    pub(super) fn append(&mut self, other: Self) {
        let (vertex, normal) = (self.positions.len() as u32, self.normals.len() as u32);
        self.faces.extend(other.faces.into_iter().map(|face| Face {
            vertices: face.vertices.map(|index| index + vertex),
            normals: face.normals.map(|index| if index == NONE { NONE } else { index + normal }),
        }));
        self.positions.extend(other.positions);
        self.normals.extend(other.normals);
        self.crossed += other.crossed;
    }
}
