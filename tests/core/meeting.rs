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
    println!("moved {} cells, gap {}", moved / CELL, film.report.gap);
    assert!(moved < 0.5 * CELL, "{} cells", moved / CELL);
}

#[test]
fn a_body_that_is_only_shifted_moves_as_one() {
    let (body, shift) = (disc([0.3, 0.4], 0.15, 20_000), vec2(0.35, 0.2));
    let shifted: Vec<Vec2> = body.iter().map(|p| *p + shift).collect();
    let film = film(&body, &shifted, &settings(), &[]);
    film.arrives(&body);
    let half: Vec<Vec2> = body.iter().map(|p| *p + 0.5 * shift).collect();
    let off = film.middle().iter().zip(&half).map(|(a, b)| a.distance_squared(*b)).sum::<f32>();
    let rms = (off / half.len() as f32).sqrt();
    let figures = film.continuity();
    println!(
        "off {} rms {} cells, {figures:?} gap {}",
        farthest(film.middle(), &half) / CELL,
        rms / CELL,
        film.report.gap
    );
}

#[test]
fn the_film_backwards_is_the_film_of_the_exchanged_keys() {
    let (a, b) = (ell(10_000), tee(10_000));
    for gamma in [0.2, 0.5, 0.8] {
        let settings = FlowSettings { gamma, ..settings() };
        let tracks = |source: &[Vec2], target: &[Vec2]| {
            let fields = fit(source, target, &settings, &[]).unwrap().fields;
            [(0, source), (1, target)]
                .map(|(half, at)| HalfTracks::new(&fields, half, at, &Progress::new()).unwrap())
        };
        let ([forward, backward], [other_forward, other_backward]) = (tracks(&a, &b), tracks(&b, &a));
        for (one, other) in [(forward, other_backward), (backward, other_forward)] {
            let differ =
                (0..=one.count()).map(|n| farthest(one.after(n), other.after(n))).fold(0.0, f32::max);
            println!("gamma {gamma} differ {} cells", differ / CELL);
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
        println!("gamma {gamma} {figures:?} gap {}", film.report.gap);
    }
}

#[test]
fn any_number_of_threads_makes_the_same_film() {
    let (a, b) = (ell(5000), tee(5000));
    let [one, two] = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| film(&a, &b, &FlowSettings { steps: 10, ..settings() }, &[]))
    });
    assert_eq!(one.frames, two.frames);
}

#[test]
fn odd_keys_and_settings_come_through() {
    let corner = |at: [f32; 2], count| disc(at, 0.01, count);
    let cell = 1.0 / 256.0;
    let keys = [
        ("far corners", corner([0.02, 0.02], 2000), corner([0.98, 0.98], 2000)),
        ("all in one cell, then a body", disc([0.3, 0.3], 0.1 * cell, 2000), tee(2000)),
        ("a body, then all in one cell", tee(2000), disc([0.3, 0.3], 0.1 * cell, 2000)),
        ("all in one place", vec![vec2(0.2, 0.7); 500], vec![vec2(0.8, 0.1); 500]),
        ("three photons", corner([0.2, 0.2], 3), tee(3)),
        ("one photon", vec![vec2(0.1, 0.2)], vec![vec2(0.9, 0.7)]),
        (
            "at the border",
            vec![Vec2::ZERO, Vec2::X, vec2(0.0, 0.5)],
            vec![Vec2::ONE, Vec2::Y, vec2(1.0, 0.5)],
        ),
    ];
    let plain = || FlowSettings { steps: 8, ..settings() };
    for (name, a, b) in &keys {
        let film = film(a, b, &plain(), &[]);
        println!("{name}: gap {} plan {:?}", film.report.gap, film.plan);
        film.arrives(a);
    }
    let (a, b) = (ell(2000), tee(2000));
    let odd = [
        FlowSettings { alpha: 1e6, ..plain() },
        FlowSettings { alpha: 1e-12, ..plain() },
        FlowSettings { hold: 0.04, ..plain() },
        FlowSettings { hold: 0.2, ..plain() },
        FlowSettings { steps: 1, ..settings() },
        FlowSettings { steps: 2, ..settings() },
        FlowSettings { steps: 3, ..settings() },
    ];
    for settings in odd {
        let film = film(&a, &b, &settings, &[]);
        println!(
            "alpha {} hold {} steps {}: gap {}",
            settings.alpha, settings.hold, settings.steps, film.report.gap
        );
        film.arrives(&a);
    }
}
