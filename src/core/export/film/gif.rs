//! GIF: one palette, and of each frame only what changed.

use std::borrow::Cow;
use std::io::Write;

use gif::{DisposalMethod, Encoder, Frame, Repeat};
use rayon::prelude::*;

use super::delta::Window;
use super::job::Film;
use super::palette::Palette;
use super::timing::gif_delays;
use crate::Result;

/// Frames that are encoded side by side.
const BATCH: usize = 16;

pub(super) fn write(film: &Film, file: &mut dyn Write) -> Result<()> {
    let size @ [width, height] = film.reel.size();
    let palette = Palette::of(film.reel)?;
    let (columns, rows) = (width as u16, height as u16);
    let mut encoder = Encoder::new(file, columns, rows, &palette.bytes()).map_err(film.refused())?;
    encoder.set_repeat(Repeat::Infinite).map_err(film.refused())?;
    let shown = gif_delays(film.holds, film.frames_per_second);
    let mut before: Option<Vec<u8>> = None;
    for batch in shown.chunks(BATCH) {
        film.check()?;
        let indices = |(index, _): &(usize, u16)| Ok(palette.indices(&film.reel.get(*index)?, width));
        let pictures = batch.par_iter().map(indices).collect::<Result<Vec<_>>>()?;
        let encode = |(i, (_, delay)): (usize, &(usize, u16))| {
            let before = if i == 0 { before.as_ref() } else { Some(&pictures[i - 1]) };
            changed((&pictures[i], before), size, palette.transparent(), *delay)
        };
        let frames: Vec<Frame> = batch.par_iter().enumerate().map(encode).collect();
        for frame in &frames {
            encoder.write_lzw_pre_encoded_frame(frame).map_err(film.refused())?;
        }
        film.progress.advance(batch.len() as u64);
        before = pictures.into_iter().last();
    }
    encoder.into_inner().map_err(film.refused())?;
    Ok(())
}

/// The frame that turns the picture `before` into `picture`, both of indices, where `transparent` leaves a pixel as it is.
fn changed(
    (picture, before): (&[u8], Option<&Vec<u8>>),
    size: [usize; 2],
    transparent: u8,
    delay: u16,
) -> Frame<'static> {
    let same = |i: usize| before.is_some_and(|before| before[i] == picture[i]);
    let window = match before {
        None => Window::whole(size),
        Some(_) => Window::around(size, |i| !same(i)),
    };
    let pixels = window.pixels(size[0]).map(|i| if same(i) { transparent } else { picture[i] });
    let mut frame = Frame {
        delay,
        dispose: DisposalMethod::Keep,
        transparent: before.map(|_| transparent),
        left: window.left as u16,
        top: window.top as u16,
        width: window.width as u16,
        height: window.height as u16,
        buffer: Cow::Owned(pixels.collect()),
        ..Frame::default()
    };
    frame.make_lzw_pre_encoded();
    frame
}
