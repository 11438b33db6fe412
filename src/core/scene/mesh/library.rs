//! The material files of an OBJ file: found beside it however their paths are written, and their materials by name.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::mtl::{self, MtlMaterial};
use super::obj::{Group, ObjFile};
use super::text;
use crate::Result;
use crate::scene::material::{Diffuse, Material};

/// Most material files of a mesh.
pub(super) const MOST_FILES: usize = 256;

/// Resolves a path as written, for the value at a place, to a file; or refuses.
pub type Assets<'a> = &'a dyn Fn(&str, &str) -> Result<PathBuf>;

/// All materials of the files that an OBJ file names.
#[derive(Default)]
struct Library {
    materials: Vec<MtlMaterial>,
    /// Materials by their names: as written, without comment and quotes, and in small letters. The last of a name counts.
    names: [HashMap<String, usize>; 3],
    /// How often a name is given to different materials.
    repeated: HashMap<usize, usize>,
}

/// A mesh whose material files are looked for.
pub(super) struct Owner<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its file as written in the project.
    pub written: &'a str,
    /// Its file.
    pub path: &'a Path,
    /// Its place in the project.
    pub place: &'a str,
    /// Of all paths.
    pub assets: Assets<'a>,
}

/// Name, material and faces of each material of a file that is used.
pub(super) fn objects(
    mut file: ObjFile,
    owner: &Owner<'_>,
    notes: &mut Vec<String>,
) -> Vec<(String, Material, Group)> {
    let library = Library::read(&file.libraries, owner, notes);
    // Names that mean the same material are one object.
    let mut objects: Vec<(Option<usize>, String, Group)> = Vec::new();
    let mut known: HashMap<usize, usize> = HashMap::new();
    for (name, group) in file.groups.drain(..) {
        let found = library.find(&name);
        match found.and_then(|material| known.get(&material)) {
            Some(object) => objects[*object].2.append(group),
            None => {
                found.map(|material| known.insert(material, objects.len()));
                let name = found.map_or(&*name, |material| library.materials[material].clean_name());
                objects.push((found, name.to_owned(), group));
            }
        }
    }
    let single = objects.len() == 1;
    let label = |name: String| if single { owner.name.to_owned() } else { format!("{}/{name}", owner.name) };
    let object = |(found, name, group)| {
        let label = label(name);
        let material = library.material(found, &label, notes);
        (label, material, group)
    };
    objects.into_iter().map(object).collect()
}

impl Library {
    /// Reads the files of all `mtllib` lines; notes tell which were not found, or not where the line says.
    fn read(lines: &[String], owner: &Owner<'_>, notes: &mut Vec<String>) -> Self {
        let mut library = Self::default();
        let mut read = Vec::new();
        let mut files = lines.iter().flat_map(|line| owner.files(line));
        for (name, found) in files.by_ref().take(MOST_FILES) {
            match found {
                Ok(found) if read.contains(&found.path) => (),
                Ok(found) => {
                    if found.written != name {
                        let what = format!("its material file '{name}' was found as '{}'", found.written);
                        notes.push(format!("{}: {what}", owner.name));
                    }
                    read.push(found.path);
                    found.materials.into_iter().for_each(|material| library.add(material));
                }
                Err(error) => notes.push(format!("{}: its material file was not used: {error}", owner.name)),
            }
        }
        if files.next().is_some() {
            notes.push(format!("{}: names more than {MOST_FILES} material files; join them", owner.name));
        }
        library
    }

    fn add(&mut self, material: MtlMaterial) {
        let new = self.materials.len();
        for (kind, name) in spellings(&material.name).into_iter().enumerate() {
            let old = self.names[kind].insert(name, new);
            if kind == 0
                && let Some(old) = old
                && !self.materials[old].is_like(&material)
            {
                let count = self.repeated.get(&old).unwrap_or(&1) + 1;
                self.repeated.insert(new, count);
            }
        }
        self.materials.push(material);
    }

    /// The number of the material that `usemtl` names.
    fn find(&self, name: &str) -> Option<usize> {
        spellings(name).iter().zip(&self.names).find_map(|(name, names)| names.get(name).copied())
    }

