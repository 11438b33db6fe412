//! The container GLB: a JSON text and the bytes of its first buffer. A file without its magic number is JSON alone.

use std::path::Path;

use crate::{Error, Result};

/// Bytes of the header of a file, and of a chunk.
const HEADER: usize = 12;
const CHUNK: usize = 8;

/// The JSON text and the binary chunk.
pub(super) fn split<'a>(bytes: &'a [u8], path: &Path) -> Result<(&'a [u8], Option<&'a [u8]>)> {
    let wrong = |place: &str, what: String| Err(Error::format(path, place, what));
    if bytes.is_empty() {
        return wrong("", "is empty; export it again".into());
    }
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), None));
    }
    let (Some(version), Some(length)) = (number(bytes, 4), number(bytes, 8)) else {
        return wrong("header", format!("ends after {} bytes; is it cut off?", bytes.len()));
    };
    if version != 2 {
        return wrong("header", format!("is glTF of version {version}; export it as glTF 2.0"));
    }
    if length < HEADER || length > bytes.len() {
        let what = format!(
            "says that it has {length} bytes, but has {}; is it cut off? Export it again",
            bytes.len()
        );
        return wrong("header", what);
    }
    let mut rest = &bytes[HEADER..length];
    let (mut json, mut binary) = (None, None);
    for chunk in 0.. {
        if rest.is_empty() {
            break;
        }
        let (Some(length), Some(kind)) = (number(rest, 0), rest.get(4..CHUNK)) else {
            // Some programs pad the whole file.
            if json.is_some() && rest.iter().all(|byte| *byte == 0) {
                break;
            }
            return wrong(&format!("chunk {chunk}"), "ends within its header; export it again".into());
        };
        let Some(content) = rest.get(CHUNK..CHUNK.saturating_add(length)) else {
            let what = format!(
                "says that it has {length} bytes, but {} are left; export it again",
                rest.len() - CHUNK
            );
            return wrong(&format!("chunk {chunk}"), what);
        };
        match (kind, chunk) {
            (b"JSON", 0) => json = Some(content),
            (b"BIN\0", 1) => binary = Some(content),
            // Other chunks are ignored, as the format requires.
            _ => (),
        }
        // Chunks begin at multiples of four.
        rest = rest.get(CHUNK + length.next_multiple_of(4)..).unwrap_or(&[]);
    }
    match json {
        Some(json) => Ok((json, binary)),
        None => wrong("chunk 0", "is no JSON; export it again".into()),
    }
}

/// The little-endian number at a byte.
fn number(bytes: &[u8], at: usize) -> Option<usize> {
    let bytes = bytes.get(at..at + 4)?.try_into().ok()?;
    usize::try_from(u32::from_le_bytes(bytes)).ok()
}
