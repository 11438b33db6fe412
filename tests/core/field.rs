//! The field: splines, derivatives, and what lies beyond the border.

use glam::{Mat2, Vec2};
use lightloom_core::flow::field::{Field, Grid};
use lightloom_core::math::rng::{Purpose, Stream};

fn grid() -> Grid {
    Grid { cells: [20, 13], extent: Vec2::new(1.0, 0.7) }
}

fn random_field(psi: f32, phi: f32) -> Field {
    let mut random = Stream::new(3, Purpose::Trace, 0, 0);
    let [nx, ny] = grid().nodes();
    let mut column = |size: f32| (0..nx * ny).map(|_| size * (random.f32() - 0.5)).collect::<Vec<_>>();
    let (psi, phi) = (column(psi), column(phi));
    Field::from_potentials(grid(), &psi, &phi)
}

fn points() -> impl Iterator<Item = Vec2> {
    (0..300).map(|i| {
        let mut random = Stream::new(4, Purpose::Trace, 0, i);
        Vec2::new(random.f32(), random.f32()) * grid().extent
    })
}

/// du/dx and du/dy by central differences in double precision, kept within the cell rows.
fn differences(field: &Field, p: Vec2) -> [[f64; 2]; 2] {
    let h = 1e-6;
    let p = p.clamp(Vec2::splat(1e-4), grid().extent - 1e-4);
    let (x, y) = (f64::from(p.x), f64::from(p.y));
    let slope = |a: [f64; 2], b: [f64; 2]| {
        let (a, b) = (field.velocity_f64(a), field.velocity_f64(b));
        [(b[0] - a[0]) / (2.0 * h), (b[1] - a[1]) / (2.0 * h)]
    };
    [slope([x - h, y], [x + h, y]), slope([x, y - h], [x, y + h])]
}

#[test]
fn a_field_of_psi_alone_has_no_divergence_and_of_phi_alone_no_curl() {
    let (flow, slope) = (random_field(1.0, 0.0), random_field(0.0, 1.0));
    // Second derivatives are near 1/h^2 = 400; differences of step 1e-6 in f64 leave 1e-7 of that.
    let (mut curls, mut divergences) = (0.0, 0.0);
    for p in points() {
        let [along, across] = differences(&flow, p);
        assert!((along[0] + across[1]).abs() < 1e-4, "divergence at {p}");
        curls += (along[1] - across[0]).abs() / 300.0;
        let [along, across] = differences(&slope, p);
        assert!((along[1] - across[0]).abs() < 1e-4, "curl at {p}");
        divergences += (along[0] + across[1]).abs() / 300.0;
        let (flow, slope) = (flow.gradient(p), slope.gradient(p));
        assert_eq!(flow.x_axis.x + flow.y_axis.y, 0.0);
        assert_eq!(slope.x_axis.y - slope.y_axis.x, 0.0);
    }
    // The other of the two is there, and large.
    assert!(curls > 50.0 && divergences > 50.0, "{curls} {divergences}");
}

#[test]
fn the_gradient_is_that_of_the_velocity() {
    let field = random_field(1.0, 1.0);
    for p in points() {
        let p = p.clamp(Vec2::splat(1e-4), grid().extent - 1e-4);
        let [along, across] = differences(&field, p).map(|d| Vec2::new(d[0] as f32, d[1] as f32));
        let gradient = field.gradient(p);
        // Third derivatives, near 1/h^3 = 8000, times the f32 rounding of p (6e-8 of 1).
        assert!((gradient - Mat2::from_cols(along, across)).abs_diff_eq(Mat2::ZERO, 2e-3), "{p}");
    }
}

#[test]
fn single_and_double_precision_agree() {
    let field = random_field(1.0, 1.0);
    for p in points() {
        let exact = field.velocity_f64([f64::from(p.x), f64::from(p.y)]);
        // Velocities near 20, rounding 6e-8 in coefficients, weights and place.
        assert!(field.velocity(p).distance(Vec2::new(exact[0] as f32, exact[1] as f32)) < 1e-4);
    }
}

#[test]
fn a_field_of_linear_potentials_is_constant() {
    let [nx, ny] = grid().nodes();
    let [hx, hy] = grid().cell_size();
    let linear = |slope: [f64; 2]| -> Vec<f32> {
        (0..nx * ny)
            .map(|i| (slope[0] * hx * (i % nx) as f64 + slope[1] * hy * (i / nx) as f64) as f32)
            .collect()
    };
    let field = Field::from_potentials(grid(), &linear([2.0, 3.0]), &linear([5.0, 7.0]));
    for p in points() {
        assert!(field.velocity(p).distance(Vec2::new(-3.0 + 5.0, 2.0 + 7.0)) < 1e-4);
    }
}

#[test]
fn beyond_the_border_the_border_velocity_goes_on() {
    let field = random_field(1.0, 1.0);
    let end = grid().extent;
    for i in 0..50 {
        let y = end.y * i as f32 / 50.0;
        let edge = field.velocity(Vec2::new(end.x, y));
        assert_eq!(field.velocity(Vec2::new(3.0, y)), edge);
        // Second derivatives near 1/h^2 = 400 over 1e-5.
        assert!(field.velocity(Vec2::new(end.x - 1e-5, y)).distance(edge) < 1e-2);
        assert_eq!(field.gradient(Vec2::new(3.0, y)).x_axis, Vec2::ZERO);
    }
    assert_eq!(field.velocity(Vec2::splat(-1e30)), field.velocity(Vec2::ZERO));
    assert_eq!(field.velocity(Vec2::splat(f32::INFINITY)), field.velocity(end));
}

#[test]
fn a_blend_is_the_weighted_sum_of_velocities() {
    let (a, b) = (random_field(1.0, 0.5), random_field(0.3, 1.0));
    let mut out = Field::zero(grid());
    Field::blend(&a, 1.5, &b, -0.5, &mut out);
    for p in points() {
        assert!(out.velocity(p).distance(1.5 * a.velocity(p) - 0.5 * b.velocity(p)) < 1e-4);
    }
}

#[test]
fn potentials_go_out_as_they_came_in() {
    let field = random_field(1.0, 1.0);
    let (psi, phi) = field.potentials();
    assert_eq!(Field::from_potentials(field.grid(), &psi, &phi), field);
}
