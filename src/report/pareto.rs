//! What is worth its price: points of which none is both cheaper and better.

/// Something measured: its price, and how far it is from right. Both the less the better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Offer {
    /// Seconds.
    pub(super) price: f64,
    /// Error, in any unit.
    pub(super) error: f64,
}

impl Offer {
    /// Whether it is no worse in both and better in one.
    fn beats(self, other: Self) -> bool {
        self.price <= other.price && self.error <= other.error && self != other
    }
}

/// Rows of the offers that no other beats, the cheapest first; of equal ones the first.
pub(super) fn front(offers: &[Offer]) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..offers.len()).collect();
    let order = |&row: &usize| (offers[row].price, offers[row].error);
    rows.sort_by(|a, b| {
        let ((a_price, a_error), (b_price, b_error)) = (order(a), order(b));
        a_price.total_cmp(&b_price).then(a_error.total_cmp(&b_error))
    });
    let mut least = f64::INFINITY;
    rows.retain(|&row| {
        let better = offers[row].error < least;
        least = least.min(offers[row].error);
        better
    });
    rows
}

/// The row of the cheapest offer whose error is at most `error`; none where no offer reaches it.
pub(super) fn cheapest(offers: &[Offer], error: f64) -> Option<usize> {
    let reaching = (0..offers.len()).filter(|&row| offers[row].error <= error);
    reaching.min_by(|&a, &b| offers[a].price.total_cmp(&offers[b].price))
}

/// Whether the front keeps the offer of this row.
pub(super) fn is_worth_it(offers: &[Offer], row: usize) -> bool {
    !offers.iter().any(|other| other.beats(offers[row]))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use proptest::prelude::*;

    fn offers(points: &[(u8, u8)]) -> Vec<Offer> {
        points.iter().map(|&(price, error)| Offer { price: price.into(), error: error.into() }).collect()
    }

    proptest! {
        #[test]
        fn the_front_is_what_nothing_beats(points in prop::collection::vec((0_u8..12, 0_u8..12), 0..30)) {
            let offers = offers(&points);
            let front = front(&offers);
            for row in 0..offers.len() {
                let beaten = offers.iter().any(|other| other.beats(offers[row]));
                // Of equal offers only one is kept.
                let kept = front.iter().any(|&kept| offers[kept] == offers[row]);
                prop_assert_eq!(kept, !beaten);
                prop_assert_eq!(is_worth_it(&offers, row), !beaten);
            }
            let falls = front.windows(2).all(|pair| {
                let [a, b] = [offers[pair[0]], offers[pair[1]]];
                a.price < b.price && a.error > b.error
            });
            prop_assert!(falls);
        }

        #[test]
        fn the_cheapest_for_an_error_reaches_it_and_nothing_cheaper_does(
            points in prop::collection::vec((0_u8..12, 0_u8..12), 0..30),
            error in 0_u8..12,
        ) {
            let (offers, error) = (offers(&points), f64::from(error));
            match cheapest(&offers, error) {
                None => prop_assert!(offers.iter().all(|offer| offer.error > error)),
                Some(row) => {
                    prop_assert!(offers[row].error <= error);
                    let cheaper = |offer: &&Offer| offer.price < offers[row].price;
                    prop_assert!(offers.iter().filter(cheaper).all(|offer| offer.error > error));
                }
            }
        }
    }
}
