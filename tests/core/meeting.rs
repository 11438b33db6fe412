//! Light that moves freely until both keys meet: what must hold whatever they are.

use glam::{Vec2, vec2};
use lightloom_core::Progress;
use lightloom_core::flow::FlowSettings;
use lightloom_core::flow::meeting::HalfTracks;

use crate::meeting_film::{CELL, disc, film, fit, settings, strokes};

/// The letter L.
fn ell(count: usize) -> Vec<Vec2> {
    strokes(&[[[0.2, 0.2], [0.35, 0.8]], [[0.35, 0.2], [0.6, 0.35]]], count)
}

/// The letter T.
fn tee(count: usize) -> Vec<Vec2> {
    strokes(&[[[0.4, 0.65], [0.85, 0.8]], [[0.55, 0.25], [0.7, 0.65]]], count)
}

/// The largest distance of two columns of points.
fn farthest(a: &[Vec2], b: &[Vec2]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
}

#[test]
fn two_keys_that_are_the_same_rest() {
    let body = ell(20_000);
    let film = film(&body, &body, &settings(), &[]);
    let moved = film.frames.iter().map(|frame| farthest(frame, &body)).fold(0.0, f32::max);
    // A plan knows no place to less than half a cell; the transport onto itself that is taken away leaves a third of one at the
    // corners of the letter.
    assert!(moved < 0.5 * CELL, "{} cells", moved / CELL);
}

#[test]
fn a_body_that_is_only_shifted_moves_as_one() {
    let (body, shift) = (disc([0.3, 0.4], 0.15, 20_000), vec2(0.35, 0.2));
    let shifted: Vec<Vec2> = body.iter().map(|p| *p + shift).collect();
    let film = film(&body, &shifted, &settings(), &[]);
    film.arrives(&body);
    let half: Vec<Vec2> = body.iter().map(|p| *p + 0.5 * shift).collect();
    let squares = film.middle().iter().zip(&half).map(|(a, b)| a.distance_squared(*b)).sum::<f32>();
    let off = [(squares / half.len() as f32).sqrt(), farthest(film.middle(), &half)].map(|off| off / CELL);
    // Bilinear velocities round the border of the body off by about a cell (.3 in the mean, .8 at most).
    assert!(off[0] < 0.5 && off[1] < 1.5, "{off:?} cells from half way");
    let figures = film.continuity();
    // The photons of a spiral lie evenly: there is not a seam that chance would make.
    assert!(figures.cracks < 1e-3, "{figures:?}");
    assert_eq!([figures.torn_source, figures.torn_target, figures.torn_target_late], [0.0; 3]);
    assert!(film.report.gap < f64::from(0.5 * CELL), "the gap is {}", film.report.gap);
    // Off by a cell twice within a way of 29 cells.
    assert!(figures.fastest < 1.25, "all move alike: {figures:?}");
}

#[test]
fn the_film_backwards_is_the_film_of_the_exchanged_keys() {
    let (a, b) = (ell(10_000), tee(9000));
    for gamma in [0.2, 0.5, 0.8] {
        let settings = FlowSettings { gamma, ..settings() };
        let tracks = |source: &[Vec2], target: &[Vec2]| {
            let fields = fit(source, target, &settings, &[]).unwrap().fields;
            [(0, source), (1, target)]
                .map(|(half, at)| HalfTracks::new(&fields, half, at, &Progress::new()).unwrap())
        };
        let ([forward, backward], [other_forward, other_backward]) = (tracks(&a, &b), tracks(&b, &a));
        for (one, other) in [(forward, other_backward), (backward, other_forward)] {
            for n in 0..=one.count() {
                assert!(one.after(n) == other.after(n), "gamma {gamma}, step {n} of {}", one.count());
            }
        }
    }
}

#[test]
fn letters_hold_together_at_every_gamma() {
    let (a, b) = (ell(20_000), tee(20_000));
    for gamma in [0.0, 0.25, 0.5, 1.0] {
        let film = film(&a, &b, &FlowSettings { gamma, ..settings() }, &[]);
        film.arrives(&a);
        let figures = film.continuity();
        // Found are .015 to .011, and .0074 to .0068; straight lines have cracks of .1 and more.
        assert!(figures.cracks <= 0.02, "gamma {gamma}: {figures:?}");
        assert!(film.report.gap <= 0.01, "gamma {gamma}: the gap is {}", film.report.gap);
        assert!(film.plan.error < 1e-3, "gamma {gamma}: {:?}", film.plan);
    }
}

#[test]
fn any_number_of_threads_makes_the_same_film() {
    let (a, b) = (ell(5000), tee(5000));
    let [one, two] = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| film(&a, &b, &FlowSettings { steps: 10, ..settings() }, &[]))
    });
    assert!(one.frames == two.frames);
}

#[test]
fn odd_keys_come_through() {
    let corner = |at: [f32; 2], count| disc(at, 0.01, count);
    let cell = |count| disc([0.3, 0.3], 2e-4, count);
    let border = |x: f32| vec![vec2(x, 0.0), vec2(x, 1.0), vec2(x, 0.5)];
    let keys = [
        ("far corners", corner([0.02, 0.02], 2000), corner([0.98, 0.98], 2000)),
        ("all in one cell, then a body", cell(2000), tee(2000)),
        ("a body, then all in one cell", tee(2000), cell(2000)),
        ("all in one place", vec![vec2(0.2, 0.7); 500], vec![vec2(0.8, 0.1); 500]),
        ("three photons", corner([0.2, 0.2], 3), tee(3)),
        ("one photon", vec![vec2(0.1, 0.2)], vec![vec2(0.9, 0.7)]),
        ("at the border", border(0.0), border(1.0)),
    ];
    for (name, a, b) in &keys {
        println!("{name}");
        film(a, b, &FlowSettings { steps: 8, ..settings() }, &[]).arrives(a);
    }
}

#[test]
fn odd_settings_come_through() {
    let (a, b) = (ell(2000), tee(2000));
    let plain = || FlowSettings { steps: 8, ..settings() };
    let odd = [
        FlowSettings { alpha: 1e6, ..plain() },
        FlowSettings { alpha: 1e-12, ..plain() },
        FlowSettings { hold: 0.04, ..plain() },
        FlowSettings { hold: 0.2, ..plain() },
        FlowSettings { steps: 1, ..plain() },
        FlowSettings { steps: 2, ..plain() },
        FlowSettings { steps: 3, ..plain() },
    ];
    for settings in odd {
        println!("alpha {}, hold {}, {} steps", settings.alpha, settings.hold, settings.steps);
        film(&a, &b, &settings, &[]).arrives(&a);
    }
}
