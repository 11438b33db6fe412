//! Lights by KHR_lights_punctual: candela and lux become watts.

use std::f32::consts::{PI, TAU};

use glam::{DVec3, Vec3};
use gltf_json::extensions::scene::khr_lights_punctual::{Light, Type};
use gltf_json::validation::Checked;

use super::{GltfFile, Node};
use crate::Result;
use crate::scene::light::{Common, DirectionalLight, LightDesc, PointLight, SpotLight};

/// Lumens of a watt, as Blender and this format's other writers count: the most that light can have.
const LUMENS: f32 = 683.0;
/// Words in the names of lamps.
const LAMPS: [&str; 6] = ["area", "light", "lamp", "spot", "sun", "softbox"];

impl GltfFile {
    /// The light of a node; none where it has none.
    ///
    /// # Errors
    /// `Format` where it names a light that is not there, or a kind that is unknown.
    pub fn light(&self, node: &Node, notes: &mut Vec<String>) -> Result<Option<LightDesc>> {
        let given = self.root.nodes.get(node.index).and_then(|given| given.extensions.as_ref());
        let Some(index) = given.and_then(|given| given.khr_lights_punctual.as_ref()) else { return Ok(None) };
        let index = index.light.value();
        let all = self.root.extensions.as_ref().and_then(|all| all.khr_lights_punctual.as_ref());
        let Some(light) = all.and_then(|all| all.lights.get(index)) else {
            return Err(self.error(
                format!("nodes[{}]", node.index),
                format!("names light {index}, which is not there"),
            ));
        };
        let Checked::Valid(kind) = light.type_ else {
            return Err(self.error(format!("lights[{index}].type"), "is none of point, spot and directional"));
        };
        let name = node.name.clone();
        let position = node.world.transform_point3(DVec3::ZERO).as_vec3();
        let ahead = node.world.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Y).as_vec3();
        let position = position.to_array().map(|n| clamp(&Common::POSITION, n));
        let colour = light.color.map(|channel| Common::COLOUR.clamped(finite(channel)));
        let intensity = finite(light.intensity) / LUMENS;
        Ok(Some(match kind {
            Type::Point => {
                let watts = clamp(&Common::WATTS, intensity * 4.0 * PI);
                LightDesc::Point(PointLight { name, watts, colour, position, ..PointLight::default() })
            }
            Type::Spot => {
                let (angle_deg, soft_edge, solid_angle) = self.cone(light);
                let watts = clamp(&Common::WATTS, intensity * solid_angle);
                let target = target(position.into(), ahead);
                let spot = SpotLight {
                    name,
                    watts,
                    colour,
                    position,
                    target,
                    angle_deg,
                    soft_edge,
                    ..SpotLight::default()
                };
                LightDesc::Spot(spot)
            }
            Type::Directional => {
                notes.push(format!(
                    "{name}: the size of the sun is not in the file; it is a point in the sky"
                ));
                let irradiance = clamp(&DirectionalLight::IRRADIANCE, intensity);
                let direction = ahead.to_array();
                LightDesc::Directional(DirectionalLight {
                    name,
                    irradiance,
                    colour,
                    direction,
                    ..DirectionalLight::default()
                })
            }
        }))
    }

    /// The opening angle of a spot in degrees, the share of it that fades, and its solid angle.
    fn cone(&self, light: &Light) -> (f32, f32, f32) {
        let given = light.spot.clone().unwrap_or_default();
        let outer = finite(given.outer_cone_angle).clamp(1e-3, PI);
        let inner = finite(given.inner_cone_angle).clamp(0.0, outer);
        let below = |angle: f32| 2.0 * (angle / 2.0).sin().powi(2);
        // Blender writes its blend as a share of the angle, and fades over that share of the cosine.
        let generator = self.root.asset.generator.as_deref().unwrap_or_default();
        let below_inner =
            if generator.contains("Blender") { below(outer) * (inner / outer) } else { below(inner) };
        let inner = 2.0 * (below_inner / 2.0).sqrt().clamp(0.0, 1.0).asin();
        let solid_angle = TAU * (below_inner + below(outer)) / 2.0;
        let angle_deg = SpotLight::ANGLE.clamped(2.0 * outer.to_degrees());
        (angle_deg, SpotLight::SOFT_EDGE.clamped(1.0 - inner / outer), solid_angle)
    }

    /// Whether a node is empty and called as a lamp: what Blender leaves of an area light, of which the format knows nothing.
    pub fn is_lost_lamp(&self, node: &Node) -> bool {
        let name = node.name.to_lowercase();
        self.is_bare(node) && LAMPS.iter().any(|word| name.contains(word))
    }

    /// Whether a node holds nothing: neither mesh, camera, lamp nor other nodes.
    pub fn is_bare(&self, node: &Node) -> bool {
        let Some(given) = self.root.nodes.get(node.index) else { return false };
        let lit = given.extensions.as_ref().is_some_and(|given| given.khr_lights_punctual.is_some());
        let parent = given.children.as_ref().is_some_and(|children| !children.is_empty());
        given.mesh.is_none() && given.camera.is_none() && !lit && !parent
    }
}

/// A point ahead of a lamp, as far as the lamp is from the origin, so that 32 bits hold the direction.
fn target(position: Vec3, ahead: Vec3) -> [f32; 3] {
    (position + ahead * position.length().max(1.0)).to_array()
}

fn finite(value: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value.clamp(0.0, f32::MAX) }
}

fn clamp(setting: &crate::setting::Setting, value: f32) -> f32 {
    setting.clamped(if value.is_nan() { 0.0 } else { value })
}
