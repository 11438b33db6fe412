//! Small projects whose key frames show pictures.

use std::path::Path;

use serde_json::{Value, json};

use super::case::{Input, Limits, Measured};
use super::flow_case::cloud;
use super::scene_case::{folder, limits, render, small, write};
use crate::effort::Effort;
use lightloom_core::{Error, Progress, Result};

/// Pixels along both sides.
const SIDE: usize = 64;

/// `a.exr`, random grains, becomes the picture `second`, which is `a` or `b`; `b.exr` is drawn.
pub(super) struct PictureCase {
    second: &'static str,
    draw: fn(usize, usize) -> f32,
    photons: usize,
}

impl PictureCase {
    pub(super) fn new(second: &'static str, draw: fn(usize, usize) -> f32, effort: Effort) -> Self {
        Self { second, draw, photons: effort.pick(3000, 100_000) }
    }
}

impl Input for PictureCase {
    fn limits(&self) -> Limits {
        limits()
    }

    fn run(&self, progress: &Progress) -> Result<Measured> {
        let folder = folder()?;
        let mut grains = vec![0.0; SIDE * SIDE];
        for p in cloud(7, 300) {
            grains[(p.y * SIDE as f32) as usize * SIDE + (p.x * SIDE as f32) as usize] = 1.0;
        }
        picture(folder.path(), "a.exr", |x, y| grains[y * SIDE + x])?;
        picture(folder.path(), "b.exr", self.draw)?;
        let keys = json!([shown(1, "a"), shown(3, self.second)]);
        render(&small(keys, None, self.photons)?, folder.path(), progress)
    }
}

fn shown(frame: i32, picture: &str) -> Value {
    json!({ "frame": frame, "shows": { "image": { "file": format!("{picture}.exr") } } })
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
