//! The lit part of a picture.

use std::ops::Range;

use lightloom_core::render::Image;

/// Share of the light that may lie beyond each edge.
const BEYOND: f64 = 0.005;
/// Margin on either side, as a share of the part's own size.
const ROOM: f64 = 0.05;

/// A part of a picture, in pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Crop {
    columns: Range<usize>,
    rows: Range<usize>,
}

impl Crop {
    /// The part with nearly all light of a linear picture, with a margin; all of a black picture.
    pub(crate) fn lit(picture: &Image) -> Self {
        let (mut columns, mut rows) = (vec![0.0; picture.width], vec![0.0; picture.height]);
        for (i, pixel) in picture.pixels.iter().enumerate() {
            let light = f64::from(pixel.element_sum());
            columns[i % picture.width] += light;
            rows[i / picture.width] += light;
        }
        Self { columns: middle(&columns), rows: middle(&rows) }
    }

    /// The crop of a picture of the same size.
    ///
    /// # Panics
    /// When the picture is smaller.
    pub(crate) fn cut(&self, picture: &Image) -> Image {
        let row = |y: usize| &picture.pixels[y * picture.width..][self.columns.clone()];
        let pixels = self.rows.clone().flat_map(row).copied().collect();
        Image { width: self.columns.len(), height: self.rows.len(), pixels }
    }
}

/// The range without the dark ends, with a margin.
fn middle(light: &[f64]) -> Range<usize> {
    let most = BEYOND * light.iter().sum::<f64>();
    let beyond = |light: &mut dyn Iterator<Item = &f64>| {
        let mut sum = 0.0;
        light.take_while(|light| (sum += **light, sum).1 < most).count()
    };
    let (before, after) = (beyond(&mut light.iter()), beyond(&mut light.iter().rev()));
    let end = light.len() - after.min(light.len());
    let room = (ROOM * (end - before.min(end)) as f64).ceil() as usize;
    before.min(end).saturating_sub(room)..(end + room).min(light.len())
}

/// A picture no wider than `width` pixels.
pub(crate) fn shrunk(picture: &Image, width: usize) -> Image {
    if picture.width <= width {
        return picture.clone();
    }
    picture.resized(width, (width * picture.height).div_ceil(picture.width))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn what_is_cut_out_holds_the_light() {
        let mut picture = Image::new(50, 40);
        assert_eq!(Crop::lit(&picture).cut(&picture), picture, "a black picture stays whole");
        for (x, y) in [(20, 10), (29, 19)] {
            picture.pixels[y * 50 + x] = Vec3::ONE;
        }
        let crop = Crop::lit(&picture);
        // A twentieth of ten pixels on either side, rounded up.
        assert_eq!((crop.columns.clone(), crop.rows.clone()), (19..31, 9..21));
        assert_eq!(crop.cut(&picture).at(1, 1), Vec3::ONE);
    }

    #[test]
    fn pictures_shrink_and_never_grow() {
        assert_eq!(shrunk(&Image::new(100, 31), 50).height, 16);
        assert_eq!(shrunk(&Image::new(40, 31), 50).width, 40);
    }
}
