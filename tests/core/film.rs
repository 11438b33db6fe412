//! Films read back.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use glam::Vec3;
use lightloom_core::export::{FilmFormat, Reel, film, write_film};
use lightloom_core::render::Image;
use lightloom_core::{Error, Progress, Result};

const SIZE: [usize; 2] = [60, 40];
const FRAMES: usize = 12;

/// A coloured gradient that stands still, and a disc that crosses it.
fn picture(frame: usize) -> Image {
    let mut image = Image::new(SIZE[0], SIZE[1]);
    for (i, pixel) in image.pixels.iter_mut().enumerate() {
        let [x, y] = [(i % SIZE[0]) as f32, (i / SIZE[0]) as f32];
        let still = Vec3::new(x / 60.0, y / 40.0, 0.3);
        let inside = (x - 4.0 * frame as f32).hypot(y - 20.0) < 8.0;
        *pixel = if inside { Vec3::new(1.0, 0.9, 0.6) } else { still };
    }
    image
}

fn reel() -> Reel {
    let reel = Reel::new(&std::env::temp_dir(), SIZE, FRAMES).unwrap();
    // In any order.
    (0..FRAMES).rev().for_each(|frame| reel.put(frame, &picture(frame)).unwrap());
    reel
}

fn write(path: &Path, fps: [u32; 2], progress: &Progress) -> Result<()> {
    let format = FilmFormat::of(path, "--film")?;
    write_film(path, format, &reel(), &[1; FRAMES], fps, progress)
}

/// The pictures of a GIF as they are shown, R, G, B, and their delays in 1/100 s.
fn read_gif(path: &Path) -> (Vec<Vec<[u8; 3]>>, Vec<u16>) {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(File::open(path).unwrap()).unwrap();
    assert!(matches!(decoder.repeat(), gif::Repeat::Infinite));
    let mut shown = vec![[0; 3]; SIZE[0] * SIZE[1]];
    let (mut pictures, mut delays) = (Vec::new(), Vec::new());
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        for (i, rgba) in frame.buffer.as_chunks::<4>().0.iter().enumerate() {
            let (x, y) = (i % usize::from(frame.width), i / usize::from(frame.width));
            if rgba[3] > 0 {
                let at = (y + usize::from(frame.top)) * SIZE[0] + x + usize::from(frame.left);
                shown[at] = [rgba[0], rgba[1], rgba[2]];
            }
        }
        pictures.push(shown.clone());
        delays.push(frame.delay);
    }
    (pictures, delays)
}

#[test]
fn a_gif_shows_every_frame_at_the_pace_of_the_project_over_and_over() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gif");
    write(&path, [24, 1], &Progress::new()).unwrap();
    let (pictures, delays) = read_gif(&path);
    assert_eq!(pictures.len(), FRAMES);
    assert_eq!(delays.iter().map(|d| u32::from(*d)).sum::<u32>(), 50);
    for (frame, seen) in pictures.iter().enumerate() {
        let wanted = picture(frame);
        let error = seen.iter().zip(&wanted.pixels).map(|(a, b)| {
            let a = Vec3::from(a.map(|v| f32::from(v) / 255.0));
            (a - *b).abs().element_sum() / 3.0
        });
        // 2400 colours in 255: a step of the dither is about a hundredth of the range.
        let mean = error.sum::<f32>() / wanted.pixels.len() as f32;
        assert!(mean < 0.02, "frame {frame}: {mean}");
    }
}

#[test]
fn a_dark_film_has_colours_enough() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dark.gif");
    let mut dark = Image::new(SIZE[0], SIZE[1]);
    for (i, pixel) in dark.pixels.iter_mut().enumerate() {
        *pixel = Vec3::new(0.12, 0.11, 0.10) * ((i % SIZE[0]) as f32 / 60.0) + 0.02;
    }
    let reel = Reel::new(folder.path(), SIZE, 1).unwrap();
    reel.put(0, &dark).unwrap();
    write_film(&path, FilmFormat::Gif, &reel, &[1], [24, 1], &Progress::new()).unwrap();
    let (pictures, _) = read_gif(&path);
    let step = |(a, b): (&[u8; 3], &Vec3)| (f32::from(a[1]) - 255.0 * b.y).abs();
    // At most the step of the dither to 8 bits, and one more to a colour of the palette.
    assert!(pictures[0].iter().zip(&dark.pixels).map(step).fold(0.0, f32::max) <= 2.0);
    // Every index that a frame uses is one of the table.
    let read = gif::DecodeOptions::new().read_info(File::open(&path).unwrap()).unwrap();
    assert!(read.global_palette().unwrap().len() >= 3 * 20);
}

