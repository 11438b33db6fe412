//! APNG: all colours, and of each frame only what changed.

use std::io::Write;

use png::{BitDepth, BlendOp, ColorType, Compression, DisposeOp, Encoder, SrgbRenderingIntent};

use super::delta::Window;
use super::job::Film;
use super::reel::CHANNELS;
use super::timing::fraction;
use crate::Result;

pub(super) fn write(film: &Film, file: &mut dyn Write) -> Result<()> {
    let size @ [width, height] = film.reel.size();
    let mut encoder = Encoder::new(file, width as u32, height as u32);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder.set_compression(Compression::Balanced);
    // 0 plays: for ever.
    encoder.set_animated(film.reel.count() as u32, 0).map_err(film.refused())?;
    let mut writer = encoder.write_header().map_err(film.refused())?;
    let mut before: Option<Vec<u8>> = None;
    for (index, hold) in film.holds.iter().enumerate() {
        film.check()?;
        let picture = film.reel.get(index)?;
        let same = |i: usize| before.as_ref().is_some_and(|before| pixel(before, i) == pixel(&picture, i));
        let window = match &before {
            None => Window::whole(size),
            Some(_) => Window::around(size, |i| !same(i)),
        };
        let (delay, seconds) = fraction(*hold, film.frames_per_second);
        writer.set_frame_delay(delay, seconds).map_err(film.refused())?;
        if before.is_some() {
            writer.reset_frame_position().map_err(film.refused())?;
            writer
                .set_frame_dimension(window.width as u32, window.height as u32)
                .and_then(|()| writer.set_frame_position(window.left as u32, window.top as u32))
                .and_then(|()| writer.set_blend_op(BlendOp::Over))
                .and_then(|()| writer.set_dispose_op(DisposeOp::None))
                .map_err(film.refused())?;
        }
        let pixels = window.pixels(width);
        let bytes: Vec<u8> =
            pixels.flat_map(|i| if same(i) { [0; 4] } else { opaque(pixel(&picture, i)) }).collect();
        writer.write_image_data(&bytes).map_err(film.refused())?;
        film.progress.advance(1);
        before = Some(picture);
    }
    writer.finish().map_err(film.refused())
}

fn pixel(picture: &[u8], index: usize) -> [u8; CHANNELS] {
    let start = index * CHANNELS;
    [picture[start], picture[start + 1], picture[start + 2]]
}

fn opaque([r, g, b]: [u8; CHANNELS]) -> [u8; 4] {
    [r, g, b, u8::MAX]
}