    /// What a material found by its number is; notes tell what was guessed.
    fn material(&self, found: Option<usize>, label: &str, notes: &mut Vec<String>) -> Material {
        let Some(number) = found else {
            notes.push(format!("{label}: has no material; taken as matt grey"));
            return Material::Diffuse(Diffuse::default());
        };
        let material = &self.materials[number];
        if let Some(count) = self.repeated.get(&number) {
            let name = material.clean_name();
            notes.push(format!(
                "{label}: its material '{name}' is defined {count} times; the last one counts"
            ));
        }
        material.material(label, notes)
    }
}

/// A name as written, without comment and quotes, and in small letters.
fn spellings(name: &str) -> [String; 3] {
    let clean = text::without_quotes(text::without_comment(name));
    [name.to_owned(), clean.to_owned(), clean.to_lowercase()]
}

/// The names of several files on an `mtllib` line, each in quotes or up to `.mtl`.
fn file_names(line: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut rest = line.trim();
    while !rest.is_empty() {
        let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''));
        let quoted = quote.and_then(|quote| Some(rest[1..].find(quote)? + 2));
        let (name, more) = rest.split_at(quoted.unwrap_or_else(|| end_of_name(rest)));
        names.push(name.trim().to_owned());
        rest = more.trim_start();
    }
    names
}

/// Where the first `.mtl` ends that is followed by a space.
fn end_of_name(text: &str) -> usize {
    let lower = text.to_ascii_lowercase();
    let mut ends = lower.match_indices(".mtl").map(|(at, found)| at + found.len());
    ends.find(|end| text[*end..].starts_with(char::is_whitespace)).unwrap_or(text.len())
}

/// A material file that was found.
pub(super) struct Found {
    /// Relative to the folder of the mesh.
    pub(super) written: String,
    pub(super) path: PathBuf,
    materials: Vec<MtlMaterial>,
}

impl Owner<'_> {
    /// The files of an `mtllib` line with their names in it: one that is called as the whole line is, or several.
    pub(super) fn files(&self, line: &str) -> Vec<(String, Result<Found>)> {
        let clean = text::without_comment(line);
        match [line, clean].into_iter().find_map(|whole| self.open(whole).ok()) {
            Some(found) => vec![(found.written.clone(), Ok(found))],
            None => file_names(clean)
                .into_iter()
                .take(MOST_FILES + 1)
                .map(|name| (name.clone(), self.find(&name)))
                .collect(),
        }
    }

    /// The file of a name as written, or else, in letters of any case, along its path or beside the mesh.
    fn find(&self, name: &str) -> Result<Found> {
        let written = self.open(name);
        if written.is_ok() {
            return written;
        }
        let clean = text::without_quotes(name).replace('\\', "/");
        let bare = clean.rsplit('/').next().unwrap_or_default().to_owned();
        let relative = clean.trim_start_matches("./");
        let spaced = bare.replace("%20", " ");
        let candidates = [
            Some(relative.to_owned()),
            self.in_any_case(relative),
            self.in_any_case(&bare),
            self.in_any_case(&spaced),
        ];
        let found = candidates.into_iter().flatten().find_map(|candidate| self.open(&candidate).ok());
        found.map_or(written, Ok)
    }

    fn open(&self, name: &str) -> Result<Found> {
        let absolute = name.starts_with(['/', '\\']) || name.as_bytes().get(1) == Some(&b':');
        let folder = self.written.rfind(['/', '\\']).map_or("", |end| &self.written[..=end]);
        let folder = if absolute { "" } else { folder };
        let path = (self.assets)(&format!("{folder}{name}"), &format!("{}.file, mtllib", self.place))?;
        let materials = mtl::read(&path)?;
        Ok(Found { written: name.to_owned(), path, materials })
    }

    /// A path below the folder of the mesh as its folders and file are really called.
    fn in_any_case(&self, relative: &str) -> Option<String> {
        let mut folder = self.path.parent()?.to_owned();
        let mut real: Vec<String> = Vec::new();
        for part in relative.split('/') {
            if matches!(part, "" | "..") {
                return None;
            }
            let wanted = part.to_lowercase();
            let entries = std::fs::read_dir(&folder).ok()?.flatten();
            let names = entries.filter_map(|entry| entry.file_name().into_string().ok());
            // The order of a folder's entries is the system's.
            let name = names
                .filter(|name| *name == part || name.to_lowercase() == wanted)
                .min_by_key(|name| (name != part, name.clone()))?;
            folder.push(&name);
            real.push(name);
        }
        Some(real.join("/"))
    }
}
