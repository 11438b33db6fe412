//! NPZ, NumPy's file format for several named arrays: a ZIP archive of NPY files (PKWARE's APPNOTE 6.3), deflated or
//! stored, below 4 GiB.

use std::io::{self, Read as _, Write};

use flate2::Compression;
use flate2::read::DeflateDecoder;
use flate2::write::DeflateEncoder;

use super::npy::{self, Header, NpyError, NpyWriter};

/// Signatures of an array's own header, of its entry in the directory, and of the directory's end.
const LOCAL: u32 = 0x0403_4b50;
const ENTRY: u32 = 0x0201_4b50;
const END: u32 = 0x0605_4b50;

/// Bytes of the three without names and comments.
const LOCAL_BYTES: usize = 30;
const ENTRY_BYTES: usize = 46;
const END_BYTES: usize = 22;

/// Compression methods.
const STORED: u16 = 0;
const DEFLATED: u16 = 8;

/// 1980-01-01 as ZIP writes dates: equal arrays are equal bytes, whenever they are written.
const DATE: u16 = 0x21;
/// ZIP 2.0 is needed to read the archive.
const VERSION_NEEDED: u16 = 20;
/// ZIP 4.6 on Unix, and the permissions rw-r--r-- of a regular file.
const MADE_BY: u16 = 3 << 8 | 46;
const ATTRIBUTES: u32 = 0o100_644 << 16;

/// Largest array that is read, bytes.
const MAX_ARRAY: usize = 1 << 30;

/// Why an archive cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum NpzError {
    /// It is no ZIP archive, or damaged.
    #[error("the NPZ archive is damaged ({0})")]
    Damaged(&'static str),
    /// An array in it cannot be read.
    #[error("array '{0}': {1}")]
    Array(String, NpyError),
}

/// One array of an archive.
struct Entry {
    /// With the ending `.npy`.
    file_name: String,
    method: u16,
    crc: u32,
    /// Bytes as written and as they come out.
    packed: u32,
    unpacked: u32,
    /// Where its own header begins.
    offset: u32,
}

/// Writes arrays of float32 into an archive.
pub struct NpzWriter<W> {
    out: W,
    written: u64,
    entries: Vec<Entry>,
}

impl<W: Write> NpzWriter<W> {
    /// An archive without arrays.
    pub fn new(out: W) -> Self {
        Self { out, written: 0, entries: Vec::new() }
    }

    /// Writes one array in C order.
    ///
    /// # Errors
    /// Those of the output; another number of values than the shape has; more than 4 GiB.
    pub fn array(
        &mut self,
        name: &str,
        shape: &[u64],
        values: impl IntoIterator<Item = f32>,
    ) -> io::Result<()> {
        let mut file = Vec::new();
        let mut npy = NpyWriter::new(&mut file, shape)?;
        npy.extend(values)?;
        npy.finish()?;
        let mut deflater = DeflateEncoder::new(Vec::new(), Compression::default());
        deflater.write_all(&file)?;
        let packed = deflater.finish()?;
        let entry = Entry {
            file_name: format!("{name}.npy"),
            method: DEFLATED,
            crc: crc32fast::hash(&file),
            packed: below_4_gib(packed.len() as u64)?,
            unpacked: below_4_gib(file.len() as u64)?,
            offset: below_4_gib(self.written)?,
        };
        let mut header = LOCAL.to_le_bytes().to_vec();
        entry.write_common(&mut header)?;
        header.extend(entry.file_name.as_bytes());
        self.entries.push(entry);
        self.write(&header)?;
        self.write(&packed)
    }

