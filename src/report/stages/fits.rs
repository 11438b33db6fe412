//! Stages of the fit: one step, the solver alone, and whole segments over walls and threads.

use glam::Vec2;

use crate::clock::fastest;
use crate::context::{Context, Limit, Sample};
use lightloom_core::constraint::{ActiveWall, Wall, Window};
use lightloom_core::engine::MovingSegment;
use lightloom_core::flow::field::Grid;
use lightloom_core::flow::fit::{Blend, FitSettings, Fitter};
use lightloom_core::flow::{FlowSettings, Segment, fit_segment};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::{Error, Progress, Result};

/// Seconds after which no further run begins.
const ENOUGH: f64 = 1.0;
/// A solve that needs this many iterations has failed.
const MOST_ITERATIONS: usize = 500;

/// Seconds of the fit of a segment, the fastest of some runs.
///
/// # Errors
/// A fit that fails; cancelled.
pub(crate) fn flow_seconds(runs: usize, segment: &Segment, progress: &Progress) -> Result<f64> {
    fastest(runs, ENOUGH, || fit_segment(segment, &progress.inner())).map(|(_, seconds)| seconds)
}

/// A fit of both potentials on as many cells along both sides.
fn joint(cells: usize, photons: &MovingSegment, alpha: f32, tolerance: f64) -> FitSettings {
    FitSettings {
        grid: Grid { cells: [cells; 2], extent: photons.extent },
        gamma: 0.5,
        alpha: alpha.into(),
        blend: Blend::Joint,
        tolerance,
        max_iterations: MOST_ITERATIONS,
    }
}

/// The first photons, at most `most`, and their straight velocities.
fn straight(photons: &MovingSegment, most: usize) -> (&[Vec2], Vec<Vec2>) {
    let source = &photons.source[..most.min(photons.source.len())];
    (source, source.iter().zip(&photons.target).map(|(from, to)| *to - *from).collect())
}

/// As many guide photons as the project has, moved by a hundredth of their path from one fit to the next.
pub(super) fn warm_step(context: &mut Context, cells: usize, progress: &Progress) -> Result<Option<Sample>> {
    let photons = context.moving_segment(progress)?;
    let settings = &context.project.flow;
    let (source, velocities) = straight(&photons, settings.guides as usize);
    let moved: Vec<Vec2> = source.iter().zip(&velocities).map(|(from, v)| *from + 0.01 * *v).collect();
    let mut fitter = Fitter::new(joint(cells, &photons, settings.alpha, settings.tolerance.into()))?;
    let (_, report) = fitter.fit(source, &velocities, progress)?;
    let mut at_start = false;
    let (_, seconds) = fastest(6, ENOUGH, || {
        at_start = !at_start;
        fitter.fit(if at_start { &moved } else { source }, &velocities, progress)
    })?;
    Ok(Some(Sample::new(report.unknowns, seconds)))
}

/// A cold solve with few photons. The least work are the products with the matrix: of each iteration one in double
/// precision, and in single precision two smoothings of three products each (the first of a smoothing from zero is free)
/// and two more, on grids that add up to 4/3.
pub(super) fn solver(context: &mut Context, cells: usize, progress: &Progress) -> Result<Option<Sample>> {
    const SINGLE_PRODUCTS: f64 = 6.0 * 4.0 / 3.0;
    // Half of the 49 neighbours of a cubic spline for each of psi, phi and their coupling.
    const ENTRIES: f64 = 3.0 * 25.0;
    let photons = context.moving_segment(progress)?;
    let settings = joint(cells, &photons, context.project.flow.alpha, 1e-8);
    let (source, velocities) = straight(&photons, 2000);
    let mut fitter = Fitter::new(settings)?;
    let (report, seconds) = fastest(3, ENOUGH, || {
        fitter.reset();
        Ok(fitter.fit(source, &velocities, progress)?.1)
    })?;
    let nodes = settings.grid.nodes().iter().product::<usize>() as f64;
    let bytes = nodes * ENTRIES * (8.0 + 4.0 * SINGLE_PRODUCTS);
    let operations = 2.0 * nodes * ENTRIES * 2.0 * (1.0 + SINGLE_PRODUCTS);
    let (least, by) = context.machine().seconds(bytes, operations);
    let items = report.iterations as f64;
    let limit = Limit { items, seconds: items * least, by };
    let sample = Sample { limit: Some(limit), ..Sample::new(report.unknowns, seconds) };
    Ok((report.iterations > 0).then_some(sample))
}

/// Walls of ten points each, at random over the plane, a tenth of it long.
pub(super) fn with_walls(context: &mut Context, count: usize, progress: &Progress) -> Result<Option<Sample>> {
    let photons = context.moving_segment(progress)?;
    let guides = context.effort.pick(5_000, 50_000);
    let settings = FlowSettings { steps: 20, guides, ..context.project.flow.clone() };
    let walls: Vec<ActiveWall> = (0..count as u64).filter_map(|i| random_wall(i, photons.extent)).collect();
    let segment = Segment { walls: &walls, ..photons.segment(&settings) };
    Ok(Some(Sample::new(count, flow_seconds(1, &segment, progress)?)))
}

fn random_wall(number: u64, extent: Vec2) -> Option<ActiveWall> {
    let mut random = Stream::new(1, Purpose::Target, 0, number);
    let middle = Vec2::new(random.f32(), random.f32()) * extent;
    let along = 0.05 * Vec2::from_angle(std::f32::consts::TAU * random.f32());
    let place = |i: i32| {
        let share = i as f32 / 4.5 - 1.0;
        middle + share * along + 0.02 * share * share * along.perp()
    };
    Wall { thickness: 0.01, ..Wall::new((0..10).map(|i| place(i).to_array()).collect()) }
        .active(Window::ALWAYS)
}

/// In a pool of so many threads, without walls: they are measured by themselves.
pub(super) fn on_threads(context: &mut Context, count: usize, progress: &Progress) -> Result<Option<Sample>> {
    let photons = context.moving_segment(progress)?;
    let settings = FlowSettings { steps: 10, ..context.project.flow.clone() };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
    let pool = pool.map_err(|error| Error::Numeric { stage: "report", what: error.to_string() })?;
    let segment = Segment { walls: &[], ..photons.segment(&settings) };
    Ok(Some(Sample::new(count, pool.install(|| flow_seconds(2, &segment, progress))?)))
}
