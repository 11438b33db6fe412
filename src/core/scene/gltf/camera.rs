//! Cameras with perspective.

use glam::DVec3;
use gltf_json::camera::Type;
use gltf_json::validation::Checked;

use super::{GltfFile, Node};
use crate::Result;
use crate::scene::camera::CameraDesc;

impl GltfFile {
    /// The camera of a node, and the width over the height of its picture where it says it; none where it has none, or one
    /// without perspective, which is noted.
    ///
    /// # Errors
    /// `Format` where it names a camera that is not there.
    pub fn camera(&self, node: &Node, notes: &mut Vec<String>) -> Result<Option<(CameraDesc, Option<f32>)>> {
        let Some(index) = self.root.nodes.get(node.index).and_then(|given| given.camera) else {
            return Ok(None);
        };
        let index = index.value();
        let Some(camera) = self.root.cameras.get(index) else {
            let what = format!("names camera {index}, of {} that there are", self.root.cameras.len());
            return Err(self.error(format!("nodes[{}]", node.index), what));
        };
        let lens = match (camera.type_, &camera.perspective) {
            (Checked::Valid(Type::Perspective), Some(lens)) => lens,
            _ => {
                notes.push(format!("{}: a camera without perspective is left out", node.name));
                return Ok(None);
            }
        };
        let position = node.world.transform_point3(DVec3::ZERO);
        let ahead = node.world.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Z);
        let up = node.world.transform_vector3(DVec3::Y).normalize_or(DVec3::Y);
        // As far as the camera is from the origin, so that 32 bits hold the direction.
        let look_at = position + ahead * position.length().max(1.0);
        let single = |vector: DVec3| vector.as_vec3().to_array();
        let desc = CameraDesc {
            position: single(position),
            look_at: single(look_at),
            up: single(up),
            fov_deg: CameraDesc::FOV.clamped(if lens.yfov.is_finite() {
                lens.yfov.to_degrees()
            } else {
                40.0
            }),
            ..CameraDesc::default()
        };
        if let Err(error) = desc.check("camera") {
            notes.push(format!("{}: is left out: {error}", node.name));
            return Ok(None);
        }
        Ok(Some((desc, lens.aspect_ratio.filter(|aspect| (0.05..20.0).contains(aspect)))))
    }
}
