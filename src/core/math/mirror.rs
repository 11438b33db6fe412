//! Indices beyond the border of a grid.

/// The index in 0..`count` that stands for one beyond: the border mirrors what is inside, as often as it takes.
#[inline]
pub fn mirrored(index: isize, count: usize) -> usize {
    let index = index.rem_euclid(2 * count as isize) as usize;
    index.min(2 * count - 1 - index)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_border_mirrors_again_and_again() {
        let seen: Vec<usize> = (-4..7).map(|index| mirrored(index, 3)).collect();
        assert_eq!(seen, [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]);
    }
}
