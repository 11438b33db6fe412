//! The figures for people: names, values and what they tell, the same wherever they are shown.

use super::Continuity;

/// One figure of a [`Continuity`], for people.
pub struct Figure {
    /// A short name, unique.
    pub name: &'static str,
    /// What it tells an artist, and what helps.
    pub help: &'static str,
    /// Digits after the point.
    decimals: usize,
    read: fn(&Continuity) -> Option<f64>,
    /// What is seen is above it.
    limit: fn(&Continuity) -> f64,
}

impl Figure {
    /// Its value; none where the method has none.
    pub fn value(&self, of: &Continuity) -> Option<f64> {
        (self.read)(of)
    }

    /// Whether it is so high that the eye sees it.
    pub fn is_seen(&self, of: &Continuity) -> bool {
        self.value(of).is_some_and(|value| value > (self.limit)(of))
    }

    /// Its value as text; none where the method has none.
    pub fn text(&self, of: &Continuity) -> Option<String> {
        self.value(of).map(|value| {
            let text = format!("{value:.*}", self.decimals);
            // No sign before a zero.
            if text.trim_start_matches(['-', '0', '.']).is_empty() {
                text.trim_start_matches('-').to_owned()
            } else {
                text
            }
        })
    }
}

/// All figures, in the order in which they are shown.
pub const FIGURES: [Figure; 10] = [
    Figure {
        name: "cracks",
        help: "Dark seams that open in the light on its way: the share of all light that they lack, at the worst moment, beyond what both keys have. Up to 0.02 is hardly seen; 0.05 looks like dried clay. What helps: a larger gamma, which lets light thin out instead, or a key between the two",
        decimals: 3,
        read: |of| Some(of.cracks),
        limit: |_| 0.02,
    },
    Figure {
        name: "cracks, mean",
        help: "The same as a mean over the way, below 0 where the keys have more dark seams than what lies between. Near the worst moment's, the light is cracked all along; far below, only for a moment",
        decimals: 3,
        read: |of| Some(of.cracks_mean),
        limit: |_| 0.02,
    },
    Figure {
        name: "torn, source",
        help: "Share of the light that has left its neighbours of the earlier key half way: pieces of that picture break apart too soon. Up to 0.03 is not seen. What helps: a larger alpha, less turbulence, a target nearer by or of a similar shape",
        decimals: 3,
        read: |of| Some(of.torn_source),
        limit: |_| 0.03,
    },
    Figure {
        name: "torn, target",
        help: "Share of the light that has not found its neighbours of the later key half way: that picture still is scraps. Up to 0.06 is not seen. What helps: a larger gamma, a target nearer by or of a similar shape, or a key between the two",
        decimals: 3,
        read: |of| Some(of.torn_target),
        limit: |_| 0.06,
    },
    Figure {
        name: "torn, late",
        help: "As torn, target, but after three quarters of the way, where the later picture should be whole: what is torn here slides into place in the last frames. Up to 0.005 is not seen. What helps: as before",
        decimals: 3,
        read: |of| Some(of.torn_target_late),
        limit: |_| 0.005,
    },
    Figure {
        name: "bunch",
        help: "Light in the fullest spot on the way, over the fullest spot of both keys: 1 where it never piles up; above 2, beads and bright hems are seen, mostly at the ends of walls. What helps: shorter walls, wider gaps between them, or walls farther from the straight way",
        decimals: 2,
        read: |of| Some(of.bunch),
        limit: |_| 2.0,
    },
    Figure {
        name: "fastest",
        help: "Speed of the fastest photon over the mean. Above 1.5 times that of straight lines, single specks dash through the picture. What helps: less turbulence, shorter walls, more frames between the keys",
        decimals: 2,
        read: |of| Some(of.fastest),
        limit: |of| 1.5 * of.fastest_straight,
    },
    Figure {
        name: "fastest, 99.9 %",
        help: "The speed that 99.9 % of the light stays below, over the mean, at the fastest moment. Above 1.3 times that of straight lines, light whips round or catches up late. What helps: a larger gamma, a larger alpha, less turbulence",
        decimals: 2,
        read: |of| Some(of.fastest_999),
        limit: |of| 1.3 * of.fastest_straight,
    },
    Figure {
        name: "straight lines",
        help: "Longest straight way over the mean straight way: the speed of the fastest photon if all went straight. No motion that arrives in time can be slower",
        decimals: 2,
        read: |of| Some(of.fastest_straight),
        limit: |_| f64::INFINITY,
    },
    Figure {
        name: "gap",
        help: "Distance by which the light of both keys misses where it meets half way, root mean square, in plane units: what is made up on the rest of the way. Up to 0.01 is not seen. What helps: a larger gamma, fewer walls in the way",
        decimals: 4,
        read: |of| of.gap,
        limit: |_| 0.01,
    },
];
