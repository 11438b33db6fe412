//! Closed triangle meshes, and what must hold of one before it is written.

use std::collections::BTreeMap;

use glam::DVec3;

/// A triangle mesh with one smooth normal per vertex; counter-clockwise triangles seen from outside.
#[derive(Clone, Debug, Default)]
pub(crate) struct Mesh {
    /// Vertices in metres, y up.
    pub positions: Vec<DVec3>,
    /// Outward unit normals, one per vertex.
    pub normals: Vec<DVec3>,
    /// Indices into the vertices.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// The corners of one triangle.
    pub(crate) fn corners(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|i| self.positions[i as usize])
    }

    /// Enclosed volume, positive for outward triangles, in cubic metres.
    pub(crate) fn volume(&self) -> f64 {
        let wedge = |&t: &[u32; 3]| {
            let [a, b, c] = self.corners(t);
            a.dot(b.cross(c)) / 6.0
        };
        self.triangles.iter().map(wedge).sum()
    }

    /// The mesh moved up or down to stand on y = 0.
    pub(crate) fn standing(mut self) -> Self {
        let low = self.positions.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        self.positions.iter_mut().for_each(|p| p.y -= low);
        self
    }

    /// Refuses a mesh that light could not be traced through: open, turned inside out, or with spoilt faces or normals.
    pub(crate) fn check(&self) -> Result<(), String> {
        self.check_edges()?;
        self.check_faces()?;
        self.check_normals()?;
        if self.volume() <= 0.0 { Err(format!("the volume is {:e}", self.volume())) } else { Ok(()) }
    }

    /// Vertices - edges + faces: 2 for a closed surface without a handle.
    #[cfg(test)]
    pub(crate) fn euler_characteristic(&self) -> i64 {
        self.positions.len() as i64 - 3 * self.triangles.len() as i64 / 2 + self.triangles.len() as i64
    }

    /// Every edge belongs to two triangles, which run along it in opposite directions.
    fn check_edges(&self) -> Result<(), String> {
        let mut uses = BTreeMap::new();
        for &[a, b, c] in &self.triangles {
            for edge in [(a, b), (b, c), (c, a)] {
                *uses.entry(edge).or_insert(0) += 1;
            }
        }
        let flaw = uses.iter().find(|&(&(a, b), &count)| count != 1 || !uses.contains_key(&(b, a)));
        flaw.map_or(Ok(()), |(edge, count)| {
            Err(format!("edge {edge:?} is used {count} times, or only one way"))
        })
    }

    /// No triangle is so small or so thin that it has no direction: its height is above 2 micrometres.
    fn check_faces(&self) -> Result<(), String> {
        for &triangle in &self.triangles {
            let [a, b, c] = self.corners(triangle);
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            let height = (b - a).cross(c - a).length() / longest;
            if height.is_nan() || height < 2e-6 {
                return Err(format!("triangle {triangle:?} at {a} is degenerate"));
            }
        }
        Ok(())
    }

    /// Normals have unit length and lie within 50 degrees of the triangles around them.
    fn check_normals(&self) -> Result<(), String> {
        let wrong_length = |n: &DVec3| n.is_nan() || (n.length() - 1.0).abs() > 1e-4;
        if let Some(normal) = self.normals.iter().find(|n| wrong_length(n)) {
            return Err(format!("normal {normal} has no unit length"));
        }
        for &triangle in &self.triangles {
            let [a, b, c] = self.corners(triangle);
            let face = (b - a).cross(c - a).normalize();
            let least = triangle.map(|i| self.normals[i as usize].dot(face)).into_iter().fold(1.0, f64::min);
            if least < 0.64 {
                return Err(format!("a normal of triangle {triangle:?} at {a} turns {least} away from it"));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> Mesh {
        let positions = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)];
        let positions: Vec<_> = positions.map(|(x, y, z)| DVec3::new(x.into(), y.into(), z.into())).to_vec();
        let normals = positions.iter().map(|p| p.normalize()).collect();
        Mesh { positions, normals, triangles: vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]] }
    }

    #[test]
    fn a_tetrahedron_has_the_volume_of_a_third_of_its_cube() {
        assert!((tetrahedron().volume() - 8.0 / 3.0).abs() < 1e-12);
        assert_eq!(tetrahedron().euler_characteristic(), 2);
    }

    #[test]
    fn holes_turned_faces_and_degenerate_faces_are_refused() {
        let mut open = tetrahedron();
        open.triangles.pop();
        assert!(open.check_edges().is_err());
        let mut turned = tetrahedron();
        turned.triangles[0].swap(0, 1);
        assert!(turned.check_edges().is_err());
        let mut flat = tetrahedron();
        flat.positions[0] = flat.positions[1];
        assert!(flat.check_faces().is_err());
        assert!(tetrahedron().check_edges().is_ok() && tetrahedron().check_faces().is_ok());
    }

    #[test]
    fn a_mesh_inside_out_has_negative_volume() {
        let mut inside_out = tetrahedron();
        inside_out.triangles.iter_mut().for_each(|t| t.swap(0, 1));
        assert!(inside_out.volume() < 0.0 && inside_out.check().is_err());
    }
}
