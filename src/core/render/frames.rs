//! The light of all frames, summed pass by pass in a file: memory does not grow with the number of frames.
//!
//! The file has a slot more than there are frames. A sum goes into the free slot, and counts from the moment at which the
//! journal says so: wherever the process is killed, each frame has the sum before its last pass or after it.

use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use glam::Vec4;

use super::frame_journal::{Entry, FrameJournal};
use super::texture::{ReceiverTexture, TextureLayout};
use crate::files::reserve;
use crate::{Error, Result};

/// Name of the file in the folder of a store that outlives its process.
const FILE: &str = "light";

/// Sums of textures, one per frame.
#[derive(Debug)]
pub struct FrameStore {
    layout: TextureLayout,
    folder: PathBuf,
    inner: Mutex<Inner>,
}

#[derive(Debug)]
struct Inner {
    file: File,
    /// None where the file goes with the process.
    journal: Option<FrameJournal>,
    /// Of each frame; those without light have none.
    entries: Vec<Option<Entry>>,
    /// Slots that no frame has.
    free: Vec<u32>,
    /// Buffer for one system call.
    packed: Vec<[f32; 3]>,
}

impl FrameStore {
    /// A store for `frames` frames in an unnamed file in `folder`, which needs room for [`Self::bytes`].
    pub fn new(layout: TextureLayout, frames: usize, folder: &Path) -> Result<Self> {
        let file = tempfile::tempfile_in(folder).map_err(Error::io("create a scratch file in", folder))?;
        Self::with_file(layout, folder, file, None, vec![None; frames])
    }

    /// A store in named files in `folder`, with the light that an earlier process left there. Where that may not have reached
    /// the disk, because the computer went down, `checked` makes sure of each sum, and those that are damaged begin anew.
    pub fn kept(layout: TextureLayout, frames: usize, folder: &Path, checked: bool) -> Result<Self> {
        let path = folder.join(FILE);
        let mut options = File::options();
        let file = options.read(true).write(true).create(true).truncate(false).open(&path);
        let file = file.map_err(Error::io("write", &path))?;
        let (journal, entries) = FrameJournal::open(folder, frames)?;
        let store = Self::with_file(layout, folder, file, Some(journal), entries)?;
        if checked {
            store.drop_damaged();
        }
        Ok(store)
    }

    fn with_file(
        layout: TextureLayout,
        folder: &Path,
        file: File,
        journal: Option<FrameJournal>,
        entries: Vec<Option<Entry>>,
    ) -> Result<Self> {
        let fail = Error::io("write the scratch file in", folder);
        reserve(&file, Self::bytes(layout.len(), entries.len())).map_err(fail)?;
        let taken = |slot: &u32| entries.iter().flatten().any(|entry| entry.slot == *slot);
        let free = (0..=entries.len() as u32).rev().filter(|slot| !taken(slot)).collect();
        let inner = Mutex::new(Inner { file, journal, entries, free, packed: Vec::new() });
        Ok(Self { layout, folder: folder.to_owned(), inner })
    }

    /// Bytes on disk: 12 per texel and frame, and one frame more.
    pub fn bytes(texels: usize, frames: usize) -> u64 {
        frame_bytes(texels) * (frames as u64 + 1)
    }

    /// Passes added to a frame.
    ///
    /// # Panics
    /// If the frame does not exist.
    pub fn passes(&self, frame: usize) -> usize {
        self.lock().entries[frame].map_or(0, |entry| entry.passes as usize)
    }

    /// Passes in the frame that has the fewest.
    pub fn least_passes(&self) -> usize {
        let passes = |entry: &Option<Entry>| entry.map_or(0, |entry| entry.passes as usize);
        self.lock().entries.iter().map(passes).min().unwrap_or(0)
    }

    /// Adds the light of one more pass to a frame. Frames may come in any order and from any thread; the passes of one
    /// frame are summed in the order of the calls.
    ///
    /// # Panics
    /// If the frame does not exist or the texture has another layout.
    pub fn add(&self, frame: usize, pass: &ReceiverTexture) -> Result<()> {
        assert_eq!(*pass.layout(), self.layout, "one layout for all textures");
        let inner = &mut *self.lock();
        let fail = Error::io("write the scratch file in", &self.folder);
        let before = inner.entries[frame];
        // There is one slot more than frames.
        let Some(&slot) = inner.free.last() else { return Ok(()) };
        let place = [before.map(|entry| entry.slot), Some(slot)];
        let sum = self.sum(inner, place, pass.texels()).map_err(fail)?;
        let passes = before.map_or(0, |entry| entry.passes) + 1;
        let entry = Entry { slot, passes, sum };
        if let Some(journal) = &mut inner.journal {
            journal.append(frame, &entry)?;
        }
        inner.entries[frame] = Some(entry);
        inner.free.pop();
        inner.free.extend(before.map(|entry| entry.slot));
        Ok(())
    }

