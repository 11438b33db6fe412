//! Reads the pictures of a sequence on a thread of its own, those that are played next first.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;

use egui::{Color32, ColorImage};
use image::RgbImage;
use image::imageops::thumbnail;

use super::Sequence;
use crate::editor::guard::Guard;

/// Bytes that all pictures of a sequence may take; larger ones are held smaller.
const BUDGET: f64 = 768.0 * 1_048_576.0;

/// A picture, once it was read, or why it cannot be.
pub type Slot = Option<Result<Arc<ColorImage>, String>>;

/// The pictures of a sequence, growing.
pub struct Loader {
    shared: Arc<Shared>,
}

struct Shared {
    files: Vec<PathBuf>,
    slots: Mutex<Vec<Slot>>,
    /// The index from which on pictures are wanted.
    wanted: AtomicUsize,
    stopped: AtomicBool,
}

impl Loader {
    /// Begins to read a sequence. `wake` is called after each picture.
    ///
    /// # Errors
    /// The system starts no thread.
    pub fn start(sequence: &Sequence, wake: impl Fn() + Send + 'static) -> Result<Self, String> {
        let files: Vec<PathBuf> = sequence.frames.iter().map(|(_, file)| file.clone()).collect();
        let shared = Arc::new(Shared {
            slots: Mutex::new(vec![None; files.len()]),
            files,
            wanted: AtomicUsize::new(0),
            stopped: AtomicBool::new(false),
        });
        let (reader, guard) = (shared.clone(), Guard::new("player"));
        let thread = thread::Builder::new().name("player".into()).spawn(move || reader.read(&guard, &wake));
        thread.map_err(|error| format!("the system starts no thread to read pictures: {error}"))?;
        Ok(Self { shared })
    }

    /// The picture with this index, which is wanted next if it is not there yet.
    pub fn get(&self, index: usize) -> Slot {
        self.shared.wanted.store(index, Relaxed);
        self.shared.lock().get(index).cloned().flatten()
    }

    /// The picture with this index, if it was read.
    pub fn seen(&self, index: usize) -> Option<Arc<ColorImage>> {
        self.shared.lock().get(index)?.as_ref()?.as_ref().ok().cloned()
    }

    /// Number of pictures that were read.
    pub fn count(&self) -> usize {
        self.shared.lock().iter().flatten().count()
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        self.shared.stopped.store(true, Relaxed);
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Vec<Slot>> {
        self.slots.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reads until all are there, or nobody wants them.
    fn read(&self, guard: &Guard, wake: &dyn Fn()) {
        while let Some(index) = self.next().filter(|_| !self.stopped.load(Relaxed)) {
            let file = &self.files[index];
            let fault =
                |words| Err(format!("'{}' cannot be shown: a fault of the program: {words}", file.display()));
            let picture = guard.run(|| picture(file, self.files.len())).unwrap_or_else(fault);
            self.lock()[index] = Some(picture.map(Arc::new));
            wake();
        }
    }

    /// The first that is missing from the wanted one on, and then from the first.
    fn next(&self) -> Option<usize> {
        let (slots, wanted) = (self.lock(), self.wanted.load(Relaxed));
        (wanted..slots.len()).chain(0..wanted.min(slots.len())).find(|index| slots[*index].is_none())
    }
}

/// Reads one of `count` pictures.
fn picture(file: &Path, count: usize) -> Result<ColorImage, String> {
    let told = |error: &dyn std::fmt::Display| format!("'{}' cannot be shown: {error}", file.display());
    let read = image::open(file).map_err(|error| told(&error))?.into_rgb8();
    let bytes = f64::from(read.width()) * f64::from(read.height()) * size_of::<Color32>() as f64;
    let scale = (BUDGET / (bytes * count as f64)).sqrt().min(1.0);
    let side = |pixels: u32| (f64::from(pixels) * scale).floor().max(1.0) as u32;
    let held: RgbImage =
        if scale < 1.0 { thumbnail(&read, side(read.width()), side(read.height())) } else { read };
    let size = [held.width() as usize, held.height() as usize];
    Ok(ColorImage::from_rgb(size, held.as_raw()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::editor::guard;

    #[test]
    fn a_panic_costs_one_picture_and_the_others_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let file = |number: i32| folder.path().join(format!("{number}.png"));
        for number in 1..=3 {
            RgbImage::from_pixel(4, 2, image::Rgb([9, 9, 9])).save(file(number)).unwrap();
        }
        let frames = (1..=3).map(|number| (number, file(number))).collect();
        let sequence = Sequence { frames, frames_per_second: [24, 1] };
        let loader = guard::planted("player", || Loader::start(&sequence, || ()).unwrap());
        while loader.count() < 3 {
            thread::yield_now();
        }
        let [first, second, third] = [0, 1, 2].map(|index| loader.get(index).unwrap());
        assert!(first.unwrap_err().contains("1.png' cannot be shown: a fault of the program: a planted"));
        assert!(second.is_ok() && third.is_ok());
    }
}