    /// Writes the directory and flushes the archive.
    ///
    /// # Errors
    /// Those of the output; more than 4 GiB or 65535 arrays.
    pub fn finish(mut self) -> io::Result<()> {
        let start = below_4_gib(self.written)?;
        let mut directory = Vec::new();
        for entry in &self.entries {
            directory.extend(ENTRY.to_le_bytes());
            directory.extend(MADE_BY.to_le_bytes());
            entry.write_common(&mut directory)?;
            // Length of a comment, number of the disk, internal attributes.
            directory.extend([0; 6]);
            directory.extend(ATTRIBUTES.to_le_bytes());
            directory.extend(entry.offset.to_le_bytes());
            directory.extend(entry.file_name.as_bytes());
        }
        let length = below_4_gib(directory.len() as u64)?;
        let count = u16::try_from(self.entries.len()).map_err(io::Error::other)?.to_le_bytes();
        directory.extend(END.to_le_bytes());
        // Number of this disk and of that with the directory.
        directory.extend([0; 4]);
        directory.extend([count, count].concat());
        directory.extend(length.to_le_bytes());
        directory.extend(start.to_le_bytes());
        // Length of a comment.
        directory.extend([0; 2]);
        self.write(&directory)?;
        self.out.flush()
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.written += bytes.len() as u64;
        self.out.write_all(bytes)
    }
}

fn below_4_gib(bytes: u64) -> io::Result<u32> {
    u32::try_from(bytes).map_err(|_| io::Error::other("an NPZ file can hold no more than 4 GiB"))
}

impl Entry {
    /// What an array's own header and its entry in the directory have in common: from the version needed to the length
    /// of an extra field.
    fn write_common(&self, out: &mut Vec<u8>) -> io::Result<()> {
        let name_length = u16::try_from(self.file_name.len()).map_err(io::Error::other)?;
        // No flags; midnight.
        for number in [VERSION_NEEDED, 0, self.method, 0, DATE] {
            out.extend(number.to_le_bytes());
        }
        for number in [self.crc, self.packed, self.unpacked] {
            out.extend(number.to_le_bytes());
        }
        out.extend([name_length, 0].map(u16::to_le_bytes).concat());
        Ok(())
    }
}

/// Reads an archive that lies in memory.
pub struct NpzReader<'a> {
    archive: &'a [u8],
    entries: Vec<Entry>,
}

impl<'a> NpzReader<'a> {
    /// Reads the directory of an archive.
    ///
    /// # Errors
    /// [`NpzError::Damaged`].
    pub fn new(archive: &'a [u8]) -> Result<Self, NpzError> {
        let none = NpzError::Damaged("it has no directory");
        // A comment may follow, of up to 65535 bytes.
        let last = archive.len().checked_sub(END_BYTES).ok_or(none)?;
        let mut ends = (last.saturating_sub(u16::MAX.into())..=last).rev();
        let end = ends.find(|&at| u32_at(archive, at) == Some(END));
        let end = end.ok_or(NpzError::Damaged("it has no directory"))?;
        let directory = || Some((u16_at(archive, end + 10)?, u32_at(archive, end + 16)? as usize));
        let (count, mut at) = directory().ok_or(NpzError::Damaged("its directory is cut short"))?;
        let mut entries = Vec::new();
        for _ in 0..count {
            let (entry, next) = entry(archive, at).ok_or(NpzError::Damaged("its directory is damaged"))?;
            entries.push(entry);
            at = next;
        }
        Ok(Self { archive, entries })
    }

    /// The names of the arrays, in the order of the archive.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().filter_map(|entry| entry.file_name.strip_suffix(".npy"))
    }

    /// The header and the elements of an array; none where there is no such array.
    ///
    /// # Errors
    /// [`NpzError`].
    pub fn array(&self, name: &str) -> Result<Option<(Header, Vec<f32>)>, NpzError> {
        let named = |entry: &&Entry| entry.file_name.strip_suffix(".npy") == Some(name);
        let Some(entry) = self.entries.iter().find(named) else { return Ok(None) };
        let file = self.unpack(entry)?;
        npy::parse(&file).map(Some).map_err(|error| NpzError::Array(name.to_owned(), error))
    }

    fn unpack(&self, entry: &Entry) -> Result<Vec<u8>, NpzError> {
        let packed = self.packed(entry).ok_or(NpzError::Damaged("an array is cut short"))?;
        let size = entry.unpacked as usize;
        if size > MAX_ARRAY {
            return Err(NpzError::Damaged("an array is larger than 1 GiB"));
        }
        let file = match entry.method {
            STORED => packed.to_vec(),
            DEFLATED => {
                let mut file = Vec::new();
                let unpacked = DeflateDecoder::new(packed).take(size as u64 + 1).read_to_end(&mut file);
                unpacked.map_err(|_| NpzError::Damaged("an array cannot be unpacked"))?;
                file
            }
            _ => return Err(NpzError::Damaged("an array is neither stored nor deflated")),
        };
        if file.len() != size || crc32fast::hash(&file) != entry.crc {
            return Err(NpzError::Damaged("the checksum of an array is wrong"));
        }
        Ok(file)
    }

    fn packed(&self, entry: &Entry) -> Option<&'a [u8]> {
        let header = self.archive.get(entry.offset as usize..)?;
        let own = u32_at(header, 0)? == LOCAL;
        let start = LOCAL_BYTES + usize::from(u16_at(header, 26)?) + usize::from(u16_at(header, 28)?);
        header.get(start..)?.get(..entry.packed as usize).filter(|_| own)
    }
}

