//! The example projects that show the paper's figures, judged by the tracks they store.

use std::path::PathBuf;

use crate::crossing::crosses;
use glam::Vec2;
use lightloom_core::Progress;
use lightloom_core::constraint::{Constraint, Wall};
use lightloom_core::engine::{Engine, Quality, Summary};
use lightloom_core::files::npy;
use lightloom_core::project::{AssetFolder, Project};

fn path(name: &str) -> PathBuf {
    crate::root().join("projects").join(name)
}

fn all_projects() -> Vec<String> {
    let files = std::fs::read_dir(path("")).unwrap();
    let mut names: Vec<_> = files.map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Rows of photon positions, one row for each step, of a fit at preview quality, with `walls` beside what is drawn.
fn tracks_with(walls: &[Wall], name: &str, photons: u64) -> (Project, Vec<Vec<Vec2>>, Summary) {
    let mut project = Quality::Preview.apply(&Project::load(&path(name)).unwrap());
    project.render.photons = photons;
    project.constraints.extend(walls.iter().cloned().map(Constraint::Wall));
    let out = tempfile::tempdir().unwrap();
    let assets = AssetFolder::new(&path(name), false).unwrap();
    let summary = Engine::new(assets).fit(&project, out.path(), &Progress::new(), &|_| ()).unwrap();
    let (header, numbers) = npy::parse(&std::fs::read(out.path().join("tracks.npy")).unwrap()).unwrap();
    let [_, count, _] = header.shape[..] else { panic!("three axes") };
    let rows = numbers.chunks_exact(2 * count as usize);
    let row = |row: &[f32]| row.chunks_exact(2).map(|p| Vec2::new(p[0], p[1])).collect();
    (project, rows.map(row).collect(), summary)
}

fn tracks(name: &str, photons: u64) -> (Project, Vec<Vec<Vec2>>, Summary) {
    tracks_with(&[], name, photons)
}

#[test]
fn no_photon_of_any_example_crosses_a_wall() {
    let mut walled = 0;
    for name in all_projects() {
        let drawn = Project::load(&path(&name)).unwrap().constraints;
        let walls: Vec<Vec<Vec2>> = drawn
            .iter()
            .filter(|constraint| matches!(constraint, Constraint::Wall(_)))
            .map(|wall| wall.points().iter().map(|&p| Vec2::from(p)).collect())
            .collect();
        if walls.is_empty() {
            continue;
        }
        walled += 1;
        let (_, rows, summary) = tracks(&name, 10_000);
        let through = |a: Vec2, b: Vec2| {
            walls.iter().flat_map(|wall| wall.windows(2)).any(|w| crosses(a, b, w[0], w[1]))
        };
        let crossings: usize = rows
            .windows(2)
            .map(|step| step[0].iter().zip(&step[1]).filter(|(a, b)| through(**a, **b)).count())
            .sum();
        let flow = summary.flow.unwrap().flow;
        println!("{name}: {crossings} crossings, {} shut off", flow.unreachable);
        assert_eq!((crossings, flow.wall_crossings, flow.unreachable), (0, 0, 0), "{name}");
        assert_eq!(flow.endpoint_error, 0.0);
    }
    assert!(walled >= 2);
}

/// Distance of points of the plane to the strokes of either letter, from their pictures as placed in the project.
struct Band {
    lit: Vec<Vec2>,
}

impl Band {
    fn of(project: &Project) -> Self {
        let mut lit = Vec::new();
        for file in project.files() {
            let picture = image::open(path("").join(file)).unwrap().to_luma8();
            let (width, height) = (picture.width() as f32, picture.height() as f32);
            let pixel = 0.9 / width.max(height);
            for (x, y, value) in picture.enumerate_pixels().filter(|(x, y, _)| (x + y) % 8 == 0) {
                if value.0[0] > 80 {
                    let at = Vec2::new(x as f32 + 0.5 - width / 2.0, height / 2.0 - y as f32 - 0.5);
                    lit.push(Vec2::splat(0.5) + at * pixel);
                }
            }
        }
        Self { lit }
    }

    fn holds(&self, p: Vec2, width: f32) -> bool {
        self.lit.iter().any(|q| p.distance_squared(*q) <= width * width)
    }

    /// Photons that are ever farther than half a stroke from both letters.
    fn strays(&self, rows: &[Vec<Vec2>]) -> usize {
        let mut strays = vec![false; rows[0].len()];
        for row in rows.iter().step_by(rows.len() / 20) {
            for (stray, &p) in strays.iter_mut().zip(row).filter(|(stray, _)| !**stray) {
                *stray = !self.holds(p, 0.05);
            }
        }
        strays.into_iter().filter(|stray| *stray).count()
    }
}

/// Fig. 3: without walls a part of the C breaks off and crosses the hollow. These begin at the strokes, so that no light goes
/// around them.
#[test]
fn walls_keep_the_light_of_the_letter_on_its_strokes() {
    let hollows = [
        vec![[0.385, 0.635], [0.45, 0.605], [0.55, 0.585], [0.65, 0.575], [0.97, 0.59]],
        vec![[0.35, 0.405], [0.45, 0.41], [0.56, 0.39], [0.62, 0.34]],
    ];
    let [(project, walled, _), (_, free, _)] =
        [&hollows.map(Wall::new)[..], &[]].map(|walls| tracks_with(walls, "letters_free.json", 5000));
    let band = Band::of(&project);
    let (walled, free) = (band.strays(&walled), band.strays(&free));
    println!("strays of 5000: {walled} with walls, {free} without");
    assert!(free > 250, "the walls have something to do: {free}");
    // The cells of the matching are as coarse as 5000 photons make them; 100 000 leave 21 strays, 0.02 %.
    assert!(walled * 20 < free, "{walled} against {free}");
}
