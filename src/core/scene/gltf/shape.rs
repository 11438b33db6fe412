//! The triangles of a node, in the world of the file.

use glam::{DMat3, DVec3, Vec3};
use gltf_json::accessor::Type;
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;

use super::accessor::Elements;
use super::{GltfFile, Node};
use crate::{Error, Progress, Result};

/// Most triangles of a file.
const MOST_TRIANGLES: usize = 50_000_000;

/// The triangles of one primitive of a node.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// Index of its material; none where it has none.
    pub material: Option<usize>,
    /// Vertices that are used (m).
    pub positions: Vec<DVec3>,
    /// Normals of the vertices, not normalized; empty where the file gives none.
    pub normals: Vec<Vec3>,
    /// Triangles by indices into both.
    pub faces: Vec<[u32; 3]>,
}

impl GltfFile {
    /// Whether a node holds a mesh.
    pub fn has_mesh(&self, node: &Node) -> bool {
        self.root.nodes.get(node.index).is_some_and(|node| node.mesh.is_some())
    }

    /// The triangles of nodes with a mesh: of the one of a name, or of all; a shape for each primitive. Notes tell what was left
    /// out.
    ///
    /// # Errors
    /// `Format` and `Limit` name the place in the file, also where no node has the name; `Cancelled`.
    pub fn shapes(
        &self,
        name: Option<&str>,
        notes: &mut Vec<String>,
        progress: &Progress,
    ) -> Result<Vec<(&Node, Vec<Shape>)>> {
        let named = |node: &&Node| self.has_mesh(node) && name.is_none_or(|name| node.name == name);
        let nodes: Vec<&Node> = self.nodes.iter().filter(named).collect();
        if nodes.is_empty() {
            return Err(self.error("nodes", self.no_mesh(name)));
        }
        let mut total = 0;
        let shapes = |node| Ok((node, self.shapes_of(node, &mut total, notes, progress)?));
        nodes.into_iter().map(shapes).collect()
    }

    /// Why there is nothing to show.
    fn no_mesh(&self, name: Option<&str>) -> String {
        let Some(name) = name else {
            return "holds no mesh: nothing to show; is everything hidden at the export?".into();
        };
        let there: Vec<&str> = self
            .nodes
            .iter()
            .filter(|node| self.has_mesh(node))
            .map(|node| node.name.as_str())
            .take(8)
            .collect();
        format!("has no mesh called '{name}'; there are: {}", there.join(", "))
    }

