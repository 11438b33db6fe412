//! Small scenes for the tests and benchmarks of light: meshes made in code, written as OBJ files into a folder of their own.
#![allow(dead_code, unreachable_pub, missing_docs)] // Each test uses its part.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::PathBuf;

use glam::Vec3;
use lightloom_core::Note;
use lightloom_core::scene::light::{PointLight, RectangleLight};
use lightloom_core::scene::material::{Glass, Material, Mirror};
use lightloom_core::scene::{LightDesc, MeshDesc, Scene, SceneDesc};
use tempfile::TempDir;

/// A scene description with its folder.
pub struct Stage {
    pub folder: TempDir,
    pub desc: SceneDesc,
}

impl Stage {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap(), desc: SceneDesc::default() }
    }

    /// Writes any file into the folder.
    pub fn file(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.folder.path().join(name), content).unwrap();
    }

    /// Adds a mesh file; without a material, the file's MTL decides.
    pub fn mesh(&mut self, name: &str, obj: impl AsRef<[u8]>, material: Option<Material>) -> &mut MeshDesc {
        let file = format!("{name}.obj");
        self.file(&file, obj);
        self.desc.meshes.push(MeshDesc { material, ..MeshDesc::new(name, file) });
        self.desc.meshes.last_mut().unwrap()
    }

    pub fn try_load(&self) -> lightloom_core::Result<(Scene, Vec<String>)> {
        let root = self.folder.path().to_owned();
        let loaded =
            Scene::load(&self.desc, &move |path: &str, _: &str| -> lightloom_core::Result<PathBuf> {
                Ok(root.join(path))
            });
        loaded.map(|(scene, notes)| (scene, texts(&notes)))
    }

    pub fn load(&self) -> Scene {
        self.try_load().unwrap().0
    }
}

/// What notes say.
pub fn texts(notes: &[Note]) -> Vec<String> {
    notes.iter().map(|note| note.text.clone()).collect()
}

pub fn glass(ior: f32) -> Option<Material> {
    Some(Material::Glass(Glass { ior, ..Glass::default() }))
}

pub fn mirror(reflectance: f32) -> Option<Material> {
    Some(Material::Mirror(Mirror { reflectance: [reflectance; 3] }))
}

pub fn point(watts: f32, position: [f32; 3]) -> LightDesc {
    LightDesc::Point(PointLight { watts, position, ..PointLight::default() })
}

/// A square lamp of 10 cm, 4.6 m from the origin.
pub fn square_lamp() -> LightDesc {
    LightDesc::Rectangle(RectangleLight {
        watts: 10.0,
        position: [-3.9, 2.2, -1.0],
        target: [0.0, 0.1, 0.0],
        size: [0.1, 0.1],
        ..RectangleLight::default()
    })
}

/// OBJ text; normals where given, one per vertex.
pub fn obj(vertices: &[Vec3], normals: Option<&[Vec3]>, faces: &[[usize; 3]]) -> String {
    let mut text = String::with_capacity(vertices.len() * 80);
    for v in vertices {
        writeln!(text, "v {} {} {}", v.x, v.y, v.z).unwrap();
    }
    for n in normals.unwrap_or(&[]) {
        writeln!(text, "vn {} {} {}", n.x, n.y, n.z).unwrap();
    }
    for face in faces {
        let [a, b, c] = face.map(|v| v + 1);
        match normals {
            Some(_) => writeln!(text, "f {a}//{a} {b}//{b} {c}//{c}").unwrap(),
            None => writeln!(text, "f {a} {b} {c}").unwrap(),
        }
    }
    text
}

/// A unit icosahedron split `levels` times: 20 x 4^levels triangles, all vertices on the unit sphere.
pub fn icosphere(levels: usize) -> (Vec<Vec3>, Vec<[usize; 3]>) {
    let g = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let corners = [
        [-1., g, 0.],
        [1., g, 0.],
        [-1., -g, 0.],
        [1., -g, 0.],
        [0., -1., g],
        [0., 1., g],
        [0., -1., -g],
        [0., 1., -g],
        [g, 0., -1.],
        [g, 0., 1.],
        [-g, 0., -1.],
        [-g, 0., 1.],
    ];
    let mut vertices: Vec<_> = corners.map(|c| glam::DVec3::from(c).normalize()).to_vec();
    let mut faces = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..levels {
        let mut middles = HashMap::new();
        let mut middle = |a: usize, b: usize| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                vertices.push((vertices[a] + vertices[b]).normalize());
                vertices.len() - 1
            })
        };
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    (vertices.into_iter().map(|v| v.as_vec3()).collect(), faces)
}

/// A sphere with its exact normals.
pub fn sphere_obj(levels: usize, centre: Vec3, radius: f32) -> String {
    let (unit, faces) = icosphere(levels);
    let vertices: Vec<_> = unit.iter().map(|v| centre + *v * radius).collect();
    obj(&vertices, Some(&unit), &faces)
}

