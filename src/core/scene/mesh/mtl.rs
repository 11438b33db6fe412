//! Wavefront MTL. The format has no glass: exporters write only its index `Ni`, and often `d 1`, `illum 2`. A material
//! counts as glass with our `absorption` line, or with an index above 1.05 and a hint of glass (transparency, a
//! transmission filter, its name); guesses are always noted.

use std::path::Path;

use super::obj;
use crate::Result;
use crate::files::read_regular_file;
use crate::scene::material::{Diffuse, Glass, Material, Mirror};

/// Largest file read [bytes].
const MAX_BYTES: u64 = 16 << 20;
/// Distance (m) to which the transmission filter `Tf` applies; the format gives none.
const FILTER_DISTANCE: f32 = 0.01;

/// One `newmtl` of a file.
#[derive(Debug, Default)]
pub(super) struct MtlMaterial {
    pub name: String,
    diffuse: Option<[f32; 3]>,
    specular: Option<[f32; 3]>,
    filter: Option<[f32; 3]>,
    absorption: Option<[f32; 3]>,
    index: Option<f32>,
    opacity: Option<f32>,
    model: Option<u32>,
}

/// Reads a file; unknown or malformed lines are skipped, as the format requires.
pub(super) fn read(path: &Path) -> Result<Vec<MtlMaterial>> {
    let bytes = read_regular_file(path, MAX_BYTES)?;
    let text = obj::text(&bytes, path)?;
    let mut materials: Vec<MtlMaterial> = Vec::new();
    obj::lines(&text, |_, line| {
        let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        if keyword == "newmtl" {
            materials.push(MtlMaterial { name: rest.trim().to_owned(), ..MtlMaterial::default() });
        } else if let Some(material) = materials.last_mut() {
            material.line(keyword, rest);
        }
        Ok(())
    })?;
    Ok(materials)
}

impl MtlMaterial {
    fn line(&mut self, keyword: &str, rest: &str) {
        match keyword {
            "Kd" => self.diffuse = colour(rest),
            "Ks" => self.specular = colour(rest),
            "Tf" => self.filter = colour(rest),
            "absorption" => self.absorption = colour(rest),
            "Ni" => self.index = number(rest),
            "d" => self.opacity = number(rest),
            "Tr" => self.opacity = number(rest).map(|transparency| 1.0 - transparency),
            "illum" => self.model = rest.trim().parse().ok(),
            _ => (), // Maps, highlights, emission.
        }
    }

    /// The material it describes; guesses are noted if it is `used`.
    pub(super) fn material(&self, label: &str, used: bool, notes: &mut Vec<String>) -> Material {
        let mut note = |text: String| {
            if used {
                notes.push(format!("{label}: {text}"));
            }
        };
        let name = self.name.to_lowercase();
        if name.contains("mirror") {
            let reflectance = self.specular.filter(|ks| *ks != [0.0; 3]).unwrap_or([0.95; 3]);
            note(format!("taken as a mirror, by its name '{}'", self.name));
            return Material::Mirror(Mirror { reflectance: reflectance.map(|c| c.clamp(0.0, 1.0)) });
        }
        let glassy_name =
            ["glass", "water", "lens", "wine", "liquid", "crystal"].iter().any(|word| name.contains(word));
        let index = self.index.filter(|ni| (1.05..=4.0).contains(ni));
        let Some(hint) = self.glass_hint(glassy_name) else {
            return self.matt();
        };
        let Some(ior) = index else {
            note(format!("looks like glass by {hint}, but gives no index Ni from 1.05 to 4; taken as matt"));
            return self.matt();
        };
        note(format!("taken as glass of index {ior}, by {hint}"));
        Material::Glass(Glass { ior, absorption: self.absorption(), dispersion: None })
    }

    fn glass_hint(&self, glassy_name: bool) -> Option<&'static str> {
        if self.absorption.is_some() {
            Some("its absorption line")
        } else if self.opacity.is_some_and(|d| d < 0.99) {
            Some("its transparency")
        } else if self.filter.is_some_and(|tf| tf != [1.0; 3]) {
            Some("its transmission filter Tf")
        } else if matches!(self.model, Some(4 | 6 | 7 | 9)) {
            Some("its illumination model")
        } else {
            glassy_name.then_some("its name")
        }
    }

    fn absorption(&self) -> [f32; 3] {
        let filter = self.filter.unwrap_or([1.0; 3]);
        let by_filter = filter.map(|left| -left.clamp(1e-6, 1.0).ln() / FILTER_DISTANCE);
        self.absorption.unwrap_or(by_filter).map(|a| a.clamp(0.0, 1e6) + 0.0)
    }

    fn matt(&self) -> Material {
        let albedo = self.diffuse.map_or(Diffuse::default().albedo, |kd| kd.map(|c| c.clamp(0.0, 1.0)));
        Material::Diffuse(Diffuse { albedo })
    }
}

fn number(rest: &str) -> Option<f32> {
    rest.split_ascii_whitespace().next()?.parse().ok().filter(|x: &f32| x.is_finite())
}

/// One or three numbers; one applies to all channels.
fn colour(rest: &str) -> Option<[f32; 3]> {
    let mut words = rest.split_ascii_whitespace().map_while(number);
    let red = words.next()?;
    let green = words.next().unwrap_or(red);
    Some([red, green, words.next().unwrap_or(red)])
}
