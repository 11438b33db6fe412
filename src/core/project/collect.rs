//! A project with its files at another place: collected into a folder, saved elsewhere, or with files copied beside it.
//!
//! Paths are kept where they lead into the new folder; `..` at their front is left out. Material files stay where their mesh
//! looks for them. What stands there already is never overwritten: a file with the same content is used, beside any other
//! the copy gets a number. Copies that were made are taken back when a later one fails.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Component, Path, PathBuf};

use super::relative_path::{is_absolute, moved, normalise, relative};
use super::{AssetFolder, Project, ProjectFile};
use crate::files::{copy_new, is_same_content};
use crate::scene::gltf::GltfFile;
use crate::scene::mesh::material_files;
use crate::{Error, Progress, Result};

/// Most numbers that are tried for a name.
const MOST_NAMES: usize = 10_000;
/// Folder for files that come from outside of the project's.
const ASSETS: &str = "assets";

/// What is done with a file of the project that cannot be found or must not be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// The project names it as before: saving must not fail for it.
    Keep,
    /// An error.
    Refuse,
}

/// Where a project stands, where it goes, and which files go with it.
pub struct Collect<'a> {
    /// The project file, existing or not, that paths are relative to now.
    pub from: &'a Path,
    /// Finds the files now.
    pub assets: &'a AssetFolder,
    /// The project file that paths shall be relative to; absolute, its folder exists.
    pub to: &'a Path,
    /// Whether a file (canonical) stays where it is.
    pub stays: &'a dyn Fn(&Path) -> bool,
    /// What is done with files that are not found.
    pub missing: Missing,
}

/// A project whose files are at its new place.
#[derive(Clone, Debug)]
pub struct Collection {
    /// The project as it names them there.
    pub project: Project,
    /// New paths by old ones, as written.
    pub renamed: BTreeMap<String, String>,
    /// The files that were copied, as they are called now.
    pub copied: Vec<PathBuf>,
    /// Their size together.
    pub bytes: u64,
    /// What was not found, and is not needed to open the project.
    pub notes: Vec<String>,
}

/// Collects the project of a file, as edited, with all its files into `folder`, which is made if it is not there; returns the
/// project file there. `from` is the project file that its paths are relative to.
///
/// # Errors
/// As [`Collect::run`]; another project file of that name stands there.
pub fn collect_into(
    folder: &Path,
    (file, project): (&ProjectFile, &Project),
    (from, assets): (&Path, &AssetFolder),
    progress: &Progress,
) -> Result<(PathBuf, Collection)> {
    let made = !folder.exists();
    std::fs::create_dir_all(folder).map_err(Error::io("create the folder", folder))?;
    let root = folder.canonicalize().map_err(Error::io("find the folder", folder))?;
    let name = from.file_name().unwrap_or(OsStr::new("project.json"));
    let to = root.join(name);
    let from = std::path::absolute(from).map_err(Error::io("find the folder", from))?;
    let stays = |real: &Path| real.starts_with(&root);
    let collect = Collect { from: &from, assets, to: &to, stays: &stays, missing: Missing::Refuse };
    let collected = collect.run(project, progress, |project| {
        let text = file.text_of(project)?;
        if exists(&to) && std::fs::read(&to).ok().as_deref() != Some(text.as_bytes()) {
            return Err(Error::format(&to, "", "stands there already and is another; name another folder"));
        }
        file.save(&to, project)
    });
    if collected.is_err() && made {
        // Only where it is empty.
        let _ = std::fs::remove_dir(folder);
    }
    collected.map(|(collection, _)| (to, collection))
}

/// A file with those that it names: paths from the folder of the first.
struct Bundle {
    main: PathBuf,
    /// Path from the folder of `main`, and the file.
    others: Vec<(PathBuf, PathBuf)>,
}

