//! The folder of logs: one file for each run, of which the last are kept.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use lightloom_core::{Error, Result};

/// Logs that are kept in the state folder, the newest among them.
const KEPT: usize = 3;

/// The file of a run that begins now: the name tells its second (UTC, since 1970), so that names sort by age.
pub(super) fn new_file(logs: &Path) -> PathBuf {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs();
    logs.join(format!("lightloom-{now:012}-{}.log", std::process::id()))
}

/// Removes the oldest logs of a folder, so that there is place for one more.
pub(super) fn make_room(logs: &Path) -> Result<()> {
    let is_ours = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("lightloom-") && name.ends_with(".log")
    };
    let entries = fs::read_dir(logs).map_err(Error::io("read", logs))?;
    let mut old: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(is_ours).collect();
    old.sort();
    // One that is in use elsewhere, or was removed at the same time, is left to the next run.
    let surplus = (old.len() + 1).saturating_sub(KEPT);
    old.into_iter().take(surplus).for_each(|path| drop(fs::remove_file(path)));
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_last_logs_are_kept_and_nothing_else_is_touched() {
        let logs = tempfile::tempdir().unwrap();
        for second in 1..=9 {
            make_room(logs.path()).unwrap();
            fs::write(logs.path().join(format!("lightloom-{second:012}-7.log")), "x").unwrap();
            fs::write(logs.path().join("notes.txt"), "mine").unwrap();
        }
        let mut names: Vec<_> =
            fs::read_dir(&logs).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        let kept = [7, 8, 9].map(|second| format!("lightloom-{second:012}-7.log"));
        assert_eq!(names, [&*kept[0], &kept[1], &kept[2], "notes.txt"]);
    }
}