/// The directory's entry at `at`, and where the next one begins.
fn entry(archive: &[u8], at: usize) -> Option<(Entry, usize)> {
    let bytes = archive.get(at..)?;
    let [name, extra, comment] = [28, 30, 32].map(|field| u16_at(bytes, field).map(usize::from));
    let name = bytes.get(ENTRY_BYTES..)?.get(..name?)?;
    let entry = Entry {
        file_name: str::from_utf8(name).ok()?.to_owned(),
        method: u16_at(bytes, 10)?,
        crc: u32_at(bytes, 16)?,
        packed: u32_at(bytes, 20)?,
        unpacked: u32_at(bytes, 24)?,
        offset: u32_at(bytes, 42)?,
    };
    let next = at + ENTRY_BYTES + name.len() + extra? + comment?;
    (u32_at(bytes, 0)? == ENTRY).then_some((entry, next))
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    bytes.get(at..)?.first_chunk().map(|bytes| u16::from_le_bytes(*bytes))
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().map(|bytes| u32::from_le_bytes(*bytes))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Written by `savez` and `savez_compressed` of NumPy 2.4: `a` of float32, 3 x 2, and `b` of big-endian float64, 2 x 3.
    const NUMPY: [&[u8]; 2] =
        [include_bytes!("fixtures/stored.npz"), include_bytes!("fixtures/deflated.npz")];

    #[test]
    fn archives_of_numpy_are_read() {
        for file in NUMPY {
            let npz = NpzReader::new(file).unwrap();
            assert_eq!(npz.names().collect::<Vec<_>>(), ["a", "b"]);
            let (header, values) = npz.array("a").unwrap().unwrap();
            assert_eq!((header.shape, values), (vec![3, 2], vec![0.0, 0.5, 1.0, 0.25, 0.125, 0.75]));
            let (header, values) = npz.array("b").unwrap().unwrap();
            assert_eq!((header.shape, values), (vec![2, 3], vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]));
            assert!(npz.array("c").unwrap().is_none());
        }
    }

    #[test]
    fn what_is_written_is_read_back_in_order() {
        let mut file = Vec::new();
        let mut npz = NpzWriter::new(&mut file);
        npz.array("long", &[1000], (0..1000).map(|n| n as f32)).unwrap();
        npz.array("none", &[0, 3], []).unwrap();
        assert!(npz.array("wrong", &[2], [1.0]).is_err());
        npz.finish().unwrap();
        let npz = NpzReader::new(&file).unwrap();
        assert_eq!(npz.names().collect::<Vec<_>>(), ["long", "none"]);
        assert_eq!(npz.array("long").unwrap().unwrap().1[999], 999.0);
        assert_eq!(npz.array("none").unwrap().unwrap().0.shape, [0, 3]);
    }

    #[test]
    fn damaged_archives_are_refused() {
        for file in NUMPY {
            for end in 0..file.len() {
                assert!(NpzReader::new(&file[..end]).is_err(), "cut at {end}");
            }
            for at in 0..file.len() {
                let mut file = file.to_vec();
                file[at] ^= 0x55;
                // What is not noticed has changed nothing that counts.
                let Ok(npz) = NpzReader::new(&file) else { continue };
                let Ok(Some((_, values))) = npz.array("a") else { continue };
                assert_eq!(values, [0.0, 0.5, 1.0, 0.25, 0.125, 0.75], "byte {at}");
            }
        }
    }
}
