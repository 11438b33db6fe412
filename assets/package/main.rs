//! Packs the program for Linux: `cargo run --release -p lightloom_package -- --out dist`.
//!
//! The archive holds the program, its desktop entry, the file type `.lightloom`, icons, the notices of all libraries that the
//! program is built from, and `install.sh`, which puts them where a desktop finds them. `--target x86_64-unknown-linux-gnu.2.28` builds with
//! `cargo zigbuild` (`pip install cargo-zigbuild ziglang`) for systems from that version of the C library on; otherwise the program needs
//! that of the machine it was built on. `--program FILE` packs one that is built already. What a program needs is read from it; one that needs a
//! newer C library than its target has is refused.

mod archive;
mod glibc;
mod licences;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

use archive::Archive;

const DESKTOP_ENTRY: &str = include_str!("lightloom.desktop");
const FILE_TYPE: &str = include_str!("lightloom.xml");
const INSTALL: &str = include_str!("install.sh");
const ICON: &[u8] = include_bytes!("../icon.png");
/// Our own licences.
const LICENCES: [(&str, &str); 2] = [
    ("LICENSE-APACHE", include_str!("../../LICENSE-APACHE")),
    ("LICENSE-MIT", include_str!("../../LICENSE-MIT")),
];
/// Sizes of the icon in pixels, those of the hicolor theme.
const ICON_SIZES: [u32; 6] = [16, 32, 48, 64, 128, 256];

fn main() -> io::Result<()> {
    let Arguments { out, target, program } = arguments(env::args().skip(1)).map_err(|what| {
        let usage = "lightloom_package --out DIR [--target TRIPLE.GLIBC] [--program FILE]";
        io::Error::other(format!("{what}; use: {usage}"))
    })?;
    let program = program.map_or_else(|| build(target.as_deref()), Ok)?;
    let bytes =
        fs::read(&program).map_err(|error| io::Error::other(format!("{}: {error}", program.display())))?;
    let needed = glibc::newest(&bytes);
    glibc::require(needed, target.as_deref()).map_err(io::Error::other)?;
    let name = format!("lightloom-{}-{}-linux", env!("CARGO_PKG_VERSION"), env::consts::ARCH);
    fs::create_dir_all(&out)?;
    let path = out.join(format!("{name}.tar.gz"));
    let notices = licences::notices(Path::new(env!("CARGO_MANIFEST_DIR")))?;
    pack(&path, &name, &stripped(&program, &out)?, &notices)?;
    let version = needed.map_or("no".into(), |[major, minor]| format!("{major}.{minor}"));
    println!("{}: {} kB, needs glibc {version}", path.display(), fs::metadata(&path)?.len() / 1000);
    Ok(())
}

/// What is asked for.
struct Arguments {
    /// The folder of the archive.
    out: PathBuf,
    /// What the program is built for, or was: a triple, with a version of the C library where that matters.
    target: Option<String>,
    /// A program that is built already.
    program: Option<PathBuf>,
}

fn arguments(mut given: impl Iterator<Item = String>) -> Result<Arguments, String> {
    let (mut out, mut target, mut program) = (None, None, None);
    while let Some(name) = given.next() {
        let value = given.next().ok_or_else(|| format!("{name} needs a value"))?;
        match name.as_str() {
            "--out" => out = Some(PathBuf::from(value)),
            "--target" => target = Some(value),
            "--program" => program = Some(PathBuf::from(value)),
            _ => return Err(format!("{name} is unknown")),
        }
    }
    Ok(Arguments { out: out.ok_or("--out is missing")?, target, program })
}

/// Builds the program, and tells where it is.
fn build(target: Option<&str>) -> io::Result<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.current_dir(&root).arg(if target.is_some() { "zigbuild" } else { "build" });
    command.args(["--release", "--locked", "--package", "lightloom"]);
    // The core as one unit renders a film in 5 % less time, to the same bytes; it is built longer.
    command.args(["--config", "profile.release.package.lightloom_core.codegen-units=1"]);
    command.args(target.iter().flat_map(|target| ["--target", target]));
    if !command.status()?.success() {
        return Err(io::Error::other(
            "the program does not build; with --target, cargo-zigbuild must be installed",
        ));
    }
    let folder = env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    // The folder is named by the target without the version of the C library.
    let triple = target.map(|target| target.split('.').next().unwrap_or(target));
    let folder = triple.map_or_else(|| folder.clone(), |triple| folder.join(triple));
    Ok(folder.join("release/lightloom"))
}