    /// The mean over the passes of a frame so far, in watts per texel, and their number; black before the first.
    ///
    /// # Panics
    /// If the frame does not exist.
    pub fn mean(&self, frame: usize) -> Result<(ReceiverTexture, usize)> {
        let mut texture = ReceiverTexture::new(self.layout);
        let mut inner = self.lock();
        let Some(entry) = inner.entries[frame] else { return Ok((texture, 0)) };
        let fail = Error::io("read the scratch file in", &self.folder);
        self.read(&mut inner.file, entry.slot, texture.texels_mut()).map_err(fail)?;
        drop(inner);
        texture.scale(1.0 / entry.passes as f32);
        Ok((texture, entry.passes as usize))
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds in pieces that are still in the cache when written; returns the check sum of what was written.
    fn sum(&self, inner: &mut Inner, [before, after]: [Option<u32>; 2], texels: &[Vec4]) -> io::Result<u32> {
        let Inner { file, packed, journal, .. } = inner;
        let place = |slot: u32, piece: usize| {
            let start = frame_bytes(self.layout.len()) * u64::from(slot);
            SeekFrom::Start(start + frame_bytes(piece * PACK))
        };
        let mut hash = crc32fast::Hasher::new();
        for (piece, texels) in texels.chunks(PACK).enumerate() {
            packed.clear();
            if let Some(before) = before {
                packed.resize(texels.len(), [0.0; 3]);
                file.seek(place(before, piece))?;
                file.read_exact(bytemuck::cast_slice_mut(packed))?;
                for ([r, g, b], texel) in packed.iter_mut().zip(texels) {
                    (*r, *g, *b) = (*r + texel.x, *g + texel.y, *b + texel.z);
                }
            } else {
                packed.extend(texels.iter().map(|t| [t.x, t.y, t.z]));
            }
            file.seek(place(after.unwrap_or_default(), piece))?;
            file.write_all(bytemuck::cast_slice(packed))?;
            if journal.is_some() {
                hash.update(bytemuck::cast_slice(packed));
            }
        }
        Ok(hash.finalize())
    }

    fn read(&self, file: &mut File, slot: u32, texels: &mut [Vec4]) -> io::Result<()> {
        file.seek(SeekFrom::Start(frame_bytes(self.layout.len()) * u64::from(slot)))?;
        let mut packed = vec![[0.0_f32; 3]; PACK];
        for texels in texels.chunks_mut(PACK) {
            let packed = &mut packed[..texels.len()];
            file.read_exact(bytemuck::cast_slice_mut(packed))?;
            texels
                .iter_mut()
                .zip(packed)
                .for_each(|(texel, &mut [r, g, b])| *texel = Vec4::new(r, g, b, 0.0));
        }
        Ok(())
    }

    /// Lets frames begin anew whose sums are not as they were written.
    fn drop_damaged(&self) {
        let inner = &mut *self.lock();
        let mut texels = vec![[0.0_f32; 3]; self.layout.len()];
        for entry in &mut inner.entries {
            let Some(Entry { slot, sum, .. }) = *entry else { continue };
            let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut texels);
            let start = SeekFrom::Start(frame_bytes(self.layout.len()) * u64::from(slot));
            let read = inner.file.seek(start).and_then(|_| inner.file.read_exact(bytes));
            if read.is_err() || crc32fast::hash(bytes) != sum {
                *entry = None;
                inner.free.push(slot);
            }
        }
    }
}

/// Texels per system call.
const PACK: usize = 1 << 16;

fn frame_bytes(texels: usize) -> u64 {
    (texels * size_of::<[f32; 3]>()) as u64
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use glam::Vec2;

    fn layout() -> TextureLayout {
        TextureLayout::new(Vec2::ONE, 20, 0.0)
    }

    fn lit(value: f32) -> ReceiverTexture {
        let mut texture = ReceiverTexture::new(layout());
        texture.texels_mut().fill(Vec4::new(value, 2.0 * value, 0.0, 0.0));
        texture
    }

    #[test]
    fn another_process_goes_on_with_the_light_of_the_last_entry() {
        let folder = tempfile::tempdir().unwrap();
        let open = |checked| FrameStore::kept(layout(), 2, folder.path(), checked).unwrap();
        let store = open(false);
        for (frame, value) in [(0, 1.0), (1, 5.0), (0, 3.0)] {
            store.add(frame, &lit(value)).unwrap();
        }
        drop(store);
        for checked in [false, true] {
            let store = open(checked);
            assert_eq!((store.passes(0), store.passes(1), store.least_passes()), (2, 1, 1));
            assert_eq!(store.mean(0).unwrap(), (lit(2.0), 2));
        }
        // An entry that was cut off counts for nothing, and the next follows the last that is whole.
        let journal = folder.path().join("journal");
        let length = journal.metadata().unwrap().len();
        File::options().write(true).open(&journal).unwrap().set_len(length - 1).unwrap();
        assert_eq!(open(false).mean(0).unwrap(), (lit(1.0), 1));
        open(false).add(0, &lit(3.0)).unwrap();
        assert_eq!(open(true).mean(0).unwrap(), (lit(2.0), 2));
    }

    #[test]
    fn light_that_did_not_reach_the_disk_begins_anew() {
        let folder = tempfile::tempdir().unwrap();
        let store = FrameStore::kept(layout(), 2, folder.path(), false).unwrap();
        (0..2).for_each(|frame| store.add(frame, &lit(1.0)).unwrap());
        drop(store);
        let path = folder.path().join(FILE);
        let mut bytes = std::fs::read(&path).unwrap();
        bytes[100] ^= 1;
        std::fs::write(&path, bytes).unwrap();
        let store = FrameStore::kept(layout(), 2, folder.path(), true).unwrap();
        let mut passes = [store.passes(0), store.passes(1)];
        passes.sort();
        assert_eq!(passes, [0, 1]);
    }
}
