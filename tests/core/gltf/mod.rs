//! Scenes in glTF: what is read, what is made of it, what is refused. The files are made in code.

use std::path::{Path, PathBuf};

use glam::Vec3;
use lightloom_core::import::{self, Import};
use lightloom_core::{Progress, Result};
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::scenes::icosphere;

pub(crate) mod fuzz;
pub(crate) mod hostile;
mod materials;
mod scenes_made;
mod shapes;

/// A file being made.
#[derive(Clone)]
struct Glb {
    json: Value,
    bin: Vec<u8>,
}

impl Glb {
    fn new() -> Self {
        let json = json!({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [ { "nodes": [] } ], "nodes": [],
            "meshes": [], "materials": [], "accessors": [], "bufferViews": [], "cameras": [] });
        Self { json, bin: Vec::new() }
    }

    fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }))
    }

    fn accessor(&mut self, bytes: &[u8], (component, count, kind): (u32, usize, &str)) -> usize {
        let view = self.view(bytes);
        self.push(
            "accessors",
            json!({ "bufferView": view, "componentType": component, "count": count, "type": kind }),
        )
    }

    fn vectors(&mut self, vectors: &[Vec3]) -> usize {
        let bytes: Vec<u8> = vectors.iter().flat_map(|v| v.to_array()).flat_map(f32::to_le_bytes).collect();
        self.accessor(&bytes, (5126, vectors.len(), "VEC3"))
    }

    fn indices(&mut self, indices: &[usize]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|i| (*i as u16).to_le_bytes()).collect();
        self.accessor(&bytes, (5123, indices.len(), "SCALAR"))
    }

    fn mesh(&mut self, vertices: &[Vec3], faces: &[[usize; 3]], material: Option<usize>) -> usize {
        let position = self.vectors(vertices);
        let indices = self.indices(faces.as_flattened());
        let mut primitive = json!({ "attributes": { "POSITION": position }, "indices": indices });
        if let Some(material) = material {
            primitive["material"] = material.into();
        }
        self.push("meshes", json!({ "primitives": [primitive] }))
    }

    /// A root of the scene.
    fn node(&mut self, node: Value) -> usize {
        let index = self.push("nodes", node);
        self.json["scenes"][0]["nodes"].as_array_mut().unwrap().push(index.into());
        index
    }

    fn light(&mut self, light: Value, mut node: Value) -> usize {
        let lights = &mut self.json["extensions"]["KHR_lights_punctual"]["lights"];
        if lights.is_null() {
            *lights = json!([]);
        }
        let lights = lights.as_array_mut().unwrap();
        lights.push(light);
        node["extensions"] = json!({ "KHR_lights_punctual": { "light": lights.len() - 1 } });
        self.node(node)
    }

    fn bytes(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if !self.bin.is_empty() && json["buffers"].is_null() {
            json["buffers"] = json!([ { "byteLength": self.bin.len() } ]);
        }
        packed(json.to_string().as_bytes(), &self.bin)
    }
}

/// A container of a JSON text and bytes.
fn packed(json: &[u8], bin: &[u8]) -> Vec<u8> {
    let mut json = json.to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let word = |n: usize| (n as u32).to_le_bytes();
    let total = 12 + 8 + json.len() + if bin.is_empty() { 0 } else { 8 + bin.len() };
    let mut file = [b"glTF".as_slice(), &word(2), &word(total), &word(json.len()), b"JSON", &json].concat();
    if !bin.is_empty() {
        file.extend([&word(bin.len()), b"BIN\0".as_slice(), &bin].concat());
    }
    file
}

/// A file `scene.glb` in a folder of its own.
struct Written {
    folder: TempDir,
}

impl Written {
    fn new(bytes: &[u8]) -> Self {
        let written = Self { folder: tempfile::tempdir().unwrap() };
        std::fs::write(written.path(), bytes).unwrap();
        written
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("scene.glb")
    }

    fn import(&self) -> Result<Import> {
        import::read(&self.path(), &Progress::new())
    }
}

/// A file with all that is read: sparse elements, lamps, a camera, a table, a tree.
pub(crate) fn rich() -> Vec<u8> {
    fuzz::seed().bytes()
}

/// The smallest file that is read.
pub(crate) fn smallest() -> Vec<u8> {
    let mut glb = Glb::new();
    let mesh = glb.mesh(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]], None);
    glb.node(json!({ "mesh": mesh }));
    glb.bytes()
}

fn imported(glb: &Glb) -> Import {
    Written::new(&glb.bytes()).import().unwrap()
}

/// Glass of index 1.5.
fn glass() -> Value {
    json!({ "name": "Clear", "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0 },
        "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1 } } })
}

/// A ball of glass of radius 0.1 m on the origin, of 80 triangles.
fn ball() -> Glb {
    let mut glb = Glb::new();
    let material = glb.push("materials", glass());
    let (unit, faces) = icosphere(1);
    let vertices: Vec<Vec3> = unit.iter().map(|v| *v * 0.1).collect();
    let mesh = glb.mesh(&vertices, &faces, Some(material));
    glb.node(json!({ "name": "Ball", "mesh": mesh, "translation": [0, 0.1, 0] }));
    glb
}

/// A square of 2 m around the origin, matt.
fn with_table(glb: &mut Glb, node: Value) {
    let corners = [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]].map(Vec3::from);
    let material = glb.push(
        "materials",
        json!({ "name": "wood", "pbrMetallicRoughness": { "baseColorFactor": [0.4, 0.3, 0.2, 1], "metallicFactor": 0 } }),
    );
    let mesh = glb.mesh(&corners, &[[0, 2, 1], [0, 3, 2]], Some(material));
    let mut node = node;
    node["mesh"] = mesh.into();
    glb.node(node);
}

fn loaded(import: &Import, folder: &Path) -> lightloom_core::scene::Scene {
    let folder = folder.to_owned();
    lightloom_core::scene::Scene::load(&import.scene, &move |file: &str, _: &str| Ok(folder.join(file)))
        .unwrap()
        .0
}
