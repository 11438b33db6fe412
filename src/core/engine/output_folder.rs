//! The output folder of a run.

use std::io::Write as _;
use std::path::Path;

use crate::project::Project;
use crate::{Error, Result};

/// Makes the output folder, and tries whether files can be made in it before hours of work go there. No file of the
/// project may take the place of one that it is made from. `place` names the folder in messages, such as "--out".
///
/// # Errors
/// A file stands there; the system refuses; a file would be overwritten that the project is made from.
pub fn prepare_folder(dir: &Path, project_path: &Path, project: &Project, place: &str) -> Result<()> {
    if dir.is_file() {
        return Err(Error::value(place, format!("'{}' is a file; name a folder", dir.display())));
    }
    std::fs::create_dir_all(dir).map_err(Error::io("create the folder", dir))?;
    tempfile::Builder::new().tempfile_in(dir).map_err(Error::io("write into the folder", dir))?;
    let folder = dir.canonicalize().map_err(Error::io("find the folder", dir))?;
    let base = project_path.parent().unwrap_or(Path::new(""));
    let inputs = project.files().into_iter().map(|file| base.join(file)).chain([project_path.to_owned()]);
    for input in
        inputs.filter_map(|path| path.canonicalize().ok()).filter(|path| path.parent() == Some(&folder))
    {
        let name = input.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if OUTPUTS.contains(&name.as_str()) || project.output.writes(&name) || is_of_report(&input) {
            let what = format!(
                "'{name}' there is what the project is made from, and would be overwritten; name another folder"
            );
            return Err(Error::value(place, what));
        }
    }
    Ok(())
}

/// Whether a report may write a file of this name: any table or plot in a folder of that name.
fn is_of_report(path: &Path) -> bool {
    let ends = |name: &str| path.extension().is_some_and(|extension| extension == name);
    path.parent().is_some_and(|folder| folder.ends_with("report")) && (ends("csv") || ends("svg"))
}

/// Files in an output folder beside the frames.
const OUTPUTS: [&str; 9] = [
    "summary.json",
    "contact_sheet.png",
    "tracks.npy",
    "flux.npy",
    "fields.npz",
    "compare.png",
    "compare.json",
    "report.html",
    "report.json",
];

/// Writes the report of a run, such as its summary, as the file `name` of its folder.
///
/// # Errors
/// The system refuses.
pub fn write_report(dir: &Path, name: &str, text: &str) -> Result<()> {
    crate::files::write_atomic(&dir.join(name), |file| file.write_all(text.as_bytes()))
}
