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

use rayon::prelude::*;

/// The accepted error after the first samples, relative to a pixel's luminance plus a floor.
const TOLERANCE: f32 = 0.0045;

/// Most samples beside pixels where a sample is several paths, over the first samples.
const MOST_OF_BRANCHES: u32 = 16;

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
}

/// Whether each pixel needs more samples than it has. `floor` is added to the luminance that errors are relative to, `first`
/// are the samples that all pixels got.
pub(super) fn noisy(estimates: &[Estimate], width: usize, floor: f32, first: u32) -> Vec<bool> {
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
        if branches && estimates[i].count >= MOST_OF_BRANCHES * first {
            return false;
        }
        let accepted = TOLERANCE * (luminance + floor * neighbours);
        variance * neighbours > accepted.powi(2) * (count / first as f32).sqrt()
    };
    (0..estimates.len()).into_par_iter().map(needs).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of 9 x 9 pixels that has settled but for some.
    fn asked(unsettled: &[usize]) -> Vec<bool> {
        let mut estimates = vec![Estimate { luminance: 1.0, change: 0.0, count: 16, branches: false }; 81];
        unsettled.iter().for_each(|i| estimates[*i].change = 0.1);
        noisy(&estimates, 9, 0.5, 16)
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
        let mut row = [Estimate { luminance: 1.0, change: 1.0, count: 256, branches: false }; 4];
        assert_eq!(noisy(&row, 4, 0.5, 16), [true; 4]);
        row[1].branches = true;
        assert_eq!(noisy(&row, 4, 0.5, 16), [false, true, false, true]);
    }

    #[test]
    fn corners_and_pictures_of_one_row_have_fewer_neighbours() {
        assert!(asked(&[0])[1] && asked(&[0])[10] && !asked(&[0])[0]);
        let row = [Estimate { luminance: 0.0, change: 1.0, count: 16, branches: false }; 3];
        assert_eq!(noisy(&row, 3, 0.1, 16), [true; 3]);
        assert_eq!(noisy(&row[..1], 1, 0.1, 16), [false]);
    }
}
