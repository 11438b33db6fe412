//! Buffers: the binary chunk, `data:` URIs, and files in the folder of the glTF file or below it. Nothing else is opened: no
//! other folder, no address.

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use gltf_json::{Buffer, Root};
use percent_encoding::percent_decode_str;

use crate::files::read_regular_file;
use crate::{Error, Result};

/// Most bytes of a file and of all buffers together: no length within a GLB reaches beyond.
pub(super) const MAX_BYTES: u64 = 4 << 30;
/// Most buffers of a file.
const MOST: usize = 4096;

/// All buffers, each as long as it says.
pub(super) fn read(root: &Root, binary: Option<&[u8]>, path: &Path) -> Result<Vec<Vec<u8>>> {
    if root.buffers.len() > MOST {
        let what =
            format!("there are {}, at most {MOST} are read; export it as one .glb", root.buffers.len());
        return Err(Error::Limit { place: format!("'{}', buffers", path.display()), what });
    }
    let mut left = MAX_BYTES;
    let read = |(index, buffer): (usize, &Buffer)| {
        let place = format!("buffers[{index}]");
        let mut bytes = match (&buffer.uri, binary) {
            (Some(uri), _) => resolve(uri, path, &format!("{place}.uri"), left)?,
            (None, Some(binary)) if index == 0 => binary.to_vec(),
            (None, _) => return Err(Error::format(path, place, "has no data; export it again")),
        };
        let (wanted, given) = (buffer.byte_length.0, bytes.len() as u64);
        if wanted > given {
            let what = format!("says that it has {wanted} bytes, but has {given}; is it cut off?");
            return Err(Error::format(path, place, what));
        }
        bytes.truncate(wanted as usize);
        left = left.saturating_sub(wanted);
        Ok(bytes)
    };
    root.buffers.iter().enumerate().map(read).collect()
}

/// The file that a URI names, relative to that of the glTF file; none for data in the URI itself.
pub(super) fn file_name(uri: &str) -> Option<String> {
    if uri.starts_with("data:") {
        return None;
    }
    percent_decode_str(uri).decode_utf8().ok().map(|name| name.into_owned())
}

fn resolve(uri: &str, path: &Path, place: &str, most: u64) -> Result<Vec<u8>> {
    let wrong = |what: String| Error::format(path, place, what);
    if let Some(data) = uri.strip_prefix("data:") {
        return decode(data).ok_or_else(|| wrong("is no data in base64; export it as .glb".into()));
    }
    let shown: String = uri.chars().take(80).collect();
    let name = file_name(uri).ok_or_else(|| wrong(format!("'{shown}' is no UTF-8 text")))?;
    let inside = "keep the buffer beside the file, or export it as .glb";
    let scheme = name.find(':').filter(|at| !name[..*at].contains('/'));
    if let Some(end) = scheme {
        let what = format!("'{shown}' is an address ('{}'), which is never opened; {inside}", &name[..=end]);
        return Err(wrong(what));
    }
    let leaves = name.split(['/', '\\']).any(|part| part == "..");
    if leaves || name.starts_with('/') || name.contains(['\\', '\0']) || name.is_empty() {
        return Err(wrong(format!(
            "'{}' leads out of the folder of the file; {inside}",
            shown.escape_default()
        )));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let found = |_| wrong(format!("'{shown}' is not there: the file comes with it; {inside}"));
    let real = folder.join(&name).canonicalize().map_err(found)?;
    let folder = folder.canonicalize().map_err(Error::io("find the folder", folder))?;
    if !real.starts_with(folder) {
        return Err(wrong(format!("'{shown}' leads out of the folder of the file by a link; {inside}")));
    }
    read_regular_file(&real, most)
}

/// The bytes of a `data:` URI after its scheme.
fn decode(data: &str) -> Option<Vec<u8>> {
    let (kind, content) = data.split_once(',')?;
    let content: Vec<u8> = percent_decode_str(content).collect();
    if !kind.ends_with(";base64") {
        return Some(content);
    }
    STANDARD.decode(content).ok()
}
