//! A frame that lies in a folder: whether it is whole, and what it says of itself.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;

use exr::block::reader::ChunksReader as _;
use exr::meta::attribute::AttributeValue;

use crate::{Error, Result, files};

/// Largest frame that is looked at.
const MAX_BYTES: u64 = 8 << 30;
/// Prefix of the names of our texts.
const PREFIX: &str = "lightloom:";
/// The first bytes of a PNG file.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The first bytes of an EXR file.
const EXR: &[u8] = &[0x76, 0x2f, 0x31, 0x01];

/// What a frame says of itself.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrameFile {
    /// Pixels per row, and rows.
    pub size: [usize; 2],
    /// Names of its parts with their channels; empty in a PNG.
    pub parts: Vec<String>,
    /// What Lightloom wrote into it, by name without `lightloom:`; empty in files of other programs.
    pub texts: BTreeMap<String, String>,
}

impl FrameFile {
    /// The fingerprint of what the frame was made from; none in files of other programs and of versions before.
    pub fn fingerprint(&self) -> Option<&str> {
        self.texts.get("fingerprint").map(String::as_str)
    }

    /// Passes in the frame, and passes planned.
    pub fn passes(&self) -> Option<[u32; 2]> {
        let number = |name: &str| self.texts.get(name)?.parse().ok();
        Some([number("passes")?, number("passes_planned")?])
    }

    /// Whether all passes are in it that were planned.
    pub fn is_finished(&self) -> bool {
        self.passes().is_some_and(|[done, planned]| done >= planned)
    }
}

/// Reads a frame to its end without decoding its pixels.
///
/// # Errors
/// It cannot be read; it is neither EXR nor PNG; `Format` where it is cut off or damaged.
pub fn inspect(path: &Path) -> Result<FrameFile> {
    let bytes = files::read_regular_file(path, MAX_BYTES)?;
    let whole = match bytes.get(..8) {
        Some(start) if start == PNG => png(&bytes),
        Some(start) if start.starts_with(EXR) => exr(&bytes),
        _ => Err("is neither an EXR nor a PNG file".to_owned()),
    };
    whole.map_err(|what| Error::format(path, "", what))
}

/// Walks through the chunks of a PNG, each of which has a check sum.
fn png(bytes: &[u8]) -> Result<FrameFile, String> {
    let mut file = FrameFile::default();
    let mut rest = &bytes[PNG.len()..];
    loop {
        let cut = || "is cut off: its last chunk is missing".to_owned();
        let (length, after) = rest.split_first_chunk::<4>().ok_or_else(cut)?;
        let length = u32::from_be_bytes(*length) as usize;
        let checked = after.get(..length.saturating_add(4)).ok_or_else(cut)?;
        let (sum, after) = after[checked.len()..].split_first_chunk::<4>().ok_or_else(cut)?;
        if crc32fast::hash(checked) != u32::from_be_bytes(*sum) {
            return Err("is damaged: the check sum of a chunk does not fit".into());
        }
        let (kind, data) = checked.split_at(4);
        match kind {
            b"IHDR" => {
                let side = |at: usize| Some(u32::from_be_bytes(*data.get(at..)?.first_chunk()?) as usize);
                file.size = [side(0), side(4)].map(Option::unwrap_or_default);
            }
            b"iTXt" => file.texts.extend(text(data)),
            b"IEND" if after.is_empty() => return Ok(file),
            b"IEND" => return Err("is damaged: something follows its end".into()),
            _ => (),
        }
        rest = after;
    }
}

/// The name and the words of one of our uncompressed texts.
fn text(data: &[u8]) -> Option<(String, String)> {
    // Name, two bytes on compression, language and translated name, each ended by a zero.
    let mut parts = data.splitn(2, |byte| *byte == 0);
    let name = std::str::from_utf8(parts.next()?).ok()?.strip_prefix(PREFIX)?;
    let words = parts.next()?.strip_prefix(&[0, 0])?.splitn(3, |byte| *byte == 0).nth(2)?;
    Some((name.to_owned(), String::from_utf8_lossy(words).into_owned()))
}

/// Reads the header of an EXR file, and all of its chunks.
fn exr(bytes: &[u8]) -> Result<FrameFile, String> {
    let broken = |error: exr::error::Error| format!("is cut off or damaged: {error}");
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(broken)?;
    let mut file = FrameFile::default();
    for header in reader.headers() {
        file.size = [header.layer_size.0, header.layer_size.1];
        let channels: Vec<String> = header.channels.list.iter().map(|of| of.name.to_string()).collect();
        let name = header.own_attributes.layer_name.as_ref().map(ToString::to_string).unwrap_or_default();
        file.parts.push(format!("{name}: {}", channels.join(" ")));
        for (name, value) in &header.own_attributes.other {
            let Some(name) = name.to_string().strip_prefix(PREFIX).map(str::to_owned) else { continue };
            let value = match value {
                // UTF-8, which the crate takes for Latin-1.
                AttributeValue::Text(text) => String::from_utf8_lossy(text.bytes()).into_owned(),
                AttributeValue::I32(number) => number.to_string(),
                _ => continue,
            };
            file.texts.insert(name, value);
        }
    }
    let chunks = reader.all_chunks(false).map_err(broken)?;
    let expected = chunks.expected_chunk_count();
    let mut count = 0;
    for chunk in chunks {
        chunk.map_err(broken)?;
        count += 1;
    }
    if count < expected {
        return Err(format!("is cut off: it has {count} of {expected} chunks"));
    }
    Ok(file)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::export::{Backdrop, Frame, FrameFormat, FrameLayer, Metadata, PngDepth, write_frame};
    use crate::render::image::Image;
    use crate::render::view::ViewSettings;

    #[test]
    fn a_frame_tells_what_it_is_made_from_and_no_prefix_of_it_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let settings = [("project", "Blüte"), ("fingerprint", "abc"), ("passes_planned", "8")];
        let metadata = Metadata {
            frame: -3,
            frames_per_second: (24, 1),
            seed: 7,
            passes: 5,
            camera: None,
            settings: settings.map(|(name, value)| (name.to_owned(), value.to_owned())).to_vec(),
        };
        let image = Image::new(20, 10);
        let backdrop = Backdrop::new(&[FrameLayer::Beauty, FrameLayer::Caustic], &image, None);
        let frame = Frame {
            backdrop: &backdrop,
            caustic: &image,
            caustics: &[],
            metadata: &metadata,
            compressed: true,
        };
        for format in FrameFormat::ALL {
            let path = folder.path().join("frame").with_extension(format.extension());
            write_frame(&path, format, &frame, &ViewSettings::default().view(), PngDepth::Eight).unwrap();
            let file = inspect(&path).unwrap();
            assert_eq!((file.size, file.fingerprint()), ([20, 10], Some("abc")));
            assert_eq!((file.passes(), file.is_finished()), (Some([5, 8]), false));
            assert_eq!((file.texts["project"].as_str(), file.texts["frame"].as_str()), ("Blüte", "-3"));
            let bytes = std::fs::read(&path).unwrap();
            for length in 0..bytes.len() {
                std::fs::write(&path, &bytes[..length]).unwrap();
                assert!(inspect(&path).is_err(), "{length} of {} bytes of {format:?}", bytes.len());
            }
        }
    }
}
