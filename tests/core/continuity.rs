//! Figures of how well a body of light holds together: cases whose answer is known, and an independent implementation.

use std::f64::consts::PI;

use lightloom_core::Progress;
use lightloom_core::continuity::{Continuity, Neighbourhoods, Seams, measure};
use lightloom_core::glam::{DVec2, Mat2, Vec2, dvec2, vec2};

/// Side of the cells in which seams are looked for.
const CELL: f32 = 1.0 / 256.0;

fn figures(frames: &[Vec<Vec2>]) -> Continuity {
    measure(frames, Vec2::ONE, &Progress::new()).unwrap()
}

/// Four photons in each of 100 x 50 cells, in even rows and columns.
fn slab() -> Vec<Vec2> {
    let corner = vec2(70.0, 100.0);
    (0..20_000)
        .map(|i| CELL * (corner + 0.5 * vec2((i % 200) as f32 + 0.5, (i / 200) as f32 + 0.5)))
        .collect()
}

/// The photons at 41 evenly spaced times.
fn film(photon: impl Fn(f32, Vec2) -> Vec2) -> Vec<Vec<Vec2>> {
    let frame = |i: u8| slab().into_iter().map(|p| photon(f32::from(i) / 40.0, p)).collect();
    (0..=40).map(frame).collect()
}

/// Straight lines at constant speed.
fn straight(source: &[Vec2], target: &[Vec2]) -> Vec<Vec<Vec2>> {
    let frame = |i: u8| source.iter().zip(target).map(|(a, b)| a.lerp(*b, f32::from(i) / 40.0)).collect();
    (0..=40).map(frame).collect()
}

/// The slab cut along its length, its halves so many cells apart at half time.
fn cut(apart: f32) -> Vec<Vec<Vec2>> {
    let middle = CELL * 125.0;
    film(|t, p| {
        let side = if p.y < middle { -0.5 } else { 0.5 };
        p + CELL * vec2(20.0 * t, side * apart * (t * PI as f32).sin())
    })
}

#[test]
fn two_halves_that_drift_apart_lack_the_light_of_the_gap_between_them() {
    // A gap of 3 cells, where the body is 50 wide.
    let gaping = figures(&cut(3.0));
    // The gap is 100 cells long; at either end the disc reaches some two cells into it.
    assert!((gaping.cracks / 0.06 - 0.96).abs() < 0.02, "{gaping:?}");
    // Two rows of 100 on either side of the cut have neighbours beyond it.
    let torn = figures(&cut(60.0));
    assert_eq!([torn.torn_source, torn.torn_target], [4.0 / 100.0; 2], "{torn:?}");
    // Wider than the disc, it is no seam any more, but two bodies.
    assert!(torn.cracks < gaping.cracks, "{torn:?}");
    let whole = figures(&cut(0.0));
    // Single precision shifts photons over the borders of cells.
    assert!(whole.cracks < 1e-3 && whole.torn_source == 0.0, "{whole:?}");
}

#[test]
fn seams_that_were_there_before_have_not_opened() {
    let opened = |key: &[Vec2], now: &[Vec2]| {
        let [before, after] = [key, now].map(|positions| Seams::new(positions, Vec2::ONE));
        let missing: f32 = after.opened(now, &before, key).iter().sum();
        assert_eq!(after.cells(), [256, 256]);
        missing
    };
    let (whole, gaping) = (slab(), cut(5.0).swap_remove(20));
    let elsewhere: Vec<Vec2> = gaping.iter().map(|p| *p + CELL * vec2(31.0, -17.0)).collect();
    // Five cells of darkness along 100 cells, less what their blurred flanks hold.
    assert!((250.0..500.0).contains(&opened(&whole, &gaping)), "{}", opened(&whole, &gaping));
    assert!(opened(&gaping, &elsewhere) < 5.0, "{}", opened(&gaping, &elsewhere));
    assert!(opened(&whole, &whole) == 0.0);
}

#[test]
fn an_affine_map_tears_nothing_and_a_random_pairing_everything() {
    let source = slab();
    let map = Mat2::from_cols(vec2(0.4, 0.9), vec2(-1.1, 0.3));
    let affine: Vec<Vec2> = source.iter().map(|p| vec2(0.6, 0.3) + map * (*p - source[0])).collect();
    let whole = figures(&straight(&source, &affine));
    assert_eq!([whole.torn_source, whole.torn_target, whole.torn_target_late], [0.0; 3], "{whole:?}");
    // A step of 7919, a prime, visits every row once, and takes neighbours far apart.
    let shuffled: Vec<Vec2> = (0..source.len()).map(|i| affine[i * 7919 % source.len()]).collect();
    let torn = figures(&straight(&source, &shuffled));
    let [least, most] = [torn.torn_source, torn.torn_target_late].map(|torn| torn.clamp(0.0, 1.0));
    assert!(least > 0.99 && most > 0.99, "{torn:?}");
}

