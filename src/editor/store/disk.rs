//! File operations shared by the store.

use std::io::Write as _;
use std::path::Path;
use std::time::Duration;

use lightloom_core::{Result, files};
use serde::{Deserialize, Serialize};

/// Age from which a temporary file counts as abandoned.
const LEFT_OVER: Duration = Duration::from_secs(24 * 60 * 60);

/// Fingerprint of a file's content: FNV-1a of its bytes, 64 bits. It distinguishes versions of a file; it is not
/// cryptographic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fingerprint(u64);

impl Fingerprint {
    /// The fingerprint of these bytes.
    pub fn of(bytes: &[u8]) -> Self {
        let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        Self(bytes.iter().fold(0xcbf2_9ce4_8422_2325, step))
    }

    /// Its upper 32 bits in hexadecimal, for file names.
    pub(super) fn short(self) -> String {
        format!("{:08x}", self.0 >> 32)
    }
}

/// Writes a file of the editor atomically and durably, creating its folder if needed.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    if let Some(folder) = path.parent() {
        files::make_private(folder)?;
    }
    files::write_atomic(path, |file| file.write_all(bytes))?;
    files::sync_folder_of(path)
}

/// Removes temporary files that a crash left in a folder, recognised by name
/// and age; those that cannot be removed stay.
pub(super) fn sweep(folder: &Path) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let ours =
            name.to_str().is_some_and(|name| name.starts_with(".lightloom-") && name.ends_with(".tmp"));
        let age = || entry.metadata().ok()?.modified().ok()?.elapsed().ok();
        if ours && age().is_some_and(|age| age > LEFT_OVER) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::fs::File;
    use std::time::SystemTime;

    use super::*;

    #[test]
    fn fingerprints_are_those_of_fnv_1a() {
        // Test values of the authors, http://www.isthe.com/chongo/src/fnv/test_fnv.c
        assert_eq!(Fingerprint::of(b""), Fingerprint(0xcbf2_9ce4_8422_2325));
        assert_eq!(Fingerprint::of(b"a"), Fingerprint(0xaf63_dc4c_8601_ec8c));
        assert_eq!(Fingerprint::of(b"foobar"), Fingerprint(0x8594_4171_f739_67e8));
    }

    #[test]
    fn only_old_half_written_files_of_this_program_are_swept_away() {
        let folder = tempfile::tempdir().unwrap();
        let old = SystemTime::now() - 2 * LEFT_OVER;
        for name in [".lightloom-a.tmp", ".lightloom-a.json", "a.tmp"] {
            File::create(folder.path().join(name)).unwrap().set_modified(old).unwrap();
        }
        File::create(folder.path().join(".lightloom-new.tmp")).unwrap();
        sweep(folder.path());
        let mut left: Vec<_> =
            std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        left.sort();
        assert_eq!(left, [".lightloom-a.json", ".lightloom-new.tmp", "a.tmp"]);
    }
}
