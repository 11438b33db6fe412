//! Materials: glass by transmission, mirrors by metal that is smooth, all else matt. Guesses and what is left out are noted.

use gltf_json::extensions::material::Material as Extensions;
use gltf_json::material::AlphaMode;
use gltf_json::validation::Checked;

use super::GltfFile;
use crate::scene::material::{Diffuse, Glass, Material, Mirror};

/// Roughness up to which a surface counts as polished: glass and mirrors here are.
const POLISHED: f32 = 0.05;
/// Roughness up to which metal counts as a mirror.
const MIRROR: f32 = 0.2;
/// Share of transmission or metal from which a material counts as glass or as a mirror.
const MOSTLY: f32 = 0.5;
/// Channel of a colour above which glass is not tinted.
const CLEAR: f32 = 0.999;
/// Words in the names of glass.
const GLASSY: [&str; 6] = ["glass", "water", "lens", "wine", "liquid", "crystal"];

/// What a material of a file looks like.
#[derive(Clone, Debug, PartialEq)]
pub struct Looks {
    /// Its name; empty where there is none.
    pub name: String,
    /// The material; none where the file does not say.
    pub material: Option<Material>,
    /// What was guessed or left out.
    pub notes: Vec<String>,
}

impl GltfFile {
    /// A material by its index; `thickness` is the mean way through the body (m), over which a tinted surface colours light.
    pub fn looks(&self, index: Option<usize>, thickness: f64) -> Looks {
        let given = index.and_then(|index| self.root.materials.get(index));
        let Some(given) = given else {
            return Looks { name: String::new(), material: None, notes: Vec::new() };
        };
        let name = given.name.clone().unwrap_or_else(|| format!("material {}", index.unwrap_or_default()));
        let mut notes = Vec::new();
        let material = Reading { given, name: &name, notes: &mut notes }.material(thickness);
        Looks { name, material, notes }
    }
}

/// A material being read.
struct Reading<'a> {
    given: &'a gltf_json::Material,
    name: &'a str,
    notes: &'a mut Vec<String>,
}

impl Reading<'_> {
    fn note(&mut self, what: String) {
        self.notes.push(format!("material '{}': {what}", self.name));
    }

    fn extensions(&self) -> Option<&Extensions> {
        self.given.extensions.as_ref()
    }

    fn material(&mut self, thickness: f64) -> Option<Material> {
        let pbr = &self.given.pbr_metallic_roughness;
        let [r, g, b, alpha] = pbr.base_color_factor.0;
        let colour = [r, g, b].map(|channel| channel.clamp(0.0, 1.0));
        let (metal, roughness) = (pbr.metallic_factor.0, pbr.roughness_factor.0);
        if pbr.base_color_texture.is_some() || pbr.metallic_roughness_texture.is_some() {
            self.note("its textures are left out; its plain values are taken".into());
        }
        if self.given.emissive_factor.0.iter().any(|channel| *channel > 0.0) {
            self.note("its own glow is left out; give it a lamp".into());
        }
        let transmission = self.extensions().and_then(|all| all.transmission.as_ref());
        let transmission = transmission.map_or(0.0, |given| given.transmission_factor.0);
        let see_through = self.given.alpha_mode == Checked::Valid(AlphaMode::Blend) && alpha < 0.9;
        let lower = self.name.to_lowercase();
        let glassy_name = metal < MOSTLY && GLASSY.iter().any(|word| lower.contains(word));
        if transmission >= MOSTLY || see_through || (glassy_name && self.says_something()) {
            if transmission < MOSTLY {
                let hint = if see_through { "its transparency" } else { "its name" };
                self.note(format!("taken as glass, by {hint}"));
            }
            self.polished("glass", roughness);
            return Some(Material::Glass(self.glass(colour, thickness)));
        }
        if lower.contains("mirror") || (metal >= MOSTLY && roughness <= MIRROR) {
            self.polished("metal", roughness);
            return Some(Material::Mirror(Mirror { reflectance: colour }));
        }
        if !self.says_something() {
            return None;
        }
        if metal >= MOSTLY {
            self.note(format!("metal of roughness {roughness:.2} is taken as matt"));
        }
        Some(Material::Diffuse(Diffuse { albedo: colour }))
    }

    /// Whether it has any value that is not the format's own, which is a rough white metal and nobody's wish.
    fn says_something(&self) -> bool {
        let pbr = &self.given.pbr_metallic_roughness;
        let unset = pbr.metallic_factor.0 == 1.0 && pbr.roughness_factor.0 == 1.0;
        !unset || pbr.base_color_factor.0 != [1.0; 4] || pbr.base_color_texture.is_some()
    }

    fn polished(&mut self, what: &str, roughness: f32) {
        if roughness > POLISHED && self.says_something() {
            self.note(format!("{what} of roughness {roughness:.2} is taken as polished"));
        }
    }

    fn glass(&mut self, tint: [f32; 3], thickness: f64) -> Glass {
        let given = self.extensions().and_then(|all| all.ior.as_ref()).map_or(1.5, |given| given.ior.0);
        let ior = Glass::IOR.clamped(given);
        if ior != given {
            self.note(format!("its index {given} is taken as {ior}"));
        }
        let mut absorption = self.volume();
        if tint.iter().any(|channel| *channel < CLEAR) {
            let of_tint = attenuation(tint, thickness);
            absorption = [0, 1, 2].map(|i| absorption[i] + of_tint[i]);
            self.note(format!(
                "its colour became absorption over its mean thickness of {:.1} mm",
                1000.0 * thickness
            ));
        }
        let absorption = absorption.map(|channel| Glass::ABSORPTION.clamped(channel));
        Glass { ior, absorption, dispersion: self.dispersion() }
    }

    /// Absorption (1/m) by KHR_materials_volume: light takes on its colour over its distance.
    fn volume(&self) -> [f32; 3] {
        let Some(volume) = self.extensions().and_then(|all| all.volume.as_ref()) else { return [0.0; 3] };
        let distance = f64::from(volume.attenuation_distance.0);
        if distance > 0.0 && distance.is_finite() {
            attenuation(volume.attenuation_color.0, distance)
        } else {
            [0.0; 3]
        }
    }

    /// Abbe number by KHR_materials_dispersion, which gives 20 over it.
    fn dispersion(&self) -> Option<f32> {
        let given = self.extensions()?.others.get("KHR_materials_dispersion")?.get("dispersion")?.as_f64()?;
        (given > 0.0).then(|| Glass::DISPERSION.clamped((20.0 / given) as f32))
    }
}

/// The absorption (1/m) by which light takes on a colour over a distance (m).
fn attenuation(colour: [f32; 3], distance: f64) -> [f32; 3] {
    colour.map(|channel| {
        let left = f64::from(channel).clamp(1e-6, 1.0);
        (-left.ln() / distance) as f32 + 0.0
    })
}