#[test]
fn what_stands_still_in_a_film_does_not_flicker() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.gif");
    write(&path, [24, 1], &Progress::new()).unwrap();
    let (pictures, _) = read_gif(&path);
    let corner = |picture: &Vec<[u8; 3]>| picture[..SIZE[0] * 8].to_vec();
    assert!(pictures.iter().all(|picture| corner(picture) == corner(&pictures[0])));
}

#[test]
fn an_apng_holds_the_very_pixels_and_the_exact_pace() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.apng");
    write(&path, [24_000, 1001], &Progress::new()).unwrap();
    let decoder = png::Decoder::new(BufReader::new(File::open(&path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let control = reader.info().animation_control.unwrap();
    assert_eq!((control.num_frames as usize, control.num_plays), (FRAMES, 0));
    let mut shown = vec![[0; 3]; SIZE[0] * SIZE[1]];
    let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
    for frame in 0..FRAMES {
        reader.next_frame(&mut buffer).unwrap();
        let of = *reader.info().frame_control().unwrap();
        assert_eq!((of.delay_num, of.delay_den), (1001, 24_000));
        let (width, count) = (of.width as usize, (of.width * of.height) as usize);
        for (i, rgba) in buffer[..count * 4].as_chunks::<4>().0.iter().enumerate() {
            if rgba[3] > 0 {
                let at = (i / width + of.y_offset as usize) * SIZE[0] + i % width + of.x_offset as usize;
                shown[at] = [rgba[0], rgba[1], rgba[2]];
            }
        }
        let png = folder.path().join("frame.png");
        lightloom_core::export::png::write(&png, &picture(frame), Default::default()).unwrap();
        let wanted: Vec<[u8; 3]> = image::open(&png).unwrap().to_rgb8().pixels().map(|p| p.0).collect();
        assert!(shown == wanted, "frame {frame}");
    }
}

#[test]
fn equal_films_have_equal_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["gif", "apng"] {
        let paths = [1, 2].map(|i| folder.path().join(format!("{i}.{name}")));
        paths.iter().for_each(|path| write(path, [24, 1], &Progress::new()).unwrap());
        assert!(fs::read(&paths[0]).unwrap() == fs::read(&paths[1]).unwrap(), "{name}");
    }
}

#[test]
fn a_film_that_is_broken_off_leaves_nothing_and_keeps_the_old_one() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.gif", "a.apng"] {
        let path = folder.path().join(name);
        fs::write(&path, "old").unwrap();
        let progress = Progress::new();
        progress.abandon();
        assert!(matches!(write(&path, [24, 1], &progress), Err(Error::Cancelled)));
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    }
    assert_eq!(folder.path().read_dir().unwrap().count(), 2);
    // Work that was stopped earlier has frames, and gets its film.
    let progress = Progress::new();
    progress.cancel();
    write(&folder.path().join("b.gif"), [24, 1], &progress).unwrap();
}

#[test]
fn a_film_of_one_pixel_can_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let dot = Reel::new(folder.path(), [1, 1], 1).unwrap();
    dot.put(0, &Image::new(1, 1)).unwrap();
    for format in [FilmFormat::Gif, FilmFormat::Apng] {
        let path = folder.path().join(format.extension());
        write_film(&path, format, &dot, &film::holds(&[3]), [24, 1], &Progress::new()).unwrap();
        assert!(path.is_file());
    }
}

#[test]
fn an_unknown_ending_is_refused_with_those_that_are_known() {
    let error = FilmFormat::of(Path::new("shot.avi"), "--film").unwrap_err().to_string();
    assert!(error.starts_with("--film: ") && error.contains(".gif, .apng or .mp4"), "{error}");
    assert_eq!(FilmFormat::of(Path::new("SHOT.GIF"), "").unwrap(), FilmFormat::Gif);
}