impl Collect<'_> {
    /// Copies the files, then writes the project that names the copies by `write`; returns what that returns, too.
    ///
    /// # Errors
    /// A file cannot be read or copied, or is missing where that is refused; cancelled; an error of `write`. Then no copy is
    /// left.
    pub fn run<T>(
        &self,
        project: &Project,
        progress: &Progress,
        write: impl FnOnce(&Project) -> Result<T>,
    ) -> Result<(Collection, T)> {
        let mut done = Collection {
            project: project.clone(),
            renamed: BTreeMap::new(),
            copied: Vec::new(),
            bytes: 0,
            notes: Vec::new(),
        };
        let mut copied = BTreeMap::new();
        let mut made = Made::default();
        let mut files = project.files();
        files.sort_unstable();
        files.dedup();
        // Bytes: one large mesh can be nearly all of them.
        let size = |written: &&str| {
            let real = self.assets.resolve(written, written).ok().filter(|real| !(self.stays)(real));
            real.and_then(|real| real.metadata().ok()).map_or(0, |file| file.len())
        };
        progress.begin("copy", files.iter().map(size).sum());
        for written in files {
            progress.check()?;
            let new = self.place(written, &mut copied, &mut made, &mut done, progress)?;
            done.renamed.insert(written.to_owned(), new);
        }
        done.project.rename_files(|file| done.renamed.get(file).cloned().unwrap_or_else(|| file.to_owned()));
        let written = write(&done.project)?;
        (done.copied, done.bytes) = made.keep();
        Ok((done, written))
    }

    /// The new path of a file, which is copied if it has to be.
    fn place(
        &self,
        written: &str,
        copied: &mut BTreeMap<PathBuf, String>,
        made: &mut Made,
        done: &mut Collection,
        progress: &Progress,
    ) -> Result<String> {
        let real = match (self.assets.resolve(written, written), self.missing) {
            (Ok(real), _) => real,
            (Err(_), Missing::Keep) => return Ok(moved(written, self.from, self.to)),
            (Err(error), Missing::Refuse) => return Err(error),
        };
        if (self.stays)(&real) {
            return Ok(moved(written, self.from, self.to));
        }
        if let Some(known) = copied.get(&real) {
            return Ok(known.clone());
        }
        let bundle = self.bundle(written, &real, done, progress)?;
        let folder = self.to.parent().unwrap_or(Path::new(""));
        let placed = self.copy(&bundle, &wanted(written, &real, self.assets), folder, (made, progress))?;
        let new = relative(&placed, self.to);
        copied.insert(real, new.clone());
        Ok(new)
    }

    /// A file with those that it names.
    fn bundle(
        &self,
        written: &str,
        real: &Path,
        done: &mut Collection,
        progress: &Progress,
    ) -> Result<Bundle> {
        let mut others = Vec::new();
        if real.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("obj")) {
            let find = |written: &str, place: &str| self.assets.resolve(written, place);
            let (files, notes) = material_files((written, real), &find, progress)?;
            done.notes.extend(notes);
            others.extend(files.into_iter().map(|file| {
                let path = Path::new(&file.written);
                // A mesh that names a place of one machine finds the file beside itself on another.
                let inside = if is_absolute(&file.written) {
                    file.path.file_name().map_or_else(|| path.to_owned(), PathBuf::from)
                } else {
                    normalise(path)
                };
                (inside, file.path)
            }));
        }
        if GltfFile::is_named(real) {
            let folder = real.parent().unwrap_or(Path::new(""));
            let files = GltfFile::read(real, progress)?.buffer_files();
            others.extend(files.into_iter().map(|file| (normalise(Path::new(&file)), folder.join(&file))));
        }
        Ok(Bundle { main: real.to_owned(), others })
    }

    /// Copies a bundle to the first place where nothing else stands; returns the place of its main file.
    fn copy(
        &self,
        bundle: &Bundle,
        wanted: &Path,
        folder: &Path,
        (made, progress): (&mut Made, &Progress),
    ) -> Result<PathBuf> {
        for number in 1..MOST_NAMES {
            let Some(pairs) = bundle.at(wanted, number, folder) else { continue };
            let mut free = true;
            for (source, place) in &pairs {
                free &= *place != self.to && (!exists(place) || is_same_content(source, place)?);
            }
            if !free {
                continue;
            }
            for (source, place) in &pairs {
                if !exists(place) {
                    made.copy(source, place, progress)?;
                }
            }
            return Ok(pairs.into_iter().next().map(|(_, place)| place).unwrap_or_default());
        }
        let what = format!(
            "all names like '{}' are taken in '{}'; clear the folder",
            wanted.display(),
            folder.display()
        );
        Err(Error::value(bundle.main.display().to_string(), what))
    }
}

