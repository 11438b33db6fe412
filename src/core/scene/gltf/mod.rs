//! Scenes in glTF 2.0 (`.glb`, `.gltf`): meshes, materials, lights and cameras of its nodes, in metres and Y up, as here.
//!
//! The package `gltf-json` parses the JSON. Everything that it points to is looked up here: files are untrusted, so buffers
//! come from the folder of the file alone, every index and range is checked, nothing is allocated by the file's word, and
//! nodes are walked without recursion.

mod accessor;
mod buffers;
mod camera;
mod container;
mod light;
mod material;
mod shape;
mod support;
mod tree;

use std::path::{Path, PathBuf};

use gltf_json::Root;

pub use material::Looks;
pub use shape::{Shape, mean_thickness};
pub use tree::Node;

use crate::files::read_regular_file;
use crate::{Error, Progress, Result};

/// A glTF file with its buffers and the nodes of its scene.
pub struct GltfFile {
    path: PathBuf,
    root: Root,
    buffers: Vec<Vec<u8>>,
    nodes: Vec<Node>,
    /// Names of what the file holds and nobody reads here.
    left_out: Vec<String>,
}

impl GltfFile {
    /// Whether a path is called as a glTF file.
    pub fn is_named(path: &Path) -> bool {
        let ending = path.extension().unwrap_or_default();
        ["glb", "gltf"].iter().any(|known| ending.eq_ignore_ascii_case(known))
    }

    /// Reads a file and its buffers.
    ///
    /// # Errors
    /// `Format` names the file, the place in it and what to do, also where it needs an extension that is not read.
    pub fn read(path: &Path, progress: &Progress) -> Result<Self> {
        let bytes = read_regular_file(path, buffers::MAX_BYTES)?;
        progress.check()?;
        let (json, binary) = container::split(&bytes, path)?;
        support::check_version(json, path)?;
        let root: Root = gltf_json::deserialize::from_slice(json).map_err(|error| {
            let place = format!("line {}, column {} of its JSON", error.line(), error.column());
            Error::format(path, place, format!("{}; export it again", reason(&error)))
        })?;
        let left_out = support::check_extensions(&root, path)?;
        let buffers = buffers::read(&root, binary, path)?;
        let nodes = tree::nodes(&root, path)?;
        Ok(Self { path: path.to_owned(), root, buffers, nodes, left_out })
    }

    /// All nodes of the scene, parents before their children.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// What the file holds that is not read, in words.
    pub fn left_out(&self) -> &[String] {
        &self.left_out
    }

    /// The files that its buffers lie in, relative to its folder.
    pub fn buffer_files(&self) -> Vec<String> {
        self.root.buffers.iter().filter_map(|buffer| buffers::file_name(buffer.uri.as_deref()?)).collect()
    }

    fn error(&self, place: impl Into<String>, what: impl Into<String>) -> Error {
        Error::format(&self.path, place, what)
    }
}

/// The parser's reason without its position.
fn reason(error: &gltf_json::Error) -> String {
    let full = error.to_string();
    full.rsplit_once(" at line ").map_or(full.clone(), |(reason, _)| reason.to_owned())
}