    fn shapes_of(
        &self,
        node: &Node,
        total: &mut usize,
        notes: &mut Vec<String>,
        progress: &Progress,
    ) -> Result<Vec<Shape>> {
        let Some(mesh) = self.root.nodes.get(node.index).and_then(|node| node.mesh) else {
            return Ok(Vec::new());
        };
        let index = mesh.value();
        let Some(mesh) = self.root.meshes.get(index) else {
            let what = format!("names meshes[{index}], of {} that there are", self.root.meshes.len());
            return Err(self.error(format!("nodes[{}]", node.index), what));
        };
        let (mut shapes, mut lines, mut morphs) = (Vec::new(), 0, false);
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            progress.check()?;
            let place = format!("meshes[{index}].primitives[{number}]");
            morphs |= primitive.targets.as_ref().is_some_and(|targets| !targets.is_empty());
            match self.shape(primitive, node, &place, total)? {
                Some(shape) => shapes.push(shape),
                None => lines += 1,
            }
        }
        if lines > 0 {
            notes.push(format!("{}: {lines} primitives of points and lines are left out", node.name));
        }
        if morphs {
            notes.push(format!("{}: shape keys are left out; it has its basic shape", node.name));
        }
        Ok(shapes)
    }

    /// The triangles of a primitive; none of points and lines. `total` are those of the file so far.
    fn shape(
        &self,
        primitive: &Primitive,
        node: &Node,
        place: &str,
        total: &mut usize,
    ) -> Result<Option<Shape>> {
        let Checked::Valid(mode) = primitive.mode else {
            return Err(self.error(place, "is of a mode that glTF does not know"));
        };
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            return Ok(None);
        }
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let Some(positions) = attribute(Semantic::Positions) else {
            return Err(self.error(place, "has no POSITION; is the file compressed? Export it again without"));
        };
        let positions = self.elements(positions, Type::Vec3, place)?;
        let normals = attribute(Semantic::Normals).map(|normals| self.elements(normals, Type::Vec3, place));
        let normals = normals.transpose()?.filter(|normals| normals.count >= positions.count);
        let indices =
            primitive.indices.map(|indices| self.elements(indices, Type::Scalar, place)).transpose()?;
        let corners = indices.as_ref().map_or(positions.count, |indices| indices.count);
        // Elements that stand elsewhere are read for each primitive, too.
        let elsewhere = positions.elsewhere() + normals.as_ref().map_or(0, Elements::elsewhere);
        let triangles = if mode == Mode::Triangles { corners / 3 } else { corners };
        *total = total.saturating_add(triangles + elsewhere);
        if *total > MOST_TRIANGLES {
            let place = format!("'{}', {place}", self.path.display());
            let what = format!("{}: more than {MOST_TRIANGLES} triangles; reduce the mesh", node.name);
            return Err(Error::Limit { place, what });
        }
        let corners = self.corners(indices.as_ref(), positions.count, place)?;
        let material = primitive.material.map(|material| material.value());
        let mut shape = Shape { material, ..Shape::default() };
        shape.faces = faces(&corners, mode);
        self.place(&mut shape, node, &positions, normals.as_ref(), place)?;
        Ok(Some(shape))
    }

    /// The vertex of each corner.
    fn corners(&self, indices: Option<&Elements<'_>>, vertices: usize, place: &str) -> Result<Vec<u32>> {
        let Some(indices) = indices else { return Ok((0..vertices as u32).collect()) };
        if !indices.are_indices() {
            return Err(self.error(place, "has indices that are no whole numbers"));
        }
        let corners: Vec<u32> = (0..indices.count).map(|corner| indices.index(corner)).collect();
        match corners.iter().find(|corner| **corner as usize >= vertices) {
            None => Ok(corners),
            Some(wrong) => {
                let what = format!("names vertex {wrong}, of {vertices} that there are; export it again");
                Err(self.error(format!("{place}.indices"), what))
            }
        }
    }

    /// Places the vertices that the faces use, and numbers them anew.
    fn place(
        &self,
        shape: &mut Shape,
        node: &Node,
        positions: &Elements<'_>,
        normals: Option<&Elements<'_>>,
        place: &str,
    ) -> Result<()> {
        let mut used: Vec<u32> = shape.faces.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        shape.positions =
            used.iter().map(|vertex| node.world.transform_point3(positions.vector(*vertex).into())).collect();
        let bad = shape.positions.iter().filter(|position| !position.is_finite()).count();
        if bad > 0 {
            let what =
                format!("{}: {bad} vertices are no finite numbers; export it again without them", node.name);
            return Err(self.error(place, what));
        }
        let turn = DMat3::from_mat4(node.world);
        // Normals go by the inverse transpose, which is the matrix of cofactors over the determinant.
        let cofactors = DMat3::from_cols(
            turn.y_axis.cross(turn.z_axis),
            turn.z_axis.cross(turn.x_axis),
            turn.x_axis.cross(turn.y_axis),
        );
        let mirrored = turn.determinant() < 0.0;
        let sign = if mirrored { -1.0 } else { 1.0 };
        if let Some(normals) = normals {
            let normal = |vertex: &u32| {
                let normal = cofactors * DVec3::from(normals.vector(*vertex)) * sign;
                let normal = normal.normalize_or_zero().as_vec3();
                if normal.is_finite() { normal } else { Vec3::ZERO }
            };
            shape.normals = used.iter().map(normal).collect();
        }
        let number = |vertex: u32| used.binary_search(&vertex).map_or(0, |at| at as u32);
        for face in &mut shape.faces {
            *face = face.map(number);
            if mirrored {
                face.swap(1, 2);
            }
        }
        Ok(())
    }
}

/// Triangles from corners in the order of the mode.
fn faces(corners: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => {
            let strip = corners.windows(3).enumerate();
            strip
                .map(
                    |(i, face)| {
                        if i % 2 == 0 { [face[0], face[1], face[2]] } else { [face[0], face[2], face[1]] }
                    },
                )
                .collect()
        }
        Mode::TriangleFan => {
            let first = corners.first().copied().unwrap_or_default();
            corners.get(1..).unwrap_or(&[]).windows(2).map(|pair| [first, pair[0], pair[1]]).collect()
        }
        _ => corners.as_chunks().0.to_vec(),
    }
}

/// The mean way through a body (m) by the corners of its triangles: 4 volumes over its surface, exact for convex bodies.
pub fn mean_thickness(triangles: impl Iterator<Item = [DVec3; 3]>) -> f64 {
    let (mut volume, mut area, mut origin) = (0.0, 0.0, None);
    for [a, b, c] in triangles {
        // Near the body, where nothing is rounded away.
        let origin = *origin.get_or_insert(a);
        let cross = (b - a).cross(c - a);
        area += cross.length() / 2.0;
        volume += (a - origin).dot(cross) / 6.0;
    }
    if area > 0.0 { (4.0 * volume.abs() / area).max(1e-6) } else { 1.0 }
}