/// Whether anything stands at a path, a broken link included.
fn exists(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

/// The path in the new folder that is tried first.
fn wanted(written: &str, real: &Path, assets: &AssetFolder) -> PathBuf {
    let plain: PathBuf =
        normalise(Path::new(written)).components().skip_while(|part| *part == Component::ParentDir).collect();
    let inside = assets.is_inside(real) && !is_absolute(written);
    if inside && plain.components().all(|part| matches!(part, Component::Normal(_))) {
        return plain;
    }
    Path::new(ASSETS).join(real.file_name().unwrap_or_default())
}

impl Bundle {
    /// Sources and places in `folder` of the files, the main one first, as the `number`th attempt; none where a file would
    /// come to lie outside of the folder.
    fn at(&self, wanted: &Path, number: usize, folder: &Path) -> Option<Vec<(PathBuf, PathBuf)>> {
        let main = if number == 1 { wanted.to_owned() } else { self.numbered(wanted, number) };
        let beside = main.parent().unwrap_or(Path::new("")).to_owned();
        let mut pairs = vec![(self.main.clone(), folder.join(&main))];
        for (path, source) in &self.others {
            let place = normalise(&beside.join(path));
            if !place.components().all(|part| matches!(part, Component::Normal(_))) {
                return None;
            }
            pairs.push((source.clone(), folder.join(place)));
        }
        Some(pairs)
    }

    /// Another name for the main file: with a number, or in a folder of its own with the files that it names.
    fn numbered(&self, wanted: &Path, number: usize) -> PathBuf {
        let stem = wanted.file_stem().unwrap_or_default().to_string_lossy();
        if self.others.is_empty() {
            let ending = wanted.extension().map(|e| format!(".{}", e.to_string_lossy())).unwrap_or_default();
            return wanted.with_file_name(format!("{stem}_{number}{ending}"));
        }
        // As deep as the paths of the others lead up.
        let up = |path: &Path| path.components().take_while(|part| *part == Component::ParentDir).count();
        let depth = self.others.iter().map(|(path, _)| up(path)).max().unwrap_or(0);
        let above: Vec<Component> = self.main.parent().into_iter().flat_map(Path::components).collect();
        let tail: PathBuf = above[above.len().saturating_sub(depth)..].iter().collect();
        let name = wanted.file_name().unwrap_or_default();
        Path::new(ASSETS).join(format!("{stem}_{number}")).join(tail).join(name)
    }
}

/// Files and folders that were made; dropped unless kept, they are removed.
#[derive(Default)]
struct Made {
    files: Vec<PathBuf>,
    folders: Vec<PathBuf>,
    bytes: u64,
}

impl Made {
    fn copy(&mut self, source: &Path, place: &Path, progress: &Progress) -> Result<()> {
        let folder = place.parent().unwrap_or(Path::new(""));
        let missing: Vec<_> =
            folder.ancestors().take_while(|folder| !folder.exists()).map(Path::to_owned).collect();
        std::fs::create_dir_all(folder).map_err(Error::io("create the folder", folder))?;
        self.folders.extend(missing.into_iter().rev());
        self.bytes += copy_new(source, place, progress)?;
        self.files.push(place.to_owned());
        Ok(())
    }

    fn keep(mut self) -> (Vec<PathBuf>, u64) {
        self.folders.clear();
        (std::mem::take(&mut self.files), self.bytes)
    }
}

impl Drop for Made {
    fn drop(&mut self) {
        for file in &self.files {
            let _ = std::fs::remove_file(file);
        }
        // Folders that hold something else by now stay.
        for folder in self.folders.iter().rev() {
            let _ = std::fs::remove_dir(folder);
        }
    }
}