/// A closed box with flat faces.
pub fn box_obj(lower: Vec3, upper: Vec3) -> String {
    let vertices: Vec<_> = (0..8)
        .map(|i| Vec3::select(glam::BVec3::new(i & 1 != 0, i & 2 != 0, i & 4 != 0), upper, lower))
        .collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let faces: Vec<_> = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    obj(&vertices, None, &faces)
}

/// A thin wine glass turned around the Y axis, standing at y = 0, 0.2 m high, wall 1.2 mm; `around` x 2 x `along` triangles nearly.
pub fn wine_glass_obj(around: usize, along: usize) -> String {
    let profile = resample(&wine_profile(), along);
    let rings = profile.len();
    let mut vertices = Vec::new();
    for [r, y] in &profile {
        for k in 0..around {
            let angle = std::f64::consts::TAU * k as f64 / around as f64;
            vertices.push(glam::dvec3(r * angle.cos(), *y, -r * angle.sin()).as_vec3());
        }
    }
    let mut faces = Vec::new();
    for i in 0..rings - 1 {
        for k in 0..around {
            let (next, a, b) = ((k + 1) % around, i * around, (i + 1) * around);
            faces.push([a + k, a + next, b + next]);
            faces.push([a + k, b + next, b + k]);
        }
    }
    // The two ends of the profile lie on the axis: caps.
    for (ring, outward) in [(0, false), (rings - 1, true)] {
        let centre = vertices.len();
        vertices.push(Vec3::new(0.0, profile[ring][1] as f32, 0.0));
        for k in 0..around {
            let (a, b) = (ring * around + k, ring * around + (k + 1) % around);
            faces.push(if outward { [a, b, centre] } else { [b, a, centre] });
        }
    }
    obj(&vertices, None, &faces)
}

/// Radius and height, from the middle of the foot's underside, outside up to the rim, and inside down to the bowl's bottom.
fn wine_profile() -> Vec<[f64; 2]> {
    let mut outer = vec![
        [0.001, 0.0],
        [0.034, 0.0],
        [0.0345, 0.001],
        [0.034, 0.002],
        [0.02, 0.004],
        [0.006, 0.01],
        [0.004, 0.03],
        [0.004, 0.07],
    ];
    let bowl = |s: f64| {
        [0.004 + 0.036 * (std::f64::consts::PI * (0.08 + 0.62 * s)).sin().powf(0.8), 0.075 + 0.125 * s]
    };
    outer.extend((0..=24).map(|i| bowl(f64::from(i) / 24.0)));
    let wall = 0.0012;
    let inner = (1..=24).rev().map(|i| {
        let [r, y] = bowl(f64::from(i) / 24.0);
        [r - wall, if i == 24 { y } else { y + wall * 0.3 }]
    });
    let rim = outer[outer.len() - 1];
    outer.push([rim[0] - wall / 2.0, rim[1] + wall / 2.0]);
    outer.extend(inner);
    outer.push([0.008, 0.084]);
    outer.push([0.001, 0.083]);
    outer
}

/// `count` points at even distances along a polyline (Catmull-Rom rounded).
fn resample(points: &[[f64; 2]], count: usize) -> Vec<[f64; 2]> {
    let at = |i: isize| glam::DVec2::from(points[i.clamp(0, points.len() as isize - 1) as usize]);
    let fine: Vec<glam::DVec2> = (0..(points.len() - 1) * 32)
        .map(|k| {
            let (i, s) = ((k / 32) as isize, (k % 32) as f64 / 32.0);
            let (p0, p1, p2, p3) = (at(i - 1), at(i), at(i + 1), at(i + 2));
            let tension = 0.35;
            let (m1, m2) = ((p2 - p0) * tension, (p3 - p1) * tension);
            let (s2, s3) = (s * s, s * s * s);
            p1 * (2.0 * s3 - 3.0 * s2 + 1.0)
                + m1 * (s3 - 2.0 * s2 + s)
                + p2 * (3.0 * s2 - 2.0 * s3)
                + m2 * (s3 - s2)
        })
        .chain([at(points.len() as isize - 1)])
        .collect();
    let mut lengths = vec![0.0];
    for pair in fine.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + pair[0].distance(pair[1]));
    }
    let total = lengths[lengths.len() - 1];
    (0..count)
        .map(|k| {
            let want = total * k as f64 / (count - 1) as f64;
            let i = lengths.partition_point(|l| *l < want).clamp(1, fine.len() - 1);
            let s = (want - lengths[i - 1]) / (lengths[i] - lengths[i - 1]);
            let p = fine[i - 1].lerp(fine[i], s);
            [p.x.max(1e-4), p.y]
        })
        .collect()
}
