//! The nodes of the scene with their places in the world. Walked without recursion; each may stand in the tree but once.

use std::collections::HashSet;
use std::path::Path;

use glam::{DMat4, DQuat, DVec3, Mat4};
use gltf_json::Root;
use gltf_json::scene::Node as Description;

use crate::{Error, Result};

/// Most levels of a tree.
const DEEPEST: usize = 1000;

/// A node of the scene.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its index in the file.
    pub index: usize,
    /// Its name, each once.
    pub name: String,
    /// From its own space to the world.
    pub world: DMat4,
}

/// All nodes below the roots of the scene, parents first.
pub(super) fn nodes(root: &Root, path: &Path) -> Result<Vec<Node>> {
    let wrong = |place: String, what: String| Err(Error::format(path, place, what));
    let mut seen = vec![false; root.nodes.len()];
    let mut names = HashSet::new();
    let mut nodes = Vec::new();
    let mut open: Vec<(usize, DMat4, usize)> =
        roots(root, path)?.into_iter().rev().map(|index| (index, DMat4::IDENTITY, 0)).collect();
    while let Some((index, parent, depth)) = open.pop() {
        let place = format!("nodes[{index}]");
        let Some(node) = root.nodes.get(index) else {
            return wrong(place, format!("is named as a child, but there are {} nodes", root.nodes.len()));
        };
        if std::mem::replace(&mut seen[index], true) {
            return wrong(
                place,
                "is reached twice: nodes form a circle, or share a child; export it again".into(),
            );
        }
        if depth > DEEPEST {
            return wrong(
                place,
                format!("is more than {DEEPEST} nodes below the top; flatten the hierarchy"),
            );
        }
        let world = parent * local(node);
        if !world.is_finite() {
            return wrong(place, "is placed by numbers that are not finite; export it again".into());
        }
        let children = node.children.iter().flatten().rev();
        open.extend(children.map(|child| (child.value(), world, depth + 1)));
        nodes.push(Node { index, name: name(root, index, node, &mut names), world });
    }
    Ok(nodes)
}

/// The roots of the scene that is shown; without scenes all nodes that are no child.
fn roots(root: &Root, path: &Path) -> Result<Vec<usize>> {
    let shown = root.scene.map_or(0, |scene| scene.value());
    if let Some(scene) = root.scenes.get(shown) {
        return Ok(scene.nodes.iter().map(|node| node.value()).collect());
    }
    if root.scene.is_some() {
        let what = format!("names scene {shown}, of {} that there are", root.scenes.len());
        return Err(Error::format(path, "scene", what));
    }
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
        if let Some(is) = is_child.get_mut(child.value()) {
            *is = true;
        }
    }
    Ok((0..root.nodes.len()).filter(|index| !is_child[*index]).collect())
}

fn local(node: &Description) -> DMat4 {
    if let Some(matrix) = node.matrix {
        return Mat4::from_cols_array(&matrix).as_dmat4();
    }
    let vector =
        |given: Option<[f32; 3]>, other| given.map_or(other, |given| DVec3::from(given.map(f64::from)));
    let turn = node.rotation.map_or(DQuat::IDENTITY, |turn| DQuat::from_array(turn.0.map(f64::from)));
    // The format asks for unit length; zero is no rotation at all.
    let length = turn.length();
    let turn = if length > 0.0 { turn / length } else { DQuat::IDENTITY };
    DMat4::from_scale_rotation_translation(
        vector(node.scale, DVec3::ONE),
        turn,
        vector(node.translation, DVec3::ZERO),
    )
}

/// The name of a node, or of its mesh, or its number; numbered where another has it.
fn name(root: &Root, index: usize, node: &Description, taken: &mut HashSet<String>) -> String {
    let of_mesh = || root.meshes.get(node.mesh?.value())?.name.clone();
    let given = node.name.clone().or_else(of_mesh);
    let plain = given.map(|name| name.trim().chars().filter(|c| !c.is_control()).take(120).collect());
    let plain: String =
        plain.filter(|name: &String| !name.is_empty()).unwrap_or_else(|| format!("node {index}"));
    let mut name = plain;
    while taken.contains(&name) {
        // Its index tells it from others at once: counting would take the square of their number.
        name = format!("{name} ({index})");
    }
    taken.insert(name.clone());
    name
}
