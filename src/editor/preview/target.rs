//! The worker that reads the picture towards which the light flows, to lay it over the plane.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use egui::{Color32, ColorImage};
use lightloom_core::Result;
use lightloom_core::targets::{Brightness, ImageTarget, Placement};

use super::subject::Subject;
use super::worker::{Share, Turn, Worker};
use crate::editor::access::Access;

/// Cells along the longer side of what is shown.
const SIDE: usize = 512;
/// Reach of the outline to both sides of an edge, cells: seen also where the picture is small.
const REACH: usize = 3;

/// The picture that was read last.
#[derive(Clone)]
pub struct TargetPicture {
    /// Its outline: white where the picture changes, so that it hides no light beneath.
    pub picture: Arc<ColorImage>,
    /// Size of the file in pixels.
    pub size: glam::Vec2,
}

/// Which file, and what of it.
#[derive(Clone, PartialEq)]
struct Request {
    base: PathBuf,
    access: Access,
    /// Wherever it is placed, the picture is the same.
    image: ImageTarget,
}

/// Reads the newest picture.
pub(super) struct Targets {
    worker: Worker<Request>,
    asked: Option<Request>,
    found: Arc<Mutex<Option<TargetPicture>>>,
}

impl Targets {
    /// `wake` is called when a picture is read.
    pub(super) fn new(wake: impl Fn() + Clone + Send + 'static) -> Self {
        let found: Arc<Mutex<Option<TargetPicture>>> = Arc::default();
        let theirs = found.clone();
        let seen = wake.clone();
        let worker = Worker::new("target", Share::One, wake, move || {
            let (found, seen) = (theirs.clone(), seen.clone());
            move |request: Request, _: &Turn| {
                // What is wrong with the file is told by the animation, which reads it too.
                let read = read(&request).ok();
                *found.lock().unwrap_or_else(PoisonError::into_inner) = read;
                seen();
            }
        });
        Self { worker, asked: None, found }
    }

    /// Reads the picture `image` of a subject, unless it is the last one; none where no picture is shown.
    pub(super) fn follow(&mut self, subject: &Subject, image: Option<&ImageTarget>) {
        let request = image.map(|image| Request {
            base: subject.base.clone(),
            access: subject.access.clone(),
            image: ImageTarget { placement: Placement::default(), ..image.clone() },
        });
        if request == self.asked {
            return;
        }
        *self.found.lock().unwrap_or_else(PoisonError::into_inner) = None;
        self.asked = request.clone();
        if let Some(request) = request {
            self.worker.ask(request);
        }
    }

    /// Lets the next call ask, even if it is for the same.
    pub(super) fn ask_anew(&mut self) {
        self.asked = None;
    }

    /// What a panic of the thread said, once.
    pub(super) fn panicked(&self) -> Option<String> {
        self.worker.panicked()
    }

    pub(super) fn found(&self) -> Option<TargetPicture> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

fn read(Request { base, access, image }: &Request) -> Result<TargetPicture> {
    let path = access.assets(base)?.resolve(&image.file, "target")?;
    let Brightness { size, width, values } = Brightness::load(&path, image, SIDE)?;
    let height = values.len() / width.max(1);
    let pixels = outline(&values, width, height)
        .into_iter()
        .map(|v| Color32::from_white_alpha((v.clamp(0.0, 1.0) * 255.0).round() as u8))
        .collect::<Vec<_>>();
    Ok(TargetPicture { picture: Arc::new(ColorImage::new([width, height], pixels)), size })
}

/// How much the values (row by row) change around each cell: largest less smallest.
fn outline(values: &[f32], width: usize, height: usize) -> Vec<f32> {
    let ranges = |x: usize, y: usize| {
        let rows = y.saturating_sub(REACH)..=(y + REACH).min(height - 1);
        let columns = x.saturating_sub(REACH)..=(x + REACH).min(width - 1);
        let around = rows.flat_map(|row| columns.clone().map(move |column| values[row * width + column]));
        around.fold((f32::INFINITY, f32::NEG_INFINITY), |(least, most), v| (least.min(v), most.max(v)))
    };
    let cells = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    cells.map(|(x, y)| ranges(x, y)).map(|(least, most)| most - least).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_lies_on_the_edge_and_leaves_the_inside_free() {
        let inside = |x: usize, y: usize| (5..25).contains(&x) && (5..25).contains(&y);
        let values: Vec<f32> =
            (0..30).flat_map(|y| (0..40).map(move |x| if inside(x, y) { 1.0 } else { 0.0 })).collect();
        let drawn = outline(&values, 40, 30);
        for (x, y, line) in
            [(15, 15, 0.0), (0, 0, 0.0), (5, 15, 1.0), (2, 15, 1.0), (24, 24, 1.0), (39, 29, 0.0)]
        {
            assert!((drawn[y * 40 + x] - line).abs() < 1e-6, "{x} {y}");
        }
        assert!(outline(&[], 0, 0).is_empty());
    }
}
