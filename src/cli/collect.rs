//! `lightloom collect`: a project with all its files in one folder.

use lightloom_core::project::{ProjectFile, collect_into};
use lightloom_core::{Error, Result};

use super::args::{self, CollectArgs};
use super::job;
use super::progress::{Lines, Manner};

pub(super) fn run(args: &CollectArgs) -> Result<u8> {
    let (file, notes) = ProjectFile::open(&args.path)?;
    let assets = args::assets(&args.path, args.allow_external)?;
    let (path, collection) = job::shown((Lines::Err, Manner::Auto), |progress, _| {
        collect_into(&args.into, (&file, file.project()), (&args.path, &assets), progress)
    })?;
    let copied: Vec<_> = collection.copied.iter().map(|file| file.to_string_lossy()).collect();
    let notes: Vec<_> = notes.iter().chain(&collection.notes).collect();
    let text = if args.json {
        let result = serde_json::json!({
            "project": path.to_string_lossy(), "copied": copied, "bytes": collection.bytes, "notes": notes,
        });
        serde_json::to_string_pretty(&result).map_err(|e| Error::value("--json", e.to_string()))?
    } else {
        let files = copied.iter().map(|file| format!("Copied: '{file}'\n")).collect::<String>();
        let notes = notes.iter().map(|note| format!("Note: {note}\n")).collect::<String>();
        format!("{files}{notes}Project: '{}'", path.display())
    };
    Lines::Out.print(&text)?;
    Ok(0)
}
