//! Thumbnails of the key frames' targets, made on a thread of their own.
//!
//! A thumbnail shows points sampled from the target, as the light will be: placement on the plane is visible, and
//! files of points look as they are.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use egui::{Color32, ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use glam::{Vec2, Vec3};
use lightloom_core::project::Shows;
use lightloom_core::targets::{PictureSampler, Points, load_points};
use lightloom_core::{Error, Result};

use crate::editor::access::Access;
use crate::editor::guard::Guard;

/// Pixels along the longer side.
const SIDE: f32 = 96.0;
/// Points per thumbnail: about ten per lit pixel.
const POINTS: usize = 60_000;

/// The thumbnails made so far, and the thread that makes more.
pub(super) struct Thumbnails {
    made: Vec<(Request, Made)>,
    /// The thread ends when the sender is gone.
    orders: Option<Sender<Request>>,
    results: Option<Receiver<(Request, Result<ColorImage>)>>,
}

/// The subject of a thumbnail.
#[derive(Clone, Debug, PartialEq)]
struct Request {
    shows: Shows,
    /// The project file, whose folder the target's path is relative to.
    project: PathBuf,
    access: Access,
    extent: Vec2,
}

enum Made {
    Waiting,
    Picture(TextureHandle),
    Failed(String),
}

/// The state of a key frame's thumbnail.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Thumbnail {
    /// The physical caustic, shown as an icon.
    Physical,
    /// Its texture.
    Picture(TextureId),
    /// It is being made.
    Waiting,
    /// It cannot be made, and why.
    Failed(String),
}

impl Default for Thumbnails {
    fn default() -> Self {
        let (orders, inbox) = channel::<Request>();
        let (outbox, results) = channel();
        let guard = Guard::new("thumbnails");
        let work = move || {
            for request in inbox {
                let fault =
                    |words| Err(Error::value("thumbnail", format!("a fault of the program: {words}")));
                let made = guard.run(|| picture(&request)).unwrap_or_else(fault);
                if outbox.send((request, made)).is_err() {
                    return;
                }
            }
        };
        let started = thread::Builder::new().name("thumbnails".into()).spawn(work).is_ok();
        Self { made: Vec::new(), orders: started.then_some(orders), results: started.then_some(results) }
    }
}

impl Thumbnails {
    /// The thumbnail of the target `shows` in the project file `project`, on a plane of `extent`. Outside of the
    /// project's folder it reads what `access` admits.
    pub(super) fn of(
        &mut self,
        ctx: &Context,
        shows: &Shows,
        project: &Path,
        access: &Access,
        extent: Vec2,
    ) -> Thumbnail {
        if *shows == Shows::PhysicalCaustic {
            return Thumbnail::Physical;
        }
        self.collect(ctx);
        let same = |request: &Request| {
            let place = request.project == project && request.access == *access;
            request.shows == *shows && request.extent == extent && place
        };
        match self.made.iter().find(|(request, _)| same(request)) {
            Some((_, Made::Picture(texture))) => Thumbnail::Picture(texture.id()),
            Some((_, Made::Failed(why))) => Thumbnail::Failed(why.clone()),
            Some((_, Made::Waiting)) => {
                ctx.request_repaint_after_secs(0.1);
                Thumbnail::Waiting
            }
            None => {
                let (shows, project, access) = (shows.clone(), project.to_owned(), access.clone());
                self.order(Request { shows, project, access, extent });
                ctx.request_repaint_after_secs(0.1);
                Thumbnail::Waiting
            }
        }
    }

    fn order(&mut self, request: Request) {
        let sent = self.orders.as_ref().is_some_and(|orders| orders.send(request.clone()).is_ok());
        let made = if sent { Made::Waiting } else { Made::Failed("no picture could be made".into()) };
        self.made.push((request, made));
    }

    fn collect(&mut self, ctx: &Context) {
        for (request, result) in self.results.iter().flat_map(Receiver::try_iter) {
            let made = match result {
                Ok(image) => Made::Picture(ctx.load_texture("key frame", image, TextureOptions::LINEAR)),
                Err(error) => Made::Failed(error.to_string()),
            };
            if let Some((_, slot)) = self.made.iter_mut().find(|(other, _)| *other == request) {
                *slot = made;
            }
        }
    }
}