#[test]
fn light_that_meets_in_one_place_bunches_by_all_over_the_fullest_cell() {
    let place = vec2(0.5, 0.5);
    let meeting = |t: f32, p: Vec2| if t == 0.5 { place } else { p + CELL * vec2(40.0 * t, 0.0) };
    // A cell of 1/64 holds 16 of those with four photons.
    assert_eq!(figures(&film(meeting)).bunch, 20_000.0 / 64.0);
    assert_eq!(figures(&film(|_, p| p)).bunch, 1.0);
}

#[test]
fn the_fastest_photon_is_told_from_the_fastest_way() {
    let first = slab()[0];
    let way = |p: Vec2| if p == first { 0.3 } else { 0.1 };
    // One photon has three times the way, and half the time for it.
    let late = |t: f32, p: Vec2| {
        let gone = if p == first { (2.0 * t - 1.0).max(0.0) } else { t };
        p + vec2(gone * way(p), 0.0)
    };
    let figures = figures(&film(late));
    for (found, expected) in
        [(figures.fastest_straight, 3.0), (figures.fastest, 6.0), (figures.fastest_999, 1.0)]
    {
        // The mean way is 0.01 % longer by that photon; positions are single precision, steps 0.0025.
        assert!((found / expected - 1.0).abs() < 5e-4, "{found} is not {expected}");
    }
}

#[test]
fn nothing_that_moves_and_nothing_at_all_have_figures() {
    let still = figures(&film(|_, p| p));
    assert_eq!((still.cracks, still.torn_source, still.fastest), (0.0, 0.0, 0.0));
    assert_eq!(figures(&[Vec::new(), Vec::new()]).bunch, 1.0);
    let one = vec![vec2(0.5, 0.5)];
    assert_eq!(figures(&[one.clone(), one]).torn_target, 0.0);
    // All in one place, then apart: no neighbour stays.
    let together = vec![vec2(0.5, 0.5); 100];
    let neighbourhoods = Neighbourhoods::new(&together, &[0, 1]);
    assert_eq!(neighbourhoods.torn(&together), 0.0);
    assert_eq!(neighbourhoods.torn(&slab()[..100]), 1.0);
}

/// A disc that is torn into two arcs; the same is easily made elsewhere.
fn torn_disc() -> Vec<Vec<Vec2>> {
    let count = 6000;
    let photon = |i: i32, t: f64| {
        let k = f64::from(i) + 0.5;
        let (angle, q) = (k * PI * (3.0 - 5f64.sqrt()), (k / f64::from(count)).sqrt());
        let source = dvec2(0.3, 0.35) + 0.15 * q * DVec2::from_angle(angle);
        let upper = source.y > 0.35;
        let turned = DVec2::from_angle(angle + 1.2 * q);
        let target = dvec2(0.68, if upper { 0.45 } else { 0.4 }) + (0.09 + 0.06 * q) * turned;
        let (side, gone) = if upper { (1.0, t.powf(1.5)) } else { (-1.0, t) };
        (source + (target - source) * gone + dvec2(0.0, side * 0.04 * (PI * t).sin())).as_vec2()
    };
    (0..=20).map(|frame| (0..count).map(|i| photon(i, f64::from(frame) / 20.0)).collect()).collect()
}

#[test]
fn an_independent_implementation_agrees() {
    let found = figures(&torn_disc());
    // By scipy 1.17: gaussian_filter, grey_closing with the disc as its footprint, cKDTree.
    let expected = [
        ("cracks", found.cracks, 0.065062),
        ("cracks_mean", found.cracks_mean, 0.002306),
        ("torn_source", found.torn_source, 0.051833),
        ("torn_target", found.torn_target, 0.097333),
        ("torn_target_late", found.torn_target_late, 0.097333),
        ("bunch", found.bunch, 1.090909),
        ("fastest", found.fastest, 1.823413),
        ("fastest_999", found.fastest_999, 1.778343),
        ("fastest_straight", found.fastest_straight, 1.393092),
    ];
    for (name, found, expected) in expected {
        // Single precision may put one photon of 6000 into the next cell, and round speeds in the fifth digit.
        assert!(
            (found - expected).abs() < 2e-4_f64.max(2e-5 * expected),
            "{name}: {found} is not {expected}"
        );
    }
}

#[test]
fn empty_plane_around_the_light_changes_nothing() {
    let frames = torn_disc();
    let cut = measure(&frames, vec2(1.0, 0.75), &Progress::new()).unwrap();
    let whole = figures(&frames);
    assert!((cut.cracks - whole.cracks).abs() < 1e-6 && cut.bunch == whole.bunch, "{cut:?} {whole:?}");
}
