//! The formats of pictures, by the first bytes of a file.

/// How files of other formats begin, at which byte, and what they are called.
const OTHERS: [(usize, &[u8], &str); 26] = [
    (0, b"8BPS", "a Photoshop file (PSD)"),
    (0, b"GIF8", "GIF"),
    (0, b"BM", "BMP"),
    (0, b"\xff\x0a", "JPEG XL"),
    (0, b"\0\0\0\x0cJXL ", "JPEG XL"),
    (0, b"\0\0\0\x0cjP  ", "JPEG 2000"),
    (0, b"\xff\x4f\xff\x51", "JPEG 2000"),
    (4, b"ftypavif", "AVIF"),
    (4, b"ftypavis", "AVIF"),
    (4, b"ftyphei", "HEIC"),
    (4, b"ftyphev", "HEIC"),
    (4, b"ftypmif1", "HEIF (HEIC or AVIF)"),
    (4, b"ftypmsf1", "HEIF (HEIC or AVIF)"),
    (4, b"ftypcrx ", "a camera's raw file (CR3)"),
    (4, b"ftyp", "a film (MP4, MOV)"),
    (0, b"DDS ", "DDS"),
    (0, b"qoif", "QOI"),
    (0, b"SDPX", "DPX"),
    (0, b"XPDS", "DPX"),
    (0, b"gimp xcf", "a GIMP file (XCF)"),
    (0, b"BLENDER", "a Blender file"),
    (0, b"%PDF", "PDF"),
    (0, b"PK\x03\x04", "an archive (ZIP, Krita, OpenRaster)"),
    (0, b"\0\0\x01\0", "an icon (ICO)"),
    (0, b"\xabKTX", "KTX"),
    (0, b"farbfeld", "farbfeld"),
];

/// What a file that is not read says of itself, and what to do.
pub(super) fn unread(bytes: &[u8]) -> String {
    const READ: &str = "PNG, JPEG, WebP, TIFF, OpenEXR or Radiance HDR";
    match name(bytes) {
        Some(name) => format!("this is {name}, which is not read; save it as {READ}"),
        None => format!("this is no picture that is read; save it as {READ}"),
    }
}

fn name(bytes: &[u8]) -> Option<&'static str> {
    if bytes.is_empty() {
        return Some("an empty file");
    }
    let other =
        OTHERS.iter().find(|(at, magic, _)| bytes.get(*at..).is_some_and(|rest| rest.starts_with(magic)));
    other.map(|(_, _, name)| *name).or_else(|| text(bytes))
}

/// The name of a format that is text.
fn text(bytes: &[u8]) -> Option<&'static str> {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(1024)]).to_lowercase();
    let head = head.trim_start_matches('\u{feff}').trim_start();
    if head.starts_with("<!doctype html") || head.starts_with("<html") {
        Some("a web page (was it saved in place of the picture?)")
    } else if head.contains("<svg") {
        Some("SVG")
    } else if matches!(head.as_bytes(), [b'p', b'1'..=b'7' | b'f', end, ..] if end.is_ascii_whitespace()) {
        Some("a portable map (PPM, PGM, PAM, PFM)")
    } else {
        None
    }
}