fn picture(request: &Request) -> Result<ColorImage> {
    let assets = request.access.assets(&request.project)?;
    let points = match &request.shows {
        Shows::PhysicalCaustic => Points::default(),
        Shows::Image(image) => {
            let path = assets.resolve(&image.file, "image.file")?;
            PictureSampler::load(&path, image, request.extent, "image")?.sample(1, 0, POINTS)
        }
        Shows::Points(points) => {
            load_points(&assets.resolve(&points.file, "points.file")?)?.resampled(POINTS, 1, 0)
        }
    };
    Ok(splat(&points, request.extent))
}

/// The points as light that is added to what is beneath, as bright as their mean where light falls is well seen.
fn splat(points: &Points, extent: Vec2) -> ColorImage {
    let size = (extent * SIDE).max(Vec2::ONE).as_uvec2();
    let (width, height) = (size.x as usize, size.y as usize);
    let mut light = vec![Vec3::ZERO; width * height];
    for (i, p) in points.positions.iter().enumerate() {
        let cell = (*p / extent * size.as_vec2()).floor();
        if cell.cmpge(Vec2::ZERO).all() && cell.cmplt(size.as_vec2()).all() {
            let colour = points.colours.get(i).copied().unwrap_or(Vec3::ONE);
            // Rows count from the top, plane y from the bottom.
            light[(height - 1 - cell.y as usize) * width + cell.x as usize] += colour;
        }
    }
    let lit = light.iter().filter(|colour| **colour != Vec3::ZERO).count().max(1);
    let mean = light.iter().map(|colour| colour.element_sum() / 3.0).sum::<f32>() / lit as f32;
    let screen = |value: f32| (255.0 * (0.8 * value / mean.max(1e-6)).clamp(0.0, 1.0).powf(1.0 / 2.2)) as u8;
    // Without alpha it is added to what is beneath.
    let pixel = |c: &Vec3| Color32::from_rgba_premultiplied(screen(c.x), screen(c.y), screen(c.z), 0);
    let pixels = light.iter().map(pixel).collect();
    ColorImage::new([width, height], pixels)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::editor::guard;

    #[test]
    fn a_panic_costs_one_thumbnail_and_the_others_are_made() {
        let folder = tempfile::tempdir().unwrap();
        let (ctx, project) = (Context::default(), folder.path().join("a.json"));
        std::fs::write(folder.path().join("points.csv"), "x,y\n0.5,0.5\n").unwrap();
        let mut thumbnails = guard::planted("thumbnails", Thumbnails::default);
        let shows: Shows = serde_json::from_str(r#"{ "points": { "file": "points.csv" } }"#).unwrap();
        let mut of = |extent: Vec2| {
            loop {
                match thumbnails.of(&ctx, &shows, &project, &Access::default(), extent) {
                    Thumbnail::Waiting => thread::yield_now(),
                    made => break made,
                }
            }
        };
        let failed = of(Vec2::ONE);
        assert!(matches!(&failed, Thumbnail::Failed(why) if why.contains("a planted panic")), "{failed:?}");
        let made = of(Vec2::new(1.0, 0.5));
        assert!(matches!(made, Thumbnail::Picture(_)), "{made:?}");
    }

    #[test]
    fn light_stands_where_the_points_are_and_up_is_up() {
        let extent = Vec2::new(1.0, 0.5);
        let points =
            Points { positions: vec![Vec2::new(0.01, 0.49), Vec2::new(7.0, f32::NAN)], colours: Vec::new() };
        let image = splat(&points, extent);
        assert_eq!(image.size, [96, 48]);
        let lit: Vec<usize> =
            (0..image.pixels.len()).filter(|i| image.pixels[*i] != Color32::TRANSPARENT).collect();
        assert_eq!(lit, [0], "the upper left corner alone");
    }
}
