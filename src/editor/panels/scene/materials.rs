//! Materials: a kind is one line in [`KINDS`], a glass one in [`GLASSES`].

use egui::Ui;
use lightloom_core::scene::Material;
use lightloom_core::scene::material::{Diffuse, Glass, Mirror};

use crate::editor::panels::control::Control;
use crate::editor::panels::control::choice::preset_menu;

/// The kinds of material, each with its defaults; the first is that of the mesh file.
const KINDS: &[fn() -> Option<Material>] = &[
    || None,
    || Some(Material::Diffuse(Diffuse::default())),
    || Some(Material::Mirror(Mirror::default())),
    || Some(Material::Glass(crown())),
];

/// Glasses: name, index of refraction at 587.6 nm, Abbe number (textbook values).
#[rustfmt::skip]
const GLASSES: &[(&str, f32, Option<f32>)] = &[
    ("Water", 1.333, Some(55.8)),
    ("Acrylic", 1.491, Some(57.4)),
    ("Crown glass", 1.52, Some(60.0)),
    ("Flint glass", 1.62, Some(36.4)),
    ("Sapphire", 1.768, Some(72.2)),
    ("Diamond", 2.417, Some(55.3)),
];

const KIND: Control =
    Control::new("Material", Material::KIND).labels(&["As the file", "Matt", "Mirror", "Glass"]);
const ALBEDO: Control = Control::new("Albedo", Diffuse::ALBEDO);
const REFLECTANCE: Control = Control::new("Reflectance", Mirror::REFLECTANCE);
const INDEX: Control = Control::new("Index", Glass::IOR);
const ABSORPTION: Control = Control::new("Absorption", Glass::ABSORPTION);
const DISPERSION: Control = Control::new("Abbe number", Glass::DISPERSION).slider(10.0, 100.0);

/// The settings of materials.
pub(super) const CONTROLS: &[Control] = &[KIND, ALBEDO, REFLECTANCE, INDEX, ABSORPTION, DISPERSION];

/// Clear crown glass, without dispersion.
pub(super) fn crown() -> Glass {
    Glass { ior: 1.52, ..Glass::default() }
}

fn kind(material: &Material) -> usize {
    match material {
        Material::Diffuse(_) => 1,
        Material::Mirror(_) => 2,
        Material::Glass(_) => 3,
    }
}

/// The label of its kind.
pub(super) fn name(material: &Material) -> &'static str {
    KIND.labels[kind(material)]
}

/// Kind and values of a material.
pub(super) fn show(ui: &mut Ui, material: &mut Option<Material>) {
    let now = material.as_ref().map_or(0, kind);
    if let Some(make) = KIND.pick(ui, now).and_then(|new| KINDS.get(new)) {
        *material = make();
    }
    match material {
        None => {}
        Some(Material::Diffuse(diffuse)) => {
            ALBEDO.colour(ui, &mut diffuse.albedo);
        }
        Some(Material::Mirror(mirror)) => {
            REFLECTANCE.colour(ui, &mut mirror.reflectance);
        }
        Some(Material::Glass(glass)) => of_glass(ui, glass),
    }
}

fn of_glass(ui: &mut Ui, glass: &mut Glass) {
    ui.horizontal(|ui| {
        INDEX.number_beside(ui, &mut glass.ior, 30.0);
        if let Some(taken) = preset_menu(ui, "Ready glasses", GLASSES.iter().map(|(name, ..)| *name)) {
            let (_, ior, abbe) = GLASSES[taken];
            // Who wants no rainbow keeps none.
            let dispersion = glass.dispersion.and(abbe);
            (glass.ior, glass.dispersion) = (ior, dispersion);
        }
    });
    DISPERSION.optional(ui, &mut glass.dispersion, "none", 60.0);
    ABSORPTION.colour(ui, &mut glass.absorption);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_found_again_under_its_number() {
        assert_eq!(KINDS.len(), KIND.labels.len());
        for (i, make) in KINDS.iter().enumerate() {
            assert_eq!(make().as_ref().map_or(0, kind), i);
        }
    }

    #[test]
    fn the_core_takes_every_ready_glass() {
        for &(name, ior, dispersion) in GLASSES {
            let glass = Material::Glass(Glass { ior, dispersion, ..Glass::default() });
            assert!(glass.check("").is_ok(), "{name}");
        }
    }
}
