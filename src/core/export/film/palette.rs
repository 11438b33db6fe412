//! The colours of a GIF: one palette for the whole film, and an ordered dither that stands still where the light does.

use std::collections::HashMap;

use quantette::color_space::srgb8_to_oklab;
use quantette::deps::palette::{Oklab, Srgb, cast};
use quantette::{PaletteSize, Pipeline, QuantizeMethod};

use super::{CHANNELS, Reel};
use crate::Result;
use crate::export::png;

/// Colours of a palette; one index of the 256 is left for transparency.
const COLOURS: u8 = 255;
/// The index of transparent pixels.
pub(super) const TRANSPARENT: u8 = COLOURS;
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
        let colours: &[Srgb<u8>] = cast::from_component_slice(pixels.as_flattened());
        let size = PaletteSize::from_u8_clamped(COLOURS);
        let input =
            Pipeline::new().palette_size(size).quantize_method(QuantizeMethod::Wu).input_slice(colours);
        // Only an empty film has no colours.
        let chosen = input.map_or(vec![Srgb::new(0, 0, 0)], |input| input.output_srgb8_palette().into_vec());
        let oklab = srgb8_to_oklab(&chosen);
        Ok(Self { colours: chosen.into_iter().map(|c| [c.red, c.green, c.blue]).collect(), oklab })
    }

    /// The bytes R, G, B of all colours.
    pub(super) fn bytes(&self) -> Vec<u8> {
        self.colours.concat()
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
