//! A project with all its files at another place: nothing is lost, nothing is overwritten, nothing is half there.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use lightloom_core::engine::Engine;
use lightloom_core::project::{
    Admitted, AssetFolder, Collect, Collection, Missing, Project, ProjectFile, collect_into,
};
use lightloom_core::render::PlateSettings;
use lightloom_core::{Error, Progress, Result};

/// A triangle of a material that is glass.
fn mesh(mtllib: &str) -> String {
    format!(
        "mtllib {mtllib}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl Glass\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
    )
}

fn material(red: f32) -> String {
    format!("newmtl Glass\nNi 1.5\nd 0.1\nabsorption {red} 0 0\n")
}

struct Place(tempfile::TempDir);

impl Place {
    fn new(files: &[(&str, &str)]) -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        files.iter().for_each(|(path, text)| place.write(path, text));
        place
    }

    fn write(&self, path: &str, text: &str) {
        let path = self.at(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    fn at(&self, path: &str) -> PathBuf {
        self.0.path().canonicalize().unwrap().join(path)
    }

    /// All files below a folder, with their content.
    fn files(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        fn walk(folder: &Path, root: &Path, found: &mut BTreeMap<String, Vec<u8>>) {
            for entry in fs::read_dir(folder).into_iter().flatten() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    walk(&path, root, found);
                } else {
                    let name = path.strip_prefix(root).unwrap().to_string_lossy().into_owned();
                    found.insert(name, fs::read(&path).unwrap());
                }
            }
        }
        let mut found = BTreeMap::new();
        walk(&self.at(folder), &self.at(folder), &mut found);
        found
    }

    /// A project of these meshes and pictures at `path`.
    fn project(&self, path: &str, meshes: &[&str], pictures: &[&str]) -> ProjectFile {
        let mesh = |(i, file): (usize, &&str)| serde_json::json!({ "name": format!("m{i}"), "file": file });
        let key = |(i, file): (usize, &&str)| serde_json::json!({ "frame": 2 + i, "shows": { "image": { "file": file } } });
        let physical = serde_json::json!({ "frame": 1, "shows": "physical_caustic" });
        let keys: Vec<_> = [physical].into_iter().chain(pictures.iter().enumerate().map(key)).collect();
        let text = serde_json::json!({
            "lightloom": 1, "x_kept": 7,
            "scene": { "meshes": meshes.iter().enumerate().map(mesh).collect::<Vec<_>>(), "lights": [{ "type": "point", "name": "lamp" }] },
            "keys": keys,
        });
        self.write(path, &text.to_string());
        ProjectFile::open(&self.at(path)).unwrap().0
    }
}

fn collect(place: &Place, from: &str, into: &str, external: bool) -> Result<(PathBuf, Collection)> {
    let path = place.at(from);
    let (file, _) = ProjectFile::open(&path).unwrap();
    let assets = AssetFolder::new(&path, external)?;
    collect_into(&place.at(into), (&file, file.project()), (&path, &assets), &Progress::new())
}

#[test]
fn the_collected_examples_open_in_their_folder_alone() {
    let root = crate::root();
    for name in ["bottles", "loop", "letters"] {
        let folder = tempfile::tempdir().unwrap();
        let path = root.join("projects").join(name).with_extension("json");
        let (file, _) = ProjectFile::open(&path).unwrap();
        let assets = AssetFolder::new(&path, false).unwrap();
        let into = folder.path().join("handed on/here");
        let (there, collection) =
            collect_into(&into, (&file, file.project()), (&path, &assets), &Progress::new()).unwrap();
        let project = Project::load(&there).unwrap();
        for written in project.files() {
            assert!(written.starts_with("assets/"), "{written}");
        }
        Engine::new(AssetFolder::new(&there, false).unwrap()).check(&project).unwrap();
        // Once more changes nothing.
        let again =
            collect_into(&into, (&file, file.project()), (&path, &assets), &Progress::new()).unwrap().1;
        assert_eq!((again.copied.len(), again.project), (0, collection.project));
    }
}