/// The program without debug information, which is nine tenths of it; whole where there is no `strip`.
fn stripped(program: &Path, scratch: &Path) -> io::Result<Vec<u8>> {
    let copy = scratch.join("lightloom.stripped");
    let strip = Command::new("strip").arg("-o").arg(&copy).arg(program).status();
    if !strip.is_ok_and(|status| status.success()) {
        eprintln!("strip was not found: the archive holds the debug information, too");
        return fs::read(program);
    }
    let bytes = fs::read(&copy)?;
    fs::remove_file(copy)?;
    Ok(bytes)
}

/// Writes the archive, all of whose files lie in the folder `name`.
fn pack(path: &Path, name: &str, program: &[u8], notices: &str) -> io::Result<()> {
    let mut archive = Archive::new(path, name)?;
    archive.add("bin/lightloom", program, true)?;
    archive.add("install.sh", INSTALL.as_bytes(), true)?;
    archive.add("share/applications/lightloom.desktop", DESKTOP_ENTRY.as_bytes(), false)?;
    archive.add("share/mime/packages/lightloom.xml", FILE_TYPE.as_bytes(), false)?;
    archive.add("share/doc/lightloom/NOTICES.txt", notices.as_bytes(), false)?;
    for (name, text) in LICENCES {
        archive.add(&format!("share/doc/lightloom/{name}"), text.as_bytes(), false)?;
    }
    for size in ICON_SIZES {
        let icon = icon(size).map_err(io::Error::other)?;
        archive.add(&format!("share/icons/hicolor/{size}x{size}/apps/lightloom.png"), &icon, false)?;
    }
    archive.finish()
}

/// The icon as a PNG file of `size` pixels.
fn icon(size: u32) -> image::ImageResult<Vec<u8>> {
    let icon = image::load_from_memory(ICON)?;
    let mut bytes = io::Cursor::new(Vec::new());
    let filter = image::imageops::FilterType::Lanczos3;
    icon.resize_exact(size, size, filter).write_to(&mut bytes, image::ImageFormat::Png)?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::collections::BTreeMap;
    use std::io::Read;

    use super::*;

    #[test]
    fn the_archive_holds_everything_a_desktop_looks_for() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.tar.gz");
        pack(&path, "lightloom-1", b"program", "notices").unwrap();
        let unpacked = flate2::read::GzDecoder::new(fs::File::open(&path).unwrap());
        let mut files = BTreeMap::new();
        for entry in tar::Archive::new(unpacked).entries().unwrap() {
            let mut entry = entry.unwrap();
            let (path, mode) = (entry.path().unwrap().display().to_string(), entry.header().mode().unwrap());
            let mut bytes = Vec::new();
            entry.read_to_end(&mut bytes).unwrap();
            files.insert(path, (mode, bytes));
        }
        assert_eq!(files["lightloom-1/bin/lightloom"], (0o755, b"program".to_vec()));
        // What the desktop entry and the file type name is there.
        let icons = files.keys().filter(|path| path.ends_with("apps/lightloom.png")).count();
        assert_eq!(icons, ICON_SIZES.len());
        assert!(DESKTOP_ENTRY.contains("Icon=lightloom\n") && DESKTOP_ENTRY.contains("Exec=lightloom %f\n"));
        let kind = "application/x-lightloom";
        assert!(DESKTOP_ENTRY.contains(&format!("MimeType={kind};")) && FILE_TYPE.contains(kind));
    }

    #[test]
    fn an_archive_has_the_same_bytes_whenever_it_is_made() {
        let folder = tempfile::tempdir().unwrap();
        let bytes = ["a", "b"].map(|name| {
            let path = folder.path().join(name);
            pack(&path, "lightloom-1", b"program", "notices").unwrap();
            fs::read(path).unwrap()
        });
        assert!(bytes[0] == bytes[1]);
    }
}
