//! Directed lines: the field follows them the more, the larger beta, and light away from them hardly notices.

use glam::Vec2;
use lightloom_core::Progress;
use lightloom_core::constraint::{ActiveLine, DirectedLine, Window};
use lightloom_core::flow::field::Field;
use lightloom_core::flow::{FitKind, FlowSettings, GridSize, Segment, fit_segment};

/// Photons all over the plane.
fn everywhere(side: usize) -> Vec<Vec2> {
    let place = |i: usize| (i as f32 + 0.5) / side as f32;
    (0..side * side).map(|i| Vec2::new(place(i % side), place(i / side))).collect()
}

fn settings(gamma: f32, beta: f32) -> FlowSettings {
    FlowSettings { gamma, beta, grid: GridSize::Longer(64), steps: 2, ..FlowSettings::default() }
}

/// The first field of photons that all go to the right by 0.2.
fn field(lines: &[ActiveLine], settings: &FlowSettings) -> Field {
    let source = everywhere(150);
    let target: Vec<Vec2> = source.iter().map(|p| *p + Vec2::new(0.2, 0.0)).collect();
    let course = Segment { lines, ..Segment::new(&source, &target, Vec2::ONE, settings) };
    let (fields, report) = fit_segment(&course, &Progress::new()).unwrap();
    assert_eq!(report.endpoint_error, 0.0);
    fields.nodes()[0].clone()
}

fn upwards(width: f32) -> ActiveLine {
    let line = DirectedLine { width, ..DirectedLine::new(vec![[0.5, 0.35], [0.5, 0.65]]) };
    line.active(Window::ALWAYS, Vec2::ONE).unwrap()
}

/// Mean angle between the field and the line along it, in degrees.
fn mean_angle(field: &Field) -> f32 {
    let places = (0..=30).map(|i| Vec2::new(0.5, 0.35 + 0.01 * i as f32));
    places.map(|p| field.velocity(p).angle_to(Vec2::Y).abs().to_degrees()).sum::<f32>() / 31.0
}

#[test]
fn the_field_follows_a_line_ever_closer_as_beta_grows() {
    for (gamma, fit) in
        [(0.0, FitKind::Joint), (0.5, FitKind::Joint), (1.0, FitKind::Joint), (0.5, FitKind::Separate)]
    {
        let angles = [0.0, 0.01, 0.1, 1.0, 10.0, 100.0].map(|beta| {
            let settings = FlowSettings { fit, ..settings(gamma, beta) };
            mean_angle(&field(&[upwards(0.05)], &settings))
        });
        assert!((angles[0] - 90.0).abs() < 0.1, "without beta the field knows no line: {angles:?}");
        // The solver stops at a relative residual of 1e-4, worth far less than a tenth of a degree.
        assert!(angles.windows(2).all(|pair| pair[1] < pair[0] + 0.1), "gamma {gamma}: {angles:?}");
        assert!(angles[5] < 5.0, "gamma {gamma} {fit:?}: {angles:?}");
    }
}

#[test]
fn light_four_widths_away_keeps_its_speed() {
    let width = 0.05;
    for gamma in [0.0, 0.5, 1.0] {
        let free = field(&[], &settings(gamma, 100.0));
        for beta in [1.0, 100.0] {
            let steered = field(&[upwards(width)], &settings(gamma, beta));
            let away = everywhere(60).into_iter().filter(|p| {
                let nearest = Vec2::new(0.5, p.y.clamp(0.35, 0.65));
                p.distance(nearest) > 4.0 * width
            });
            let change = away.map(|p| {
                let (u, v) = (steered.velocity(p), free.velocity(p));
                (u.length() - v.length()).abs() / v.length()
            });
            let (mut worst, mut sum, mut count) = (0.0f32, 0.0, 0.0);
            change.for_each(|c| (worst, sum, count) = (worst.max(c), sum + c, count + 1.0));
            println!("gamma {gamma} beta {beta}: worst {worst:.4}, mean {:.4}", sum / count);
            assert!(worst < 0.02, "gamma {gamma} beta {beta}: {worst}");
        }
    }
}

#[test]
fn a_line_turned_around_turns_the_field_around() {
    let there = DirectedLine::new(vec![[0.5, 0.35], [0.5, 0.65]]);
    let back = DirectedLine { points: there.points.iter().rev().copied().collect(), ..there.clone() };
    let [up, down] = [there, back].map(|line| {
        let active = line.active(Window::ALWAYS, Vec2::ONE).unwrap();
        field(&[active], &settings(0.5, 100.0)).velocity(Vec2::splat(0.5))
    });
    assert!(up.y > 0.1 && down.y < -0.1);
}

#[test]
fn opposite_lines_in_one_place_hold_the_field_still_there() {
    let line =
        |points: [[f32; 2]; 2]| DirectedLine::new(points.to_vec()).active(Window::ALWAYS, Vec2::ONE).unwrap();
    let lines = [line([[0.5, 0.35], [0.5, 0.65]]), line([[0.5, 0.65], [0.5, 0.35]])];
    let field = field(&lines, &settings(0.5, 100.0));
    // Least squares take the mean of what both want, zero, where one alone brings 0.2.
    assert!(field.velocity(Vec2::splat(0.5)).length() < 0.02);
}

#[test]
fn speed_and_weight_act_and_a_line_without_weight_is_no_line() {
    let line = |speed, weight| {
        let line = DirectedLine { speed, weight, ..DirectedLine::new(vec![[0.5, 0.35], [0.5, 0.65]]) };
        line.active(Window::ALWAYS, Vec2::ONE)
    };
    assert!(line(1.0, 0.0).is_none());
    let at_line = |line| field(&[line], &settings(0.5, 100.0)).velocity(Vec2::splat(0.5));
    let (once, twice) = (at_line(line(1.0, 1.0).unwrap()), at_line(line(2.0, 1.0).unwrap()));
    assert!((twice.y / once.y - 2.0).abs() < 0.1, "{once} {twice}");
    let weak = field(&[line(1.0, 0.01).unwrap()], &settings(0.5, 1.0));
    let strong = field(&[line(1.0, 1.0).unwrap()], &settings(0.5, 1.0));
    assert!(mean_angle(&strong) < mean_angle(&weak));
}

#[test]
fn a_line_acts_during_its_window_only() {
    let late = ActiveLine { window: Window { rise: [0.4; 2], fall: [0.9; 2] }, ..upwards(0.05) };
    let settings = settings(0.5, 10.0);
    assert_eq!(field(&[late], &settings), field(&[], &settings));
}
