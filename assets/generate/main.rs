//! Makes the meshes and pictures in `assets/` from formulas: `cargo run --release -p lightloom_assets`.
//!
//! Profiles turned around an axis become glasses and bottles ([`glassware`]), an implicit surface becomes the rabbit, signed
//! distance functions become the pictures ([`canvas`]). The same program writes the same bytes on every machine.

mod canvas;
mod curve;
mod field;
mod flower;
// The tables are easier to read with several points in a row.
#[rustfmt::skip]
mod glassware;
mod icon;
mod loft;
mod mesh;
mod obj;
mod polygonise;
mod rabbit;
mod symbols;
mod vessel;

use std::path::Path;
use std::{fs, io};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{GrayImage, ImageBuffer, PixelWithColorType};
use mesh::Mesh;
use obj::Medium;

const CLEAR_GLASS: Medium = Medium { name: "clear_glass", index: 1.52, absorption: [1.0, 0.4, 0.7] };
const GREEN_GLASS: Medium = Medium { name: "green_glass", index: 1.52, absorption: [160.0, 22.0, 130.0] };
const BLUE_GLASS: Medium = Medium { name: "blue_glass", index: 1.52, absorption: [190.0, 75.0, 8.0] };
const WATER: Medium = Medium { name: "water", index: 1.333, absorption: [0.3, 0.06, 0.02] };
const RED_WINE: Medium = Medium { name: "red_wine", index: 1.344, absorption: [8.0, 120.0, 80.0] };

fn main() -> io::Result<()> {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for (path, bytes) in files() {
        let path = assets.join(path);
        fs::create_dir_all(path.parent().unwrap_or(&assets))?;
        fs::write(&path, &bytes)?;
        println!("{} ({} kB)", path.display(), bytes.len() / 1000);
    }
    Ok(())
}

/// Every file below `assets/`, with its contents.
fn files() -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for (name, title, medium, mesh) in meshes() {
        mesh.check().unwrap_or_else(|flaw| panic!("{name}: {flaw}"));
        files.push((format!("meshes/{name}.obj"), obj::obj(name, title, &medium, &mesh).into_bytes()));
        files.push((format!("meshes/{name}.mtl"), obj::mtl(&medium).into_bytes()));
    }
    for (name, picture) in targets() {
        files.push((format!("targets/{name}.png"), png(&picture)));
    }
    files.push(("icon.png".into(), png(&icon::icon())));
    files
}

/// Every target picture with its name.
fn targets() -> Vec<(&'static str, GrayImage)> {
    vec![
        ("flower", flower::flower()),
        ("star", symbols::star()),
        ("letter_c", symbols::letter_c()),
        ("letter_s", symbols::letter_s()),
        ("spiral", symbols::spiral()),
    ]
}

/// A picture as the bytes of a PNG file.
fn png<P>(picture: &ImageBuffer<P, Vec<u8>>) -> Vec<u8>
where
    P: PixelWithColorType<Subpixel = u8>,
{
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
    picture.write_with_encoder(encoder).expect("writing into memory cannot fail");
    bytes
}

/// Every mesh with its name, title and medium.
fn meshes() -> Vec<(&'static str, &'static str, Medium, Mesh)> {
    vec![
        ("wine_glass", "A thin wine glass", CLEAR_GLASS, glassware::WINE_GLASS.mesh()),
        (
            "wine",
            "Red wine for the wine glass; it overlaps the glass",
            RED_WINE,
            glassware::WINE_GLASS.liquid(&glassware::WINE),
        ),
        ("goblet", "A heavy goblet with a ball in its stem", CLEAR_GLASS, glassware::GOBLET.mesh()),
        ("bottle_round", "A round-bellied bottle", GREEN_GLASS, glassware::BOTTLE_ROUND.mesh()),
        ("bottle_tall", "A slender bottle", BLUE_GLASS, glassware::BOTTLE_TALL.mesh()),
        ("bottle_square", "A square bottle", CLEAR_GLASS, glassware::BOTTLE_SQUARE.mesh()),
        (
            "water_round",
            "Water for the round-bellied bottle; it overlaps the glass",
            WATER,
            glassware::BOTTLE_ROUND.filling(&glassware::WATER_ROUND),
        ),
        (
            "water_tall",
            "Water for the slender bottle; it overlaps the glass",
            WATER,
            glassware::BOTTLE_TALL.filling(&glassware::WATER_TALL),
        ),
        (
            "water_square",
            "Water for the square bottle; it overlaps the glass",
            WATER,
            glassware::BOTTLE_SQUARE.filling(&glassware::WATER_SQUARE),
        ),
        ("rabbit", "A sitting rabbit of solid glass", CLEAR_GLASS, rabbit::mesh()),
    ]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use glam::DVec3;

    use super::*;

    /// The mesh that a text describes, as far as [`obj::obj`] writes it.
    fn parsed(text: &str) -> Mesh {
        let mut mesh = Mesh::default();
        for line in text.lines() {
            let words: Vec<_> = line.split(' ').collect();
            let vector = || DVec3::from_slice(&[1, 2, 3].map(|k| words[k].parse().unwrap()));
            match words[0] {
                "v" => mesh.positions.push(vector()),
                "vn" => mesh.normals.push(vector()),
                "f" => mesh.triangles.push([1, 2, 3].map(|k| {
                    let (position, normal) = words[k].split_once("//").unwrap();
                    assert_eq!(position, normal);
                    position.parse::<u32>().unwrap() - 1
                })),
                _ => (),
            }
        }
        mesh
    }

    #[test]
    fn written_meshes_are_closed_without_handles_and_stand_on_the_ground() {
        for (name, title, medium, mesh) in meshes() {
            let written = parsed(&obj::obj(name, title, &medium, &mesh));
            written.check().unwrap_or_else(|flaw| panic!("{name}: {flaw}"));
            assert_eq!(written.euler_characteristic(), 2, "{name}");
            assert!(
                (written.volume() / mesh.volume() - 1.0).abs() < 1e-4,
                "{name}: rounding changed the volume"
            );
            let low = written.positions.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
            let liquid = name == "wine" || name.starts_with("water");
            assert!(liquid || low == 0.0, "{name} stands at {low}");
            assert!(mesh.triangles.len() < 60_000, "{name}");
        }
    }

    #[test]
    fn the_files_in_the_repository_are_what_this_program_writes() {
        let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        for (path, bytes) in files() {
            let found = fs::read(assets.join(&path)).unwrap();
            assert!(found == bytes, "{path} differs: run `cargo run --release -p lightloom_assets`");
        }
    }
}
