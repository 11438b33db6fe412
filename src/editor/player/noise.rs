//! How steady a part of the film is that should stand still: the noise from frame to frame.

use egui::{ColorImage, Pos2, Rect};

/// Most pictures that are looked at, those around the shown one.
const PICTURES: usize = 25;

/// The noise of a part of the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Steadiness {
    /// Root mean square of what changes from picture to picture and is no steady movement; steps of 255.
    pub(super) noise: f32,
    /// Pictures that were looked at.
    pub(super) pictures: usize,
}

/// The steadiness of a part of the pictures around the one of index `at`; `get` gives those that were read. None where fewer than
/// three follow each other.
///
/// Of three pictures the middle one is compared with the mean of its neighbours: what moves evenly cancels, and noise of the
/// variance s² leaves 3/2 s².
pub(super) fn steadiness(
    (at, count): (usize, usize),
    part: Rect,
    get: impl Fn(usize) -> Option<std::sync::Arc<ColorImage>>,
) -> Option<Steadiness> {
    let first = at.saturating_sub(PICTURES / 2).min(count.saturating_sub(PICTURES));
    let pictures: Vec<_> = (first..count.min(first + PICTURES)).map(get).collect();
    let (mut sum, mut values) = (0.0_f64, 0_usize);
    for three in pictures.windows(3) {
        let [Some(before), Some(now), Some(after)] = three else { continue };
        if before.size != now.size || after.size != now.size {
            continue;
        }
        for index in indices(now.size, part) {
            let channels = |picture: &ColorImage| {
                let [r, g, b, _] = picture.pixels[index].to_array();
                [r, g, b].map(f64::from)
            };
            let (before, now, after) = (channels(before), channels(now), channels(after));
            for channel in 0..3 {
                let off = now[channel] - (before[channel] + after[channel]) / 2.0;
                sum += off * off;
                values += 1;
            }
        }
    }
    let noise = (sum / values.max(1) as f64 / 1.5).sqrt() as f32;
    (values > 0).then(|| Steadiness { noise, pictures: pictures.iter().flatten().count() })
}

/// The pixels of a part of a picture; the part is in shares of its sides.
fn indices([width, height]: [usize; 2], part: Rect) -> impl Iterator<Item = usize> {
    let side = |share: f32, pixels: usize| ((share.clamp(0.0, 1.0) * pixels as f32) as usize).min(pixels);
    let (left, right) = (side(part.left(), width), side(part.right(), width));
    let rows = side(part.top(), height)..side(part.bottom(), height);
    rows.flat_map(move |row| (left..right).map(move |column| row * width + column))
}

/// The part of a picture, in shares of its sides, between two points of the screen on which it fills `shown`.
pub(super) fn part(shown: Rect, from: Pos2, to: Pos2) -> Rect {
    let share = |point: Pos2| {
        let at = (point - shown.min) / shown.size();
        at.clamp(egui::Vec2::ZERO, egui::Vec2::splat(1.0)).to_pos2()
    };
    Rect::from_two_pos(share(from), share(to))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::sync::Arc;

    use egui::{Color32, pos2};

    use super::*;

    /// Pictures that brighten evenly; the right half has noise of ±`noise` besides.
    fn film(count: usize, noise: i32) -> Vec<Arc<ColorImage>> {
        let mut state = 7_u32;
        let mut coin = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            if state >> 31 == 0 { -1 } else { 1 }
        };
        let picture = |frame: usize| {
            let pixel = |i: usize| {
                let off = if i % 64 >= 32 { noise * coin() } else { 0 };
                Color32::from_gray((60 + 2 * frame as i32 + off) as u8)
            };
            Arc::new(ColorImage::new([64, 32], (0..64 * 32).map(pixel).collect()))
        };
        let mut picture = picture;
        (0..count).map(&mut picture).collect()
    }

    #[test]
    fn even_movement_is_steady_and_noise_is_told_by_its_deviation() {
        let film = film(40, 5);
        let of = |left: f32, right: f32| {
            let part = Rect::from_min_max(pos2(left, 0.0), pos2(right, 1.0));
            steadiness((10, film.len()), part, |index| Some(film[index].clone())).unwrap()
        };
        assert_eq!(of(0.0, 0.5), Steadiness { noise: 0.0, pictures: 25 });
        // Of 23 x 1024 values the deviation is known to half a per cent.
        assert!((of(0.5, 1.0).noise - 5.0).abs() < 0.1, "{:?}", of(0.5, 1.0));
    }

    #[test]
    fn nothing_is_said_of_two_pictures_or_of_an_empty_part() {
        let film = film(2, 5);
        let get = |index: usize| film.get(index).cloned();
        assert_eq!(steadiness((0, 2), Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), get), None);
        assert_eq!(steadiness((0, 40), Rect::from_min_max(pos2(0.2, 0.2), pos2(0.2, 0.9)), get), None);
    }
}
