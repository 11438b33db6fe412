//! Which slot of a store holds the light of which frame: an entry is appended for each sum, with a check sum of its own.

use std::fs::File;
use std::io::{Read as _, Seek as _, Write as _};
use std::path::{Path, PathBuf};

use crate::{Error, Result};

/// Name of the file.
const FILE: &str = "journal";
/// Bytes of an entry: frame, slot, passes, check sum of the light, and of these four.
const BYTES: usize = 20;

/// Where the light of a frame is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Entry {
    pub(super) slot: u32,
    pub(super) passes: u32,
    /// CRC-32 of the light.
    pub(super) sum: u32,
}

/// The file of the entries.
#[derive(Debug)]
pub(super) struct FrameJournal {
    file: File,
    path: PathBuf,
}

impl FrameJournal {
    /// Opens or makes the file in `folder`; the last entry of each of the `frames`. What follows the last whole entry goes.
    pub(super) fn open(folder: &Path, frames: usize) -> Result<(Self, Vec<Option<Entry>>)> {
        let path = folder.join(FILE);
        let mut options = File::options();
        let file = options.read(true).write(true).create(true).truncate(false).open(&path);
        let mut file = file.map_err(Error::io("write", &path))?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(Error::io("read", &path))?;
        let mut entries = vec![None; frames];
        let mut whole = 0;
        for bytes in bytes.chunks_exact(BYTES) {
            let Some((frame, entry)) = parse(bytes).filter(|(frame, _)| *frame < frames) else { break };
            entries[frame] = Some(entry);
            whole += BYTES as u64;
        }
        let cut = file.set_len(whole).and_then(|()| file.seek(std::io::SeekFrom::End(0)));
        cut.map_err(Error::io("write", &path))?;
        Ok((Self { file, path }, entries))
    }

    /// Says where the light of a frame is from now on.
    pub(super) fn append(&mut self, frame: usize, entry: &Entry) -> Result<()> {
        let mut bytes: Vec<u8> = [frame as u32, entry.slot, entry.passes, entry.sum]
            .iter()
            .flat_map(|number| number.to_le_bytes())
            .collect();
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        self.file.write_all(&bytes).map_err(Error::io("write", &self.path))
    }
}

fn parse(bytes: &[u8]) -> Option<(usize, Entry)> {
    let (numbers, _) = bytes.as_chunks::<4>();
    let [frame, slot, passes, sum, check] = *numbers else { return None };
    let [frame, slot, passes, sum, check] = [frame, slot, passes, sum, check].map(u32::from_le_bytes);
    (crc32fast::hash(&bytes[..BYTES - 4]) == check).then_some((frame as usize, Entry { slot, passes, sum }))
}
