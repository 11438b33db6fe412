//! Light that goes around walls until both keys meet: no photon through a wall, whatever its light does.

use glam::Vec2;
use lightloom_core::constraint::{ActiveWall, Wall, Window};
use lightloom_core::flow::FlowSettings;

use crate::crossing::crosses;
use crate::meeting_film::{Film, disc, film, settings};

fn wall(points: &[[f32; 2]]) -> ActiveWall {
    standing(points, Window::ALWAYS)
}

fn standing(points: &[[f32; 2]], window: Window) -> ActiveWall {
    Wall { thickness: 0.02, ..Wall::new(points.to_vec()) }.active(window).unwrap()
}

/// A wall that stands between two times.
fn between(from: f64, to: f64) -> Window {
    Window { rise: [from; 2], fall: [to; 2] }
}

/// The most photons in a cell of 1/64, over that of the fuller key.
fn fullest(film: &Film) -> f64 {
    film.continuity().bunch
}

/// Photons that cross one of the walls in a move for which `stands` holds.
fn crossers(film: &Film, walls: &[ActiveWall], stands: impl Fn(f64) -> bool) -> usize {
    let segments: Vec<[Vec2; 2]> =
        walls.iter().flat_map(|wall| wall.points.windows(2)).map(|w| [w[0], w[1]]).collect();
    let moves = film.frames.len() - 1;
    let crosses_any = |a: Vec2, b: Vec2| segments.iter().any(|&[p, q]| crosses(a, b, p, q));
    let stands = |n: &usize| stands((*n as f64 + 0.5) / moves as f64);
    let crosses_once =
        |i: usize| (0..moves).filter(stands).any(|n| crosses_any(film.frames[n][i], film.frames[n + 1][i]));
    (0..film.target.len()).filter(|&i| crosses_once(i)).count()
}

#[test]
fn no_light_goes_through_a_wall() {
    let (a, b) = (disc([0.25, 0.5], 0.15, 5000), disc([0.75, 0.5], 0.15, 5000));
    let all = [
        ("across", vec![wall(&[[0.5, 0.2], [0.5, 0.8]])]),
        ("two behind each other", vec![wall(&[[0.45, 0.1], [0.45, 0.6]]), wall(&[[0.55, 0.4], [0.55, 0.9]])]),
        ("through the light", vec![wall(&[[0.25, 0.2], [0.25, 0.8]]), wall(&[[0.6, 0.5], [0.8, 0.5]])]),
        ("bent", vec![wall(&[[0.4, 0.3], [0.6, 0.3], [0.6, 0.7], [0.4, 0.7]])]),
    ];
    for (name, walls) in all {
        for gamma in [0.0, 0.5, 1.0] {
            let film = film(&a, &b, &FlowSettings { gamma, ..settings() }, &walls);
            film.arrives(&a);
            let found = crossers(&film, &walls, |_| true);
            println!(
                "{name} {gamma}: {found} {} {} plan {:?} bunch {} gap {}",
                film.report.wall_crossings,
                film.report.unreachable,
                film.plan,
                fullest(&film),
                film.report.gap
            );
        }
    }
}

#[test]
fn light_spreads_into_a_lane_through_a_slit() {
    let (a, b) = (disc([0.25, 0.5], 0.15, 20_000), disc([0.75, 0.5], 0.15, 20_000));
    for width in [1.0f32, 2.0, 4.0, 8.0] {
        let half = 0.5 * width / 64.0 + 0.01;
        let walls = [wall(&[[0.5, 0.0], [0.5, 0.5 - half]]), wall(&[[0.5, 0.5 + half], [0.5, 1.0]])];
        let film = film(&a, &b, &settings(), &walls);
        film.arrives(&a);
        let found = crossers(&film, &walls, |_| true);
        println!(
            "slit {width}: {found} {} {} plan {:?} bunch {} gap {}",
            film.report.wall_crossings,
            film.report.unreachable,
            film.plan,
            fullest(&film),
            film.report.gap
        );
    }
}

#[test]
fn light_that_a_closed_wall_shuts_off_is_counted_and_arrives_all_the_same() {
    let (a, b) = (disc([0.3, 0.3], 0.1, 2000), disc([0.7, 0.7], 0.1, 2000));
    let square = [[0.55, 0.55], [0.85, 0.55], [0.85, 0.85], [0.55, 0.85], [0.55, 0.55]];
    let film = film(&a, &b, &settings(), &[wall(&square)]);
    film.arrives(&a);
    println!("closed {} {} plan {:?}", film.report.wall_crossings, film.report.unreachable, film.plan);
}

#[test]
fn light_waits_for_a_wall_to_go() {
    let (a, b) = (disc([0.25, 0.5], 0.1, 5000), disc([0.75, 0.5], 0.1, 5000));
    for (from, to) in [
        (0.0, 0.6),
        (0.0, 0.4),
        (0.0, 0.5),
        (0.5, 1.0),
        (0.6, 1.0),
        (0.4, 1.0),
        (0.3, 0.7),
        (0.1, 0.3),
        (0.7, 0.9),
    ] {
        let walls = [standing(&[[0.5, 0.0], [0.5, 1.0]], between(from, to))];
        let film = film(&a, &b, &settings(), &walls);
        film.arrives(&a);
        let found = crossers(&film, &walls, |t| t > from && t < to);
        println!(
            "window {from} {to}: {found} {} {} plan {:?} bunch {} gap {}",
            film.report.wall_crossings,
            film.report.unreachable,
            film.plan,
            fullest(&film),
            film.report.gap
        );
    }
}
