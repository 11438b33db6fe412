//! The core: everything that needs no window and no program.
#![allow(missing_docs, clippy::unwrap_used)]

use std::path::Path;

mod advection;
mod background;
mod camera;
mod cancel;
mod cases;
mod caustics;
mod collect;
mod constraints;
mod continuity;
mod crossing;
mod engine;
mod export;
mod fast_fields;
mod field;
mod figures;
mod film;
mod fit;
mod fit_reference;
#[cfg(target_os = "linux")]
mod frame_faults;
mod gltf;
mod hostile;
mod layers;
mod lines;
mod matching;
mod matching_walls;
mod meeting;
mod meeting_film;
mod meeting_walls;
mod meshes;
mod method;
mod optics;
mod photon_files;
mod photons;
mod placing;
mod preview;
mod preview_light;
mod previews;
mod project_file;
mod project_store;
mod project_versions;
mod properties;
mod render;
mod sampling;
#[path = "../scenes/mod.rs"]
mod scenes;
mod stiff_fits;
mod switched_off;
mod tracks;
mod turbulence;
mod walls;

/// The top of the repository.
fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}
