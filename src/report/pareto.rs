//! Pareto fronts: candidates of which none is both cheaper and more accurate.

/// A measured candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidate {
    /// Seconds.
    pub(crate) price: f64,
    /// Error, in any unit.
    pub(crate) error: f64,
}

impl Candidate {
    /// Whether it dominates another candidate: no worse in both and better in one.
    fn dominates(self, other: Self) -> bool {
        self.price <= other.price && self.error <= other.error && self != other
    }
}

/// The Pareto front: rows of the candidates that no other dominates, the cheapest first; of equal ones the first.
pub(crate) fn front(candidates: &[Candidate]) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..candidates.len()).collect();
    let order = |&row: &usize| (candidates[row].price, candidates[row].error);
    rows.sort_by(|a, b| {
        let ((a_price, a_error), (b_price, b_error)) = (order(a), order(b));
        a_price.total_cmp(&b_price).then(a_error.total_cmp(&b_error))
    });
    let mut least = f64::INFINITY;
    rows.retain(|&row| {
        let better = candidates[row].error < least;
        least = least.min(candidates[row].error);
        better
    });
    rows
}

/// The row of the cheapest candidate whose error is at most `error`; none where no candidate reaches it.
pub(crate) fn cheapest(candidates: &[Candidate], error: f64) -> Option<usize> {
    let reaching = (0..candidates.len()).filter(|&row| candidates[row].error <= error);
    reaching.min_by(|&a, &b| candidates[a].price.total_cmp(&candidates[b].price))
}

/// Whether no candidate dominates that of this row.
pub(crate) fn is_on_front(candidates: &[Candidate], row: usize) -> bool {
    !candidates.iter().any(|other| other.dominates(candidates[row]))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::*;

    fn candidates(points: &[(u8, u8)]) -> Vec<Candidate> {
        points.iter().map(|&(price, error)| Candidate { price: price.into(), error: error.into() }).collect()
    }

    proptest! {
        #[test]
        fn the_front_is_what_nothing_beats(points in prop::collection::vec((0_u8..12, 0_u8..12), 0..30)) {
            let candidates = candidates(&points);
            let front = front(&candidates);
            for row in 0..candidates.len() {
                let dominated = candidates.iter().any(|other| other.dominates(candidates[row]));
                // Of equal candidates only one is kept.
                let kept = front.iter().any(|&kept| candidates[kept] == candidates[row]);
                prop_assert_eq!(kept, !dominated);
                prop_assert_eq!(is_on_front(&candidates, row), !dominated);
            }
            let falls = front.windows(2).all(|pair| {
                let [a, b] = [candidates[pair[0]], candidates[pair[1]]];
                a.price < b.price && a.error > b.error
            });
            prop_assert!(falls);
        }

        #[test]
        fn the_cheapest_for_an_error_reaches_it_and_nothing_cheaper_does(
            points in prop::collection::vec((0_u8..12, 0_u8..12), 0..30),
            error in 0_u8..12,
        ) {
            let (candidates, error) = (candidates(&points), f64::from(error));
            match cheapest(&candidates, error) {
                None => prop_assert!(candidates.iter().all(|candidate| candidate.error > error)),
                Some(row) => {
                    prop_assert!(candidates[row].error <= error);
                    let cheaper = |candidate: &&Candidate| candidate.price < candidates[row].price;
                    prop_assert!(candidates.iter().filter(cheaper).all(|candidate| candidate.error > error));
                }
            }
        }
    }
}
