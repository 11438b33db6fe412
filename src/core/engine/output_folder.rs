//! The output folder of a run.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::export::FilmFormat;
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
    for input in inputs(project_path, project)
        .filter_map(|path| path.canonicalize().ok())
        .filter(|path| path.parent() == Some(&folder))
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

/// Checks that a film can be written to `path` before hours of work go there: its kind is known and needs nothing that is
/// missing, its folder can be made and written into, and it takes no place of a file that the project is made from.
///
/// # Errors
/// The first of these that does not hold, named by `place`, such as "--film".
pub fn prepare_film(path: &Path, project_path: &Path, project: &Project, place: &str) -> Result<()> {
    FilmFormat::of(path, place)?.require(place)?;
    if path.is_dir() {
        return Err(Error::value(place, format!("'{}' is a folder; name a file", path.display())));
    }
    let dir = path.parent().filter(|dir| !dir.as_os_str().is_empty()).unwrap_or(Path::new("."));
    std::fs::create_dir_all(dir).map_err(Error::io("create the folder", dir))?;
    tempfile::Builder::new().tempfile_in(dir).map_err(Error::io("write into the folder", dir))?;
    let place_of = |path: &Path| path.canonicalize().ok();
    let same = |input: &Path| place_of(path).is_some_and(|film| place_of(input) == Some(film));
    if inputs(project_path, project).any(|input| same(&input)) {
        let what = format!(
            "'{}' is what the project is made from, and would be overwritten; name another file",
            path.display()
        );
        return Err(Error::value(place, what));
    }
    Ok(())
}

/// The files that a project is made from, and its own.
fn inputs<'a>(project_path: &'a Path, project: &'a Project) -> impl Iterator<Item = PathBuf> + 'a {
    let base = project_path.parent().unwrap_or(Path::new(""));
    project.files().into_iter().map(move |file| base.join(file)).chain([project_path.to_owned()])
}

/// Whether a report may write a file of this name: any table or plot in a folder of that name.
fn is_of_report(path: &Path) -> bool {
    let ends = |name: &str| path.extension().is_some_and(|extension| extension == name);
    path.parent().is_some_and(|folder| folder.ends_with("report")) && (ends("csv") || ends("svg"))
}

/// The contact sheet in an output folder.
pub(super) const CONTACT_SHEET: &str = "contact_sheet.png";

/// Files in an output folder beside the frames.
const OUTPUTS: [&str; 9] = [
    "summary.json",
    CONTACT_SHEET,
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
