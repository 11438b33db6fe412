//! Which pixels of a path traced picture need more samples.
//!
//! The samples of a pixel are doubled, round by round. By how much that changed its mean is a measure of its error which
//! counts what stratification gains; the variance of the samples does not, and sees noise along every clean edge. One such
//! change is a poor measure, so those of all neighbours are taken together. The pixel itself does not count: if its own
//! samples ended its sampling, it would end where they happen to agree, and what is rare and bright would be lost. So the
//! mean stays unbiased.
//!
//! The accepted error grows as the fourth root of the samples: with the square root, the mean squared error would be the least
//! for a number of samples (Neyman 1934, optimum allocation), but the worst pixels would be twice as bad.
//!
//! Paths branch at glass, so that samples cost more there and are better: they end earlier. That, too, the neighbours decide.
//!
//! On even ground in smooth light the samples of many pixels count together (`smooth`), and few are enough.

use rayon::prelude::*;

use super::smooth::{Quadratic, VARIANCE, neighbourhood};

/// The accepted error after the first samples, relative to a pixel's luminance plus a floor.
const TOLERANCE: f32 = 0.0045;

/// Most samples beside pixels where a sample is several paths, over the first samples.
const MOST_OF_BRANCHES: u32 = 16;

/// Accepted error of pixels taken together, over that of a pixel alone: what is left of their noise is coarser, and seen sooner.
const TOGETHER: f32 = 0.6;

/// What a pixel needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
pub(super) enum Need {
    /// More samples.
    Samples,
    /// To be taken together with its neighbours.
    Neighbours,
    /// Nothing.
    Nothing,
}

/// What the samples of a pixel say so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    /// Mean luminance.
    pub(super) luminance: f32,
    /// The mean luminance of the first half of the samples, less that of all.
    pub(super) change: f32,
    /// Samples.
    pub(super) count: u32,
    /// Whether a sample is several paths, because it met glass or a mirror first.
    pub(super) branches: bool,
    /// Whether all samples met the same even ground first.
    pub(super) even: bool,
}

/// What each pixel needs. `floor` is added to the luminance that errors are relative to, `first` are the samples that all
/// pixels got.
pub(super) fn needs(estimates: &[Estimate], width: usize, floor: f32, first: u32) -> Vec<Need> {
    let height = estimates.len() / width.max(1);
    let around = |i: usize, count: usize| i.saturating_sub(1)..(i + 2).min(count);
    let needs = |i: usize| {
        let count = estimates[i].count as f32;
        let (mut variance, mut luminance, mut neighbours) = (0.0, 0.0, 0.0_f32);
        let mut branches = false;
        for y in around(i / width, height) {
            for j in around(i % width, width).map(|x| y * width + x).filter(|j| *j != i) {
                // As if the neighbour had as many samples as this pixel.
                variance += estimates[j].change.powi(2) * estimates[j].count as f32 / count;
                luminance += estimates[j].luminance;
                neighbours += 1.0;
                branches |= estimates[j].branches;
            }
        }
        let accepted = (TOLERANCE * (luminance / neighbours + floor)).powi(2) * (count / first as f32).sqrt();
        match together(estimates, i, [width, height]) {
            Some(variance) if variance <= accepted * TOGETHER * TOGETHER => Need::Neighbours,
            _ if branches && estimates[i].count >= MOST_OF_BRANCHES * first => Need::Nothing,
            _ if variance > accepted * neighbours => Need::Samples,
            _ => Need::Nothing,
        }
    };
    (0..estimates.len()).into_par_iter().map(needs).collect()
}

/// The variance of a pixel that is taken together with its neighbours; none where their light is not smooth.
fn together(estimates: &[Estimate], i: usize, size: [usize; 2]) -> Option<f32> {
    if !estimates[i].even {
        return None;
    }
    let around = neighbourhood(i, size)?.map(|j| estimates[j]);
    if !around.iter().all(|estimate| estimate.even) {
        return None;
    }
    let noise = around.iter().map(|estimate| estimate.change.powi(2)).sum::<f32>() / around.len() as f32;
    let fit = Quadratic::through(&around.map(|estimate| estimate.luminance));
    // What changes as samples are doubled is more than the error that is left.
    (fit.variance <= noise).then_some(noise * VARIANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETTLED: Estimate =
        Estimate { luminance: 1.0, change: 0.0, count: 16, branches: false, even: false };

    /// A picture of 9 x 9 pixels that has settled but for some.
    fn asked(unsettled: &[usize]) -> Vec<bool> {
        let mut estimates = vec![SETTLED; 81];
        unsettled.iter().for_each(|i| estimates[*i].change = 0.1);
        more(&estimates, 9, 0.5)
    }

    fn more(estimates: &[Estimate], width: usize, floor: f32) -> Vec<bool> {
        needs(estimates, width, floor, 16).iter().map(|need| *need == Need::Samples).collect()
    }

    #[test]
    fn the_neighbours_of_a_noisy_pixel_are_sampled_further_and_its_own_samples_do_not_decide() {
        let wanted = asked(&[40]);
        let around = [30, 31, 32, 39, 41, 48, 49, 50];
        assert!((0..81).all(|i| wanted[i] == around.contains(&i)), "{wanted:?}");
        assert!(asked(&[40, 41])[40] && asked(&[40, 41])[41]);
        assert!(!asked(&[]).contains(&true));
    }

    #[test]
    fn beside_glass_the_samples_end_earlier_whatever_the_pixel_itself_met() {
        let mut row = [Estimate { change: 1.0, count: 256, ..SETTLED }; 4];
        assert_eq!(more(&row, 4, 0.5), [true; 4]);
        row[1].branches = true;
        assert_eq!(more(&row, 4, 0.5), [false, true, false, true]);
    }

    #[test]
    fn corners_and_pictures_of_one_row_have_fewer_neighbours() {
        assert!(asked(&[0])[1] && asked(&[0])[10] && !asked(&[0])[0]);
        let row = [Estimate { luminance: 0.0, change: 1.0, ..SETTLED }; 3];
        assert_eq!(more(&row, 3, 0.1), [true; 3]);
        assert_eq!(more(&row[..1], 1, 0.1), [false]);
    }

    #[test]
    fn even_ground_in_smooth_light_is_taken_together_and_an_edge_of_a_shadow_is_not() {
        // The noise of a pixel alone is twice what is accepted; its sign changes from pixel to pixel.
        let noise = 2.0 * TOLERANCE * 1.5;
        let sign = |i: usize| if i.wrapping_mul(2_654_435_761) >> 16 & 1 == 0 { 1.0 } else { -1.0 };
        let middle = |shade: f32, even: bool| {
            let pixel = |i: usize| Estimate {
                luminance: if i % 9 < 4 { 1.0 - shade } else { 1.0 } + 0.5 * noise * sign(i),
                change: noise,
                even,
                ..SETTLED
            };
            needs(&(0..81).map(pixel).collect::<Vec<_>>(), 9, 0.5, 16)[40]
        };
        assert_eq!(middle(0.0, true), Need::Neighbours);
        assert_eq!(middle(0.0, false), Need::Samples, "an uneven surface");
        assert_eq!(middle(0.2, true), Need::Samples, "an edge");
    }
}
