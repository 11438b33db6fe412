//! Thumbnails of listed pictures, decoded one after another on a thread of its own, within limits.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;

use egui::{ColorImage, Context, TextureHandle, TextureOptions};
use image::{ImageReader, Limits};
use lightloom_core::targets::{Brightness, ImageTarget};

use crate::editor::guard::Guard;

/// Pixels along the longer side.
const SIDE: u32 = 96;
/// Largest file that is decoded, bytes.
const MOST_BYTES: u64 = 64 << 20;
/// Longest side of a picture that is decoded, pixels.
const MOST_SIDE: u32 = 16_384;
/// Most memory of a picture, bytes.
const MOST_MEMORY: u64 = 256 << 20;
/// Endings of what is a picture.
const ENDINGS: [&str; 8] = ["png", "jpg", "jpeg", "webp", "tif", "tiff", "exr", "hdr"];

/// The thumbnails of the open dialog.
pub(super) struct Thumbnails {
    /// By file; none while it is decoded, or where it cannot be.
    made: BTreeMap<PathBuf, Option<TextureHandle>>,
    /// The thread ends when the sender is gone.
    orders: Sender<PathBuf>,
    results: Receiver<(PathBuf, ColorImage)>,
}

impl Thumbnails {
    pub(super) fn new(ctx: &Context) -> Self {
        let (orders, inbox) = channel::<PathBuf>();
        let (outbox, results) = channel();
        let wake = ctx.clone();
        let guard = Guard::new("dialog thumbnails");
        let work = move || {
            for path in inbox {
                // Decoders have had panics on hostile files; such a file has no thumbnail.
                let decoded = guard.run(|| decode(&path)).ok().flatten();
                if let Some(picture) = decoded
                    && outbox.send((path, picture)).is_err()
                {
                    return;
                }
                wake.request_repaint();
            }
        };
        // Without a thread there are no thumbnails.
        let _ = thread::Builder::new().name("dialog thumbnails".into()).spawn(work);
        Self { made: BTreeMap::new(), orders, results }
    }

    /// The thumbnail of a file that is shown now; none yet, or never.
    pub(super) fn of(&mut self, ctx: &Context, path: &Path) -> Option<&TextureHandle> {
        for (path, picture) in self.results.try_iter() {
            let texture = ctx.load_texture("dialog thumbnail", picture, TextureOptions::LINEAR);
            self.made.insert(path, Some(texture));
        }
        if !self.made.contains_key(path) {
            self.made.insert(path.to_owned(), None);
            // Fails only without a thread.
            let _ = self.orders.send(path.to_owned());
        }
        self.made.get(path)?.as_ref()
    }
}

/// Whether a file of this name is a picture.
pub(super) fn is_picture(name: &str) -> bool {
    let ending = Path::new(name).extension().map(|ending| ending.to_string_lossy().to_lowercase());
    ending.is_some_and(|ending| ENDINGS.contains(&&*ending))
}

fn decode(path: &Path) -> Option<ColorImage> {
    // A pipe or a device is not opened.
    std::fs::metadata(path).ok().filter(|data| data.is_file() && data.len() <= MOST_BYTES)?;
    let mut reader = ImageReader::open(path).ok()?.with_guessed_format().ok()?;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(MOST_SIDE), Some(MOST_SIDE));
    limits.max_alloc = Some(MOST_MEMORY);
    reader.limits(limits);
    if let Ok(picture) = reader.decode() {
        let small = picture.thumbnail(SIDE, SIDE).into_rgba8();
        let size = [small.width() as usize, small.height() as usize];
        return Some(ColorImage::from_rgba_unmultiplied(size, &small));
    }
    // OpenEXR, as it attracts light.
    let Brightness { width, values, .. } =
        Brightness::load(path, &ImageTarget::new(""), SIDE as usize).ok()?;
    let grey: Vec<u8> = values.iter().map(|value| (255.0 * value.powf(1.0 / 2.2)) as u8).collect();
    Some(ColorImage::from_gray([width, grey.len() / width.max(1)], &grey))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::editor::guard;

    #[test]
    fn a_panic_costs_one_thumbnail_and_the_others_are_made() {
        let folder = tempfile::tempdir().unwrap();
        let files = ["a.png", "b.png"].map(|name| folder.path().join(name));
        for file in &files {
            image::RgbImage::from_pixel(8, 8, image::Rgb([255, 0, 0])).save(file).unwrap();
        }
        let ctx = Context::default();
        let mut thumbnails = guard::planted("dialog thumbnails", || Thumbnails::new(&ctx));
        let first = thumbnails.of(&ctx, &files[0]).is_some();
        while thumbnails.of(&ctx, &files[1]).is_none() {
            thread::yield_now();
        }
        assert!(!first && thumbnails.of(&ctx, &files[0]).is_none());
    }

    #[test]
    fn pictures_become_small_and_what_is_none_or_too_large_has_no_thumbnail() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        image::RgbImage::from_pixel(200, 100, image::Rgb([255, 0, 0])).save(at("red.png")).unwrap();
        let small = decode(&at("red.png")).unwrap();
        assert_eq!((small.size, small.pixels[0]), ([96, 48], egui::Color32::RED));
        std::fs::write(at("no.png"), b"no picture").unwrap();
        // A header that asks for 4e9 pixels in a side.
        let mut huge = std::fs::read(at("red.png")).unwrap();
        huge[16..24].fill(0x7f);
        std::fs::write(at("huge.png"), huge).unwrap();
        for name in ["no.png", "huge.png", "gone.png", "."] {
            assert!(decode(&at(name)).is_none(), "{name}");
        }
        assert!(is_picture("A.PNG") && !is_picture("a.obj"));
    }
}