#[test]
fn material_files_are_found_again_however_a_mesh_names_them() {
    let place = Place::new(&[]);
    let absolute = place.at("work/far.mtl");
    for (name, mtllib, file) in [
        ("plain", "plain.mtl".to_owned(), "work/meshes/plain.mtl"),
        ("below", "mats/below.mtl".to_owned(), "work/meshes/mats/below.mtl"),
        ("above", "../above.mtl".to_owned(), "work/above.mtl"),
        ("case", "CASE.MTL".to_owned(), "work/meshes/case.mtl"),
        ("windows", r"C:\Users\me\win dow.mtl".to_owned(), "work/meshes/win dow.mtl"),
        ("two", "one.mtl two.mtl".to_owned(), "work/meshes/two.mtl"),
        ("absolute", absolute.display().to_string(), "work/far.mtl"),
    ] {
        place.write(&format!("work/meshes/{name}.obj"), &mesh(&mtllib));
        place.write(file, &material(1.0));
    }
    place.write("work/meshes/one.mtl", "newmtl Other\nKd 1 1 1\n");
    let names = ["plain", "below", "above", "case", "windows", "two", "absolute"];
    for name in names {
        place.project("work/shot.json", &[&format!("meshes/{name}.obj")], &[]);
        let (there, collection) =
            collect(&place, "work/shot.json", &format!("out/{name}"), name == "absolute").unwrap();
        assert!(collection.notes.is_empty(), "{name}: {:?}", collection.notes);
        // Only a material file makes the mesh glass.
        let project = ProjectFile::open(&there).unwrap().0.project().clone();
        let text = Engine::new(AssetFolder::new(&there, false).unwrap()).check(&project).unwrap().to_text();
        assert!(!text.contains("was not used") && !text.contains("has no material"), "{name}: {text}");
    }
}

#[test]
fn the_plate_goes_along() {
    let place = Place::new(&[("far/plate.exr", "light")]);
    let file = place.project("work/shot.json", &[], &[]);
    let mut project = file.project().clone();
    project.render.plate = Some(PlateSettings::new("../far/plate.exr"));
    file.save(&place.at("work/shot.json"), &project).unwrap();
    let (there, _) = collect(&place, "work/shot.json", "out", true).unwrap();
    let collected = ProjectFile::open(&there).unwrap().0.project().clone();
    assert_eq!(collected.render.plate, Some(PlateSettings::new("assets/plate.exr")));
    assert_eq!(place.files("out")["assets/plate.exr"], b"light");
}

#[test]
fn what_is_called_the_same_stays_apart() {
    let place = Place::new(&[
        ("work/a/glass.obj", &mesh("glass.mtl")),
        ("work/a/glass.mtl", &material(1.0)),
        ("else/b/glass.obj", &mesh("glass.mtl")),
        ("else/b/glass.mtl", &material(2.0)),
        ("else/logo.png", "first"),
        ("else/more/logo.png", "second"),
        ("else/same/logo.png", "first"),
    ]);
    place.project(
        "work/shot.json",
        &["a/glass.obj", "../else/b/glass.obj"],
        &["../else/logo.png", "../else/more/logo.png", "../else/same/logo.png"],
    );
    place.write("out/assets/glass.obj", "somebody else's");
    let (there, collection) = collect(&place, "work/shot.json", "out", true).unwrap();
    let project = ProjectFile::open(&there).unwrap().0.project().clone();
    assert_eq!(
        project.files(),
        [
            "a/glass.obj",
            "assets/glass_2/glass.obj",
            "assets/logo.png",
            "assets/logo_2.png",
            "assets/logo.png"
        ]
    );
    let files = place.files("out");
    assert_eq!(files["a/glass.mtl"], material(1.0).as_bytes());
    assert_eq!(files["assets/glass_2/glass.mtl"], material(2.0).as_bytes());
    assert_eq!(files["assets/glass.obj"], b"somebody else's");
    assert_eq!((&*files["assets/logo.png"], &*files["assets/logo_2.png"]), (&b"first"[..], &b"second"[..]));
    assert_eq!(collection.copied.len(), 6);
    assert!(fs::read_to_string(&there).unwrap().contains("x_kept"), "unknown members come along");
}

#[test]
fn another_project_is_not_overwritten_and_what_fails_leaves_nothing() {
    let place = Place::new(&[("work/glass.obj", &mesh("none.mtl")), ("work/logo.png", "logo")]);
    place.project("work/shot.json", &["glass.obj"], &["logo.png"]);
    place.write("taken/shot.json", "another");
    let error = collect(&place, "work/shot.json", "taken", false).unwrap_err();
    assert!(error.to_string().contains("another folder"), "{error}");
    assert_eq!(place.files("taken"), BTreeMap::from([("shot.json".to_owned(), b"another".to_vec())]));

    // A file that is missing, and one that must not be read.
    for missing in ["gone.png", "../secret.png"] {
        place.write("secret.png", "secret");
        place.project("work/shot.json", &["glass.obj"], &["logo.png", missing]);
        let error = collect(&place, "work/shot.json", "new", false).unwrap_err().to_string();
        assert!(error.contains(missing), "{error}");
        assert!(!place.at("new").exists());
    }
}

