//! The light of all frames, summed pass by pass in a scratch file: memory does not grow with the number of frames.

use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use glam::Vec4;

use super::texture::{ReceiverTexture, TextureLayout};
use crate::{Error, Result};

/// Sums of textures, one per frame, in an unnamed file that disappears with the process.
#[derive(Debug)]
pub struct FrameStore {
    layout: TextureLayout,
    folder: PathBuf,
    inner: Mutex<Inner>,
}

#[derive(Debug)]
struct Inner {
    file: File,
    /// Passes added to each frame.
    passes: Vec<u32>,
    /// Buffer for one system call.
    packed: Vec<[f32; 3]>,
}

impl FrameStore {
    /// A store for `frames` frames in an unnamed file in `folder`, which needs room for [`Self::bytes`].
    pub fn new(layout: TextureLayout, frames: usize, folder: &Path) -> Result<Self> {
        let file = tempfile::tempfile_in(folder).map_err(Error::io("create a scratch file in", folder))?;
        let inner = Mutex::new(Inner { file, passes: vec![0; frames], packed: Vec::new() });
        Ok(Self { layout, folder: folder.to_owned(), inner })
    }

    /// Bytes on disk once every frame has light: 12 per texel and frame.
    pub fn bytes(texels: usize, frames: usize) -> u64 {
        frame_bytes(texels) * frames as u64
    }

    /// Adds the light of one more pass to a frame. Frames may come in any order and from any thread; the passes of one
    /// frame are summed in the order of the calls.
    ///
    /// # Panics
    /// If the frame does not exist or the texture has another layout.
    pub fn add(&self, frame: usize, pass: &ReceiverTexture) -> Result<()> {
        assert_eq!(*pass.layout(), self.layout, "one layout for all textures");
        let mut inner = self.inner.lock().unwrap_or_else(PoisonError::into_inner);
        let fail = Error::io("write the scratch file in", &self.folder);
        let Inner { file, passes, packed } = &mut *inner;
        let first = passes[frame] == 0;
        self.sum(file, packed, (frame, first), pass.texels()).map_err(fail)?;
        passes[frame] += 1;
        Ok(())
    }

    /// The mean over the passes of a frame so far, in watts per texel, and their number; black before the first.
    ///
    /// # Panics
    /// If the frame does not exist.
    pub fn mean(&self, frame: usize) -> Result<(ReceiverTexture, usize)> {
        let mut texture = ReceiverTexture::new(self.layout);
        let passes = {
            let mut inner = self.inner.lock().unwrap_or_else(PoisonError::into_inner);
            if inner.passes[frame] > 0 {
                let fail = Error::io("read the scratch file in", &self.folder);
                self.read(&mut inner.file, frame, texture.texels_mut()).map_err(fail)?;
            }
            inner.passes[frame]
        };
        texture.scale(1.0 / passes.max(1) as f32);
        Ok((texture, passes as usize))
    }

    /// Adds in pieces that are still in the cache when written back.
    fn sum(
        &self,
        file: &mut File,
        packed: &mut Vec<[f32; 3]>,
        (frame, first): (usize, bool),
        texels: &[Vec4],
    ) -> io::Result<()> {
        let start = frame_bytes(self.layout.len()) * frame as u64;
        for (piece, texels) in texels.chunks(PACK).enumerate() {
            let place = SeekFrom::Start(start + frame_bytes(piece * PACK));
            packed.clear();
            if first {
                packed.extend(texels.iter().map(|t| [t.x, t.y, t.z]));
            } else {
                packed.resize(texels.len(), [0.0; 3]);
                file.seek(place)?;
                file.read_exact(bytemuck::cast_slice_mut(packed))?;
                for ([r, g, b], texel) in packed.iter_mut().zip(texels) {
                    (*r, *g, *b) = (*r + texel.x, *g + texel.y, *b + texel.z);
                }
            }
            file.seek(place)?;
            file.write_all(bytemuck::cast_slice(packed))?;
        }
        Ok(())
    }

    fn read(&self, file: &mut File, frame: usize, texels: &mut [Vec4]) -> io::Result<()> {
        file.seek(SeekFrom::Start(frame_bytes(self.layout.len()) * frame as u64))?;
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
}

/// Texels per system call.
const PACK: usize = 1 << 16;

fn frame_bytes(texels: usize) -> u64 {
    (texels * size_of::<[f32; 3]>()) as u64
}
