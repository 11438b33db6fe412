//! Triangles for an implicit surface: naive surface nets, then vertices relaxed along the surface and projected onto it.
//!
//! S. Gibson, "Constrained Elastic Surface Nets", MICCAI 1998: one vertex in every grid cell the surface passes, one
//! quadrilateral around every grid edge it crosses.

use glam::{DVec3, IVec3};

use crate::field::gradient;
use crate::mesh::Mesh;

/// Rounds of relaxation; the triangles hardly change after this many.
const ROUNDS: usize = 8;
/// Eight corners of a cell, as steps from its lowest one.
const CORNERS: [[i32; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]];
/// The edges of a cell, as pairs of corners.
const EDGES: [[usize; 2]; 12] =
    [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

/// The surface field = 0 between the corners `low` and `high` (which it must not touch), on a grid of the given cell size.
pub(crate) fn polygonise(field: impl Fn(DVec3) -> f64, low: DVec3, high: DVec3, cell: f64) -> Mesh {
    let grid = Grid::sample(&field, low, high, cell);
    let mut mesh = grid.surface_net();
    let ring = neighbours(&mesh);
    for _ in 0..ROUNDS {
        mesh.positions = relaxed(&mesh.positions, &ring);
        mesh.positions.iter_mut().for_each(|p| *p = projected(*p, &field, cell));
    }
    // Newton's method doubles the digits with each step; one per round has come far.
    mesh.positions.iter_mut().for_each(|p| *p = projected(projected(*p, &field, cell), &field, cell));
    let normal = |&p: &DVec3| gradient(&field, p, 1e-3 * cell).normalize();
    mesh.normals = mesh.positions.iter().map(normal).collect();
    mesh
}

/// Values of the field at the nodes of a grid.
struct Grid {
    low: DVec3,
    cell: f64,
    nodes: IVec3,
    values: Vec<f64>,
}

impl Grid {
    fn sample(field: impl Fn(DVec3) -> f64, low: DVec3, high: DVec3, cell: f64) -> Self {
        let nodes = ((high - low) / cell).ceil().as_ivec3() + 1;
        let count = nodes.x * nodes.y * nodes.z;
        let position = |i: i32| {
            let node = IVec3::new(i % nodes.x, i / nodes.x % nodes.y, i / (nodes.x * nodes.y));
            low + cell * node.as_dvec3()
        };
        let values = (0..count).map(|i| field(position(i))).collect();
        Self { low, cell, nodes, values }
    }

    fn index(&self, node: IVec3) -> usize {
        (node.x + self.nodes.x * (node.y + self.nodes.y * node.z)) as usize
    }

    fn value(&self, node: IVec3) -> f64 {
        self.values[self.index(node)]
    }

    fn surface_net(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let mut vertices = vec![None; self.values.len()];
        for node in self.cells(IVec3::ONE) {
            if let Some(vertex) = self.vertex(node) {
                vertices[self.index(node)] = Some(mesh.positions.len() as u32);
                mesh.positions.push(vertex);
            }
        }
        for (axis, step) in IVec3::AXES.into_iter().enumerate() {
            let (next, last) = (IVec3::AXES[(axis + 1) % 3], IVec3::AXES[(axis + 2) % 3]);
            for node in self.cells(step) {
                let (inside, beyond) = (self.value(node) < 0.0, self.value(node + step) < 0.0);
                if inside != beyond {
                    let around = [node - next - last, node - last, node, node - next];
                    let quad =
                        around.map(|n| vertices[self.index(n)].expect("a cell at a crossing has a vertex"));
                    let quad = if inside { quad } else { [quad[3], quad[2], quad[1], quad[0]] };
                    mesh.triangles.extend(split(&mesh.positions, quad));
                }
            }
        }
        mesh
    }

    /// All nodes from which one can go by `step` and stay in the grid, row by row.
    fn cells(&self, step: IVec3) -> impl Iterator<Item = IVec3> {
        let end = self.nodes - step;
        (0..end.z)
            .flat_map(move |z| (0..end.y).flat_map(move |y| (0..end.x).map(move |x| IVec3::new(x, y, z))))
    }

    /// Mean of the points where the surface crosses the edges of a cell, if it does.
    fn vertex(&self, node: IVec3) -> Option<DVec3> {
        let corner = |k: usize| node + IVec3::from(CORNERS[k]);
        let values: [f64; 8] = std::array::from_fn(|k| self.value(corner(k)));
        let (mut sum, mut count) = (DVec3::ZERO, 0);
        for [a, b] in EDGES {
            if (values[a] < 0.0) != (values[b] < 0.0) {
                let within = values[a] / (values[a] - values[b]);
                sum += corner(a).as_dvec3().lerp(corner(b).as_dvec3(), within);
                count += 1;
            }
        }
        (count > 0).then(|| self.low + self.cell * sum / f64::from(count))
    }
}

/// Two triangles for a quadrilateral, along its shorter diagonal.
fn split(positions: &[DVec3], [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    let length = |i: u32, j: u32| positions[i as usize].distance_squared(positions[j as usize]);
    if length(a, c) <= length(b, d) { [[a, b, c], [a, c, d]] } else { [[b, c, d], [b, d, a]] }
}

/// For each vertex those it shares a triangle with, in ascending order.
fn neighbours(mesh: &Mesh) -> Vec<Vec<u32>> {
    let mut ring = vec![Vec::new(); mesh.positions.len()];
    for &[a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            ring[from as usize].push(to);
        }
    }
    ring.iter_mut().for_each(|r| r.sort_unstable());
    ring
}

/// Every vertex moved half way to the mean of its neighbours.
fn relaxed(positions: &[DVec3], ring: &[Vec<u32>]) -> Vec<DVec3> {
    let moved = |(p, ring): (&DVec3, &Vec<u32>)| {
        let mean = ring.iter().map(|&i| positions[i as usize]).sum::<DVec3>() / ring.len() as f64;
        p.lerp(mean, 0.5)
    };
    positions.iter().zip(ring).map(moved).collect()
}

/// One step of Newton's method from `p` straight towards the surface.
fn projected(p: DVec3, field: impl Fn(DVec3) -> f64, cell: f64) -> DVec3 {
    let slope = gradient(&field, p, 1e-3 * cell);
    p - field(p) / slope.length_squared() * slope
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_ball_comes_out_round_closed_and_right_side_out() {
        let ball = polygonise(|p| p.length() - 1.0, DVec3::splat(-1.3), DVec3::splat(1.3), 0.11);
        ball.check().unwrap();
        assert_eq!(ball.euler_characteristic(), 2);
        for (p, n) in ball.positions.iter().zip(&ball.normals) {
            assert!((p.length() - 1.0).abs() < 1e-9 && n.distance(*p) < 1e-6);
        }
    }

    #[test]
    fn a_ring_has_the_euler_characteristic_of_a_torus() {
        let ring = |p: DVec3| (p.x.hypot(p.z) - 1.0).hypot(p.y) - 0.4;
        let mesh = polygonise(ring, DVec3::new(-1.6, -0.6, -1.6), DVec3::new(1.6, 0.6, 1.6), 0.09);
        mesh.check().unwrap();
        assert_eq!(mesh.euler_characteristic(), 0);
    }
}