#[test]
fn saved_elsewhere_only_what_would_be_out_of_reach_is_copied() {
    let place = Place::new(&[
        ("work/glass.obj", &mesh("none.mtl")),
        ("work/logo.png", "logo"),
        ("far/trusted.png", "trusted"),
        ("far/picked.png", "picked"),
    ]);
    let pictures = ["logo.png", "../far/trusted.png", "../far/picked.png", "gone.png"];
    let file = place.project("work/shot.json", &["glass.obj"], &pictures);
    let trusted = Admitted::new([place.at("far/trusted.png")]);
    let admitted = Admitted::new(trusted.files());
    admitted.add(&place.at("far/picked.png"));
    let from = place.at("work/shot.json");
    let save = |to: &Path| {
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        let here = AssetFolder::new(&from, false).unwrap().admitting(admitted.clone());
        let there = AssetFolder::new(to, false).unwrap().admitting(trusted.clone());
        let stays = |real: &Path| there.allows(real);
        let collect = Collect { from: &from, assets: &here, to, stays: &stays, missing: Missing::Keep };
        let written = RefCell::new(None);
        let (done, ()) = collect
            .run(file.project(), &Progress::new(), |project| {
                *written.borrow_mut() = Some(project.clone());
                Ok(())
            })
            .unwrap();
        assert_eq!(written.into_inner(), Some(done.project.clone()));
        done
    };
    // In its own folder all stays, but what was only picked.
    let done = save(&place.at("work/again.json"));
    assert_eq!(
        done.project.files(),
        ["glass.obj", "logo.png", "../far/trusted.png", "assets/picked.png", "gone.png"]
    );
    let done = save(&place.at("new/deep/shot.json"));
    assert_eq!(
        done.project.files(),
        ["glass.obj", "logo.png", "../../far/trusted.png", "assets/picked.png", "../../work/gone.png"]
    );
    assert_eq!(place.files("new/deep").len(), 3);

    // A project that cannot be written takes its copies back.
    let to = place.at("full/shot.json");
    fs::create_dir_all(to.parent().unwrap()).unwrap();
    let here = AssetFolder::new(&from, false).unwrap().admitting(admitted);
    let collect = Collect { from: &from, assets: &here, to: &to, stays: &|_| false, missing: Missing::Keep };
    let full = |_: &Project| Err::<(), _>(Error::io("write", "full")(std::io::Error::other("disk full")));
    assert!(collect.run(file.project(), &Progress::new(), full).is_err());
    assert!(place.files("full").is_empty());
    assert_eq!(fs::read_dir(place.at("full")).unwrap().count(), 0, "folders, too");

    let progress = Progress::new();
    progress.cancel();
    assert!(matches!(collect.run(file.project(), &progress, |_| Ok(())), Err(Error::Cancelled)));
}

#[test]
fn an_admitted_file_is_read_and_its_material_file_but_nothing_beside_it() {
    let place = Place::new(&[
        ("work/shot.json", "{}"),
        ("far/meshes/glass.obj", ""),
        ("far/meshes/glass.mtl", ""),
        ("far/mats/glass.mtl", ""),
        ("far/meshes/secret.png", ""),
        ("other/x.mtl", ""),
    ]);
    let admitted = Admitted::default();
    let assets = AssetFolder::new(&place.at("work/shot.json"), false).unwrap().admitting(admitted.clone());
    let reads = |path: &str| {
        let absolute = place.at(path).display().to_string();
        let found = [format!("../{path}"), absolute].map(|written| assets.resolve(&written, "x").is_ok());
        assert_eq!(found[0], found[1]);
        found[0]
    };
    assert!(!reads("far/meshes/glass.obj") && !reads("far/meshes/glass.mtl"));
    admitted.add(&place.at("far/meshes/glass.obj"));
    assert!(reads("far/meshes/glass.obj") && reads("far/meshes/glass.mtl") && reads("far/mats/glass.mtl"));
    assert!(!reads("far/meshes/secret.png") && !reads("other/x.mtl"));
    // Whether a file is there is not told of what must not be read.
    let message = |written: &str| assets.resolve(written, "x").unwrap_err().to_string();
    assert_eq!(
        message("../far/none.png"),
        message("../far/meshes/secret.png").replace("meshes/secret", "none")
    );
}
