//! The colours of a GIF: one palette for the whole film, and an ordered dither that stands still where the light does.

use std::collections::HashMap;

use quantette::PaletteSize;
use quantette::color_space::{oklab_to_srgb8, srgb8_to_oklab};
use quantette::deps::palette::{Oklab, Srgb, cast};
use quantette::wu::{BinnerF32x3, WuF32x3};

use super::reel::{CHANNELS, Reel};
use crate::Result;
use crate::export::png;

/// Most colours of a palette; one index of the 256 is left for transparency.
const COLOURS: u8 = 255;
/// Bins of the histogram along each axis of the box around all colours: films of caustics are dark and nearly grey, and bins
/// over all that a screen shows would leave them a few dozen colours.
const BINS: usize = 80;
/// Most frames and pixels that a palette is chosen from.
const SAMPLES: (usize, usize) = (24, 2_000_000);

/// At most 255 colours.
pub(super) struct Palette {
    colours: Vec<[u8; CHANNELS]>,
    oklab: Vec<Oklab>,
}

/// The two colours between which a pixel is dithered, and the share of the second.
type Mix = (u8, u8, f32);

impl Palette {
    /// The palette of a film, from frames spread over all of it: Wu's quantisation in Oklab.
    ///
    /// # Errors
    /// The scratch file cannot be read.
    pub(super) fn of(reel: &Reel) -> Result<Self> {
        let frames = reel.count().min(SAMPLES.0);
        let [width, height] = reel.size();
        let stride = (frames * width * height).div_ceil(SAMPLES.1).max(1);
        let mut pixels: Vec<[u8; CHANNELS]> = Vec::new();
        for i in 0..frames {
            let bytes = reel.get(i * reel.count() / frames)?;
            pixels.extend(bytes.as_chunks::<CHANNELS>().0.iter().skip(i % stride).step_by(stride));
        }
        let pixels = srgb8_to_oklab(cast::from_component_slice(pixels.as_flattened()));
        let found = WuF32x3::run_slice(&pixels, BinnerF32x3::<BINS, BINS, BINS>::new(ranges(&pixels)));
        // Only an empty film has no colours.
        let chosen =
            found.map_or(Vec::new(), |found| found.palette(PaletteSize::from_u8_clamped(COLOURS)).into_vec());
        let colours: Vec<[u8; CHANNELS]> =
            oklab_to_srgb8(&chosen).into_iter().map(|c| [c.red, c.green, c.blue]).collect();
        Ok(Self { oklab: srgb8_to_oklab(cast::from_component_slice(colours.as_flattened())), colours })
    }

    /// The index of transparent pixels: that of one more colour.
    pub(super) fn transparent(&self) -> u8 {
        self.colours.len() as u8
    }

    /// The bytes R, G, B of all colours, and of that for transparent pixels.
    pub(super) fn bytes(&self) -> Vec<u8> {
        [self.colours.concat(), vec![0; CHANNELS]].concat()
    }

    /// The index of each pixel of a picture: of the nearest colour, or of that on the other side of the pixel's own, by a
    /// threshold that depends on the place alone.
    pub(super) fn indices(&self, rgb: &[u8], width: usize) -> Vec<u8> {
        let mut known: HashMap<[u8; CHANNELS], Mix> = HashMap::new();
        let pixels = rgb.as_chunks::<CHANNELS>().0.iter().enumerate();
        let index = |(i, colour): (usize, &[u8; CHANNELS])| {
            let (near, far, share) = *known.entry(*colour).or_insert_with(|| self.mix(*colour));
            if png::dither(i % width, i / width) < share { far } else { near }
        };
        pixels.map(index).collect()
    }

    fn mix(&self, [r, g, b]: [u8; CHANNELS]) -> Mix {
        let own = srgb8_to_oklab(&[Srgb::new(r, g, b)])[0];
        let near = self.nearest(own);
        let at = self.oklab[near];
        // As far on the other side of the pixel's colour as the nearest is on this one.
        let beyond = Oklab::new(2.0 * own.l - at.l, 2.0 * own.a - at.a, 2.0 * own.b - at.b);
        let far = self.nearest(beyond);
        let [whole, part] =
            [(self.oklab[far], at), (own, at)].map(|(a, b)| [a.l - b.l, a.a - b.a, a.b - b.b]);
        let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let share = if far == near { 0.0 } else { dot(part, whole) / dot(whole, whole).max(1e-12) };
        (near as u8, far as u8, share.clamp(0.0, 1.0))
    }

    fn nearest(&self, to: Oklab) -> usize {
        let distance = |c: &Oklab| (c.l - to.l).powi(2) + (c.a - to.a).powi(2) + (c.b - to.b).powi(2);
        let best = self.oklab.iter().enumerate().min_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b)));
        best.map_or(0, |(index, _)| index)
    }
}

/// The least and the largest values of each coordinate, a little apart.
fn ranges(colours: &[Oklab]) -> [(f32, f32); CHANNELS] {
    let range = |of: fn(&Oklab) -> f32| {
        let [low, high] = [f32::min, f32::max].map(|pick| colours.iter().map(of).reduce(pick).unwrap_or(0.0));
        (low - 1e-4, high + 1e-4)
    };
    [range(|c| c.l), range(|c| c.a), range(|c| c.b)]
}
