//! A target that is the source, one of a single pixel, and one in which one pixel outshines all.

use std::path::Path;

use serde_json::{Value, json};

use super::super::Size;
use super::super::case::{Bound, Case, Measured};
use super::super::light::{folder, limits, render, small, write};
use super::super::walk::{Walk, cloud};
use super::{Group, walk};
use lightloom_core::{Error, Progress, Result};

pub(super) const GROUP: Group = Group { name: "target", cases };

const SIDE: usize = 64;

fn cases(size: Size) -> Vec<Case> {
    let photons = size.pick(3000, 100_000);
    let at_rest = Walk::new(size);
    let source = at_rest.source.clone();
    let at_rest = at_rest.with(source.clone(), source);
    // Half a plane unit apart, no more than rounding moves them.
    let mut hardly = Walk::new(size);
    hardly.target = hardly.source.iter().map(|p| *p * (1.0 + f32::EPSILON)).collect();
    let same = json!([shown(1, "a"), shown(3, "a")]);
    let between = json!([shown(1, "a"), shown(3, "b")]);
    let picture = |name: &str, keys: Value, draw: fn(usize, usize) -> f32, why| {
        Case::new(name, Bound::Holds(limits(why)), move |progress| run(&keys, photons, draw, progress))
    };
    let dark = "a black target attracts nothing; the message names the file";
    let black = json!([shown(1, "a"), shown(3, "b")]);
    vec![
        walk("the source itself", at_rest, "nothing moves, and no number is 0/0"),
        walk("the source but for rounding", hardly, "ways of 1e-8 are ways like others"),
        picture(
            "the same picture twice",
            same,
            |x, y| ((x / 8 + y / 8) % 2) as f32,
            "light at rest keeps its flux",
        ),
        picture("one pixel", between.clone(), |x, y| f32::from(x == 20 && y == 40), "a pixel has an area"),
        picture(
            "one pixel 1e8 times as bright as the others",
            between,
            |x, y| if x == 20 && y == 40 { 1e8 } else { 1.0 },
            "shares of the light are summed in double precision",
        ),
        Case::new("black", Bound::Refused { words: "b.exr", why: dark }, move |progress| {
            run(&black, photons, |_, _| 0.0, progress)
        }),
    ]
}

fn shown(frame: i32, picture: &str) -> Value {
    json!({ "frame": frame, "shows": { "image": { "file": format!("{picture}.exr") } } })
}

/// Renders a project with keys of `a.exr`, random grains, and `b.exr`, as drawn.
fn run(keys: &Value, photons: usize, draw: fn(usize, usize) -> f32, progress: &Progress) -> Result<Measured> {
    let folder = folder()?;
    let mut grains = vec![0.0; SIDE * SIDE];
    for p in cloud(7, 300) {
        grains[(p.y * SIDE as f32) as usize * SIDE + (p.x * SIDE as f32) as usize] = 1.0;
    }
    picture(folder.path(), "a.exr", |x, y| grains[y * SIDE + x])?;
    picture(folder.path(), "b.exr", draw)?;
    render(&small(keys.clone(), None, photons)?, folder.path(), progress)
}

/// A grey picture in single precision.
fn picture(folder: &Path, name: &str, draw: impl Fn(usize, usize) -> f32 + Sync) -> Result<()> {
    use exr::prelude::{SpecificChannels, WritableImage};
    let channels = SpecificChannels::rgb(|at: exr::math::Vec2<usize>| {
        let value = draw(at.x(), at.y());
        (value, value, value)
    });
    let mut bytes = std::io::Cursor::new(Vec::new());
    exr::image::Image::from_channels((SIDE, SIDE), channels)
        .write()
        .to_buffered(&mut bytes)
        .map_err(|error| Error::Numeric { stage: "report", what: error.to_string() })?;
    write(folder, name, bytes.get_ref())
}
