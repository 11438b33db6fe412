//! What of the format is read: versions and extensions; what is not is refused by name, or told.

use std::path::Path;

use gltf_json::Root;
use serde::Deserialize;

use crate::{Error, Result};

/// Extensions that are read, or that change nothing which is.
const READ: [&str; 14] = [
    "KHR_lights_punctual",
    "KHR_materials_transmission",
    "KHR_materials_ior",
    "KHR_materials_volume",
    "KHR_materials_dispersion",
    "KHR_materials_specular",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_texture_basisu",
    "EXT_texture_webp",
    "EXT_texture_avif",
];

/// Extensions that change what is read, and what to do about them.
const REFUSED: [(&str, &str); 5] = [
    (
        "KHR_draco_mesh_compression",
        "its meshes are compressed by Draco; export again without Draco (Blender: Export glTF > Data > Compression off)",
    ),
    (
        "EXT_meshopt_compression",
        "its meshes are compressed by meshopt; export again without it (gltfpack: without -c)",
    ),
    (
        "KHR_meshopt_compression",
        "its meshes are compressed by meshopt; export again without it (gltfpack: without -c)",
    ),
    (
        "EXT_mesh_gpu_instancing",
        "its instances are in an extension that is not read; export again without GPU instances (Blender: Export glTF > Data > Scene Graph)",
    ),
    (
        "KHR_materials_pbrSpecularGlossiness",
        "its materials are of the old kind 'specular, glossiness'; export again with metal and roughness",
    ),
];

/// The least of a file that tells its version.
#[derive(Deserialize)]
struct Head {
    asset: Option<Asset>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Asset {
    version: Option<String>,
    min_version: Option<String>,
}

/// Refuses other versions before the rest is read: their members differ.
pub(super) fn check_version(json: &[u8], path: &Path) -> Result<()> {
    let head: Head = serde_json::from_slice(json).map_err(|error| {
        let what = if error.is_eof() {
            "the JSON ends too early; is it cut off?"
        } else {
            "is no glTF: its JSON cannot be read; export it again"
        };
        Error::format(path, format!("line {}, column {}", error.line(), error.column()), what)
    })?;
    let Some(asset) = head.asset else {
        return Err(Error::format(path, "asset", "is missing: this is JSON, but no glTF file"));
    };
    let needed = asset.min_version.or(asset.version).unwrap_or_default();
    if needed.starts_with("2.") {
        return Ok(());
    }
    let shown: String = needed.chars().take(20).collect();
    Err(Error::format(path, "asset.version", format!("is '{shown}'; export it as glTF 2.0")))
}

/// Refuses extensions that it cannot be read without; what is left out of the others, in words.
pub(super) fn check_extensions(root: &Root, path: &Path) -> Result<Vec<String>> {
    let advice = |name: &str| REFUSED.iter().find(|(refused, _)| *refused == name).map(|(_, advice)| *advice);
    for name in &root.extensions_required {
        if READ.contains(&name.as_str()) {
            continue;
        }
        let shown: String = name.chars().take(80).collect();
        let what = match advice(name) {
            Some(advice) => format!("needs '{shown}': {advice}"),
            None => format!("needs the extension '{shown}', which is not read here; export again without it"),
        };
        return Err(Error::format(path, "extensionsRequired", what));
    }
    let known = root.extensions_used.iter().filter_map(|name| Some((name, advice(name)?)));
    let mut left_out: Vec<String> =
        known.map(|(name, advice)| format!("'{name}' is left out: {advice}")).collect();
    if !root.animations.is_empty() {
        left_out.push(format!(
            "{} animations are left out: everything stands as in the first frame",
            root.animations.len()
        ));
    }
    if !root.skins.is_empty() {
        left_out.push("bones are left out: apply the armature before the export".into());
    }
    Ok(left_out)
}
