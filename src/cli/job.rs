//! What every command that works does around its work: Ctrl-C, the folder, the progress, the summary.

use std::io::Write as _;
use std::path::Path;

use lightloom_core::pipeline::Summary;
use lightloom_core::{Error, Progress, Result};

/// Ctrl-C asks the work to stop; a second one leaves at once.
pub(super) fn stop_on_interrupt(progress: &Progress) {
    let progress = progress.clone();
    let set = ctrlc::set_handler(move || {
        if progress.is_cancelled() {
            std::process::exit(130);
        }
        progress.cancel();
    });
    if let Err(error) = set {
        eprintln!("lightloom: Ctrl-C stops at once and keeps nothing: {error}");
    }
}

/// Makes the output folder, and tries whether files can be made in it before hours of work go there.
pub(super) fn prepare_folder(dir: &Path) -> Result<()> {
    std::fs::create_dir_all(dir).map_err(Error::io("create the folder", dir))?;
    tempfile::Builder::new().tempfile_in(dir).map_err(Error::io("write into the folder", dir))?;
    Ok(())
}

/// Writes summary.json, and prints it as JSON or as a few lines.
pub(super) fn conclude(summary: &Summary, dir: &Path, json: bool) -> Result<()> {
    let text = summary.to_json();
    let path = dir.join("summary.json");
    lightloom_core::files::write_atomic(&path, |file| file.write_all(text.as_bytes()))?;
    print!("{}", if json { text } else { summary.to_text() });
    Ok(())
}
