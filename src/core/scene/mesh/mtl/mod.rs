//! Wavefront MTL. The format has no glass: exporters write only its index `Ni`, and often `d 1`, `illum 2`. A material
//! counts as glass with our `absorption` line, or with an index above 1.05 and a hint of glass (transparency, a
//! transmission filter, its name); guesses are always noted.

mod repair;

use std::path::Path;

use self::repair::Header;
use super::text;
use crate::files::read_regular_file;
use crate::scene::material::{Diffuse, Glass, Material, Mirror};
use crate::{Error, Result};

/// Largest file read [bytes].
const MAX_BYTES: u64 = 16 << 20;
/// Distance (m) to which the transmission filter `Tf` applies; the format gives none.
const FILTER_DISTANCE: f32 = 0.01;
/// A transmission filter below which no caustic would be left. Maya writes 0 for what is clear: its filter tells how much
/// is kept back.
const BLACK_FILTER: f32 = 0.02;

/// One `newmtl` of a file.
#[derive(Debug, Default)]
pub(super) struct MtlMaterial {
    /// As written.
    pub name: String,
    values: Values,
    /// Lines that could not be read as written.
    notes: Vec<String>,
}

#[derive(Debug, Default, PartialEq)]
struct Values {
    diffuse: Option<[f32; 3]>,
    specular: Option<[f32; 3]>,
    filter: Option<[f32; 3]>,
    absorption: Option<[f32; 3]>,
    index: Option<f32>,
    /// By `d`.
    opacity: Option<f32>,
    /// By `Tr`, which some programs write as the opacity, too; `d` counts before it.
    transparency: Option<f32>,
    model: Option<u8>,
}

/// Reads a file; unknown or malformed lines are skipped, as the format requires.
pub(super) fn read(path: &Path) -> Result<Vec<MtlMaterial>> {
    parse(&read_regular_file(path, MAX_BYTES)?, path)
}

fn parse(bytes: &[u8], path: &Path) -> Result<Vec<MtlMaterial>> {
    let repaired = repair::repair(bytes, path)?;
    let (materials, _) = tobj::load_mtl_buf(&mut repaired.text.as_bytes())
        .map_err(|error| Error::format(path, "", error.to_string()))?;
    let material = |(header, read): (Header, tobj::Material)| MtlMaterial {
        name: header.name,
        values: Values::of(&read),
        notes: header.notes,
    };
    Ok(repaired.headers.into_iter().zip(materials).map(material).collect())
}

impl Values {
    fn of(read: &tobj::Material) -> Self {
        let single = |colour: Option<[f64; 3]>| colour.map(|colour| colour.map(|channel| channel as f32));
        // What tobj does not know it hands on as text.
        let numbers = |name: &str| -> Option<Vec<f32>> {
            read.unknown_param.get(name)?.split(' ').map(|word| word.parse().ok()).collect()
        };
        let colour = |name: &str| numbers(name)?.try_into().ok();
        Self {
            diffuse: single(read.diffuse),
            specular: single(read.specular),
            filter: colour("Tf"),
            absorption: colour("absorption"),
            index: read.optical_density.map(|index| index as f32),
            opacity: read.dissolve.map(|opacity| opacity as f32),
            transparency: numbers("Tr").and_then(|numbers| numbers.first().copied()),
            model: read.illumination_model,
        }
    }
}

impl MtlMaterial {
    /// Whether both describe the same.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.values == other.values
    }

    /// Its name without comment and quotes.
    pub(super) fn clean_name(&self) -> &str {
        text::without_quotes(text::without_comment(&self.name))
    }

    /// The material it describes; guesses are noted.
    pub(super) fn material(&self, label: &str, notes: &mut Vec<String>) -> Material {
        let values = &self.values;
        let mut note = |text: String| notes.push(format!("{label}: {text}"));
        self.notes.iter().for_each(|text| note(text.clone()));
        if let (Some(d), Some(tr)) = (values.opacity, values.transparency)
            && (1.0 - tr - d).abs() > 0.01
        {
            note(format!("has d {d} (opacity) against Tr {tr} (transparency); d counts"));
        }
        let name = self.name.to_lowercase();
        if name.contains("mirror") {
            let reflectance = values.specular.filter(|ks| *ks != [0.0; 3]).unwrap_or([0.95; 3]);
            note(format!("taken as a mirror, by its name '{}'", self.clean_name()));
            return Material::Mirror(Mirror { reflectance: reflectance.map(|c| c.clamp(0.0, 1.0)) });
        }
        let glassy_name =
            ["glass", "water", "lens", "wine", "liquid", "crystal"].iter().any(|word| name.contains(word));
        let index = values.index.filter(|ni| (1.05..=4.0).contains(ni));
        let Some(hint) = values.glass_hint(glassy_name) else {
            return values.matt();
        };
        let Some(ior) = index else {
            note(format!("looks like glass by {hint}, but gives no index Ni from 1.05 to 4; taken as matt"));
            return values.matt();
        };
        let (absorption, how) = values.absorption();
        // Index and absorption together say that it is glass: nothing is guessed.
        if values.absorption.is_none() {
            note(format!("taken as glass of index {ior}, by {hint}{how}"));
        }
        Material::Glass(Glass { ior, absorption, dispersion: None })
    }
}

impl Values {
    fn opacity(&self) -> Option<f32> {
        self.opacity.or(self.transparency.map(|transparency| 1.0 - transparency))
    }

    fn glass_hint(&self, glassy_name: bool) -> Option<&'static str> {
        if self.absorption.is_some() {
            Some("its absorption line")
        } else if self.opacity().is_some_and(|d| d < 0.99) {
            Some("its transparency")
        } else if self.filter.is_some_and(|tf| tf != [1.0; 3]) {
            Some("its transmission filter Tf")
        } else if matches!(self.model, Some(4 | 6 | 7 | 9)) {
            Some("its illumination model")
        } else {
            glassy_name.then_some("its name")
        }
    }

    /// Absorption (1/m), and words on it where it is guessed.
    fn absorption(&self) -> ([f32; 3], String) {
        let clamped = |absorption: [f32; 3]| absorption.map(|a| a.clamp(0.0, 1e6) + 0.0);
        if let Some(absorption) = self.absorption {
            return (clamped(absorption), String::new());
        }
        match self.filter {
            None => ([0.0; 3], String::new()),
            Some(filter) if filter.iter().all(|left| *left <= BLACK_FILTER) => (
                [0.0; 3],
                "; its filter Tf lets no light through, which Maya writes for clear glass".to_owned(),
            ),
            Some(filter) => {
                let absorption = clamped(filter.map(|left| -left.clamp(1e-6, 1.0).ln() / FILTER_DISTANCE));
                let [r, g, b] = absorption;
                let coloured = absorption != [0.0; 3];
                let how = format!("; its filter Tf makes it absorb {r:.0}, {g:.0}, {b:.0} per m");
                (absorption, if coloured { how } else { String::new() })
            }
        }
    }

    fn matt(&self) -> Material {
        let albedo = self.diffuse.map_or(Diffuse::default().albedo, |kd| kd.map(|c| c.clamp(0.0, 1.0)));
        Material::Diffuse(Diffuse { albedo })
    }
}
