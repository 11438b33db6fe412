//! The files of a package, and which of them names what stands in which other.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path as FilePath, PathBuf};

use crate::module::{Module, Path};

/// A package's module tree. Files are numbered as they are met from the root on.
pub(crate) struct Package {
    pub(crate) files: Vec<PathBuf>,
    modules: Vec<Module>,
    parents: Vec<usize>,
    children: Vec<BTreeMap<String, usize>>,
}

/// Where a path leads.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    Module(usize),
    ItemOf(usize),
}

/// Re-exports that lead to each other are followed no further.
const DEEPEST: usize = 16;

impl Package {
    /// The tree below a `lib.rs`.
    pub(crate) fn read(root: &FilePath) -> Self {
        let mut package = Self { files: vec![], modules: vec![], parents: vec![], children: vec![] };
        package.add(root.to_owned(), 0);
        package
    }

    fn add(&mut self, file: PathBuf, parent: usize) -> usize {
        let index = self.files.len();
        let module = Module::read(&fs::read_to_string(&file).unwrap());
        let names = module.children.clone();
        let stem = file.file_stem().unwrap();
        let folder = file.parent().unwrap();
        let folder = if stem == "lib" || stem == "mod" { folder.to_owned() } else { folder.join(stem) };
        self.files.push(file);
        self.modules.push(module);
        self.parents.push(parent);
        self.children.push(BTreeMap::new());
        for name in names {
            let plain = folder.join(format!("{name}.rs"));
            let file = if plain.exists() { plain } else { folder.join(&name).join("mod.rs") };
            let child = self.add(file, index);
            self.children[index].insert(name, child);
        }
        index
    }

    /// Files whose items each file names. A name that is only passed on with `pub use` is not named.
    pub(crate) fn imports(&self) -> Vec<BTreeSet<usize>> {
        (0..self.files.len()).map(|file| self.imports_of(file)).collect()
    }

    fn imports_of(&self, file: usize) -> BTreeSet<usize> {
        let module = &self.modules[file];
        let imported = module.uses.iter().filter(|import| !import.exported).map(|import| &import.path);
        let places = imported.chain(&module.paths).filter_map(|path| self.resolve(file, path, 0));
        let items = places.filter_map(|place| match place {
            Place::ItemOf(other) if other != file => Some(other),
            _ => None,
        });
        items.collect()
    }

    /// Where a path in this file leads; nowhere if it leaves the package or names something local.
    fn resolve(&self, file: usize, path: &[String], depth: usize) -> Option<Place> {
        let (first, rest) = path.split_first()?;
        let mut place = match first.as_str() {
            "crate" => Place::Module(0),
            "self" => Place::Module(file),
            "super" => Place::Module(self.parents[file]),
            name => self.member(file, name, depth)?,
        };
        for segment in rest {
            let Place::Module(module) = place else { break };
            place = match segment.as_str() {
                "super" => Place::Module(self.parents[module]),
                "*" => place,
                name => self.member(module, name, depth).unwrap_or(Place::ItemOf(module)),
            };
        }
        Some(place)
    }

    /// What a module calls by this name: a child, an item, something imported.
    fn member(&self, module: usize, name: &str, depth: usize) -> Option<Place> {
        if depth > DEEPEST {
            return None;
        }
        let own = &self.modules[module];
        if own.items.contains(name) {
            return Some(Place::ItemOf(module));
        }
        if let Some(child) = self.children[module].get(name) {
            return Some(Place::Module(*child));
        }
        let named = own.uses.iter().filter(|import| import.name == name && import.path != [name]);
        let globs = own.uses.iter().filter(|import| import.name == "*").map(|import| {
            let mut path = import.path.clone();
            *path.last_mut().unwrap() = name.to_owned();
            path
        });
        let paths: Vec<Path> = named.map(|import| import.path.clone()).chain(globs).collect();
        paths.iter().find_map(|path| self.resolve(module, path, depth + 1))
    }
}

#[test]
fn names_are_followed_through_re_exports_to_the_file_that_declares_them() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("lib.rs", "mod a; mod b; pub use a::One; pub use b::{self, Two as Other};");
    write("a.rs", "use crate::Other; pub struct One(Other);");
    write("b.rs", "pub struct Two; pub fn one() { super::One::new() }");
    let package = Package::read(&folder.path().join("lib.rs"));
    // lib.rs names nothing of the two: it passes them on.
    assert_eq!(package.imports(), [vec![], vec![2], vec![1]].map(BTreeSet::from_iter));
}
