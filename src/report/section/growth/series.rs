//! What is measured at rising size: one series, one line of the list.

use glam::Vec2;

use super::super::stage::{ENOUGH, carry_seconds, coupled, fit_seconds, splat_seconds, ways, without_walls};
use super::Point;
use crate::workbench::{Workbench, fastest};
use lightloom_core::constraint::{ActiveWall, Wall, Window};
use lightloom_core::engine::{MovingSegment, Traced};
use lightloom_core::flow::fit::Fitter;
use lightloom_core::flow::{FlowSettings, Segment, fit_segment};
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::render::TextureLayout;
use lightloom_core::{Error, Progress, Result};

/// One stage over one size.
pub(super) struct Series {
    pub(super) name: &'static str,
    /// What its size is.
    pub(super) size: &'static str,
    /// The exponent it shall not exceed.
    pub(super) bound: Option<f64>,
    /// Whether it is a power law.
    pub(super) log: bool,
    /// Measures at all sizes; none where the project does not do this.
    pub(super) run: fn(&mut Workbench, &Progress) -> Result<Vec<Point>>,
}

pub(super) const SERIES: [Series; 8] = [
    Series { name: "tracing", size: "photons", bound: Some(1.05), log: true, run: tracing },
    Series { name: "matching", size: "photons", bound: Some(1.15), log: true, run: matching },
    Series { name: "fit, one warm step", size: "unknowns", bound: Some(1.1), log: true, run: fit },
    Series { name: "advection, ten steps", size: "photons", bound: Some(1.05), log: true, run: advection },
    Series { name: "splatting", size: "photons", bound: Some(1.05), log: true, run: splatting },
    Series { name: "render", size: "passes", bound: Some(1.05), log: true, run: passes },
    Series { name: "fit of 20 steps", size: "walls", bound: None, log: false, run: walls },
    Series { name: "fit of 10 steps", size: "threads", bound: None, log: false, run: threads },
];

fn timed(size: f64, seconds: f64) -> Point {
    Point { size, seconds, memory: None }
}

/// Photons, about three times as many at each size.
fn counts(bench: &Workbench) -> Vec<usize> {
    let all = [10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000, 10_000_000];
    all[..bench.pick(4, all.len())].to_vec()
}

fn tracing(bench: &mut Workbench, progress: &Progress) -> Result<Vec<Point>> {
    let mut points = Vec::new();
    let gauge = bench.engine.gauge_tracing(&bench.project, &counts(bench), &progress.inner())?;
    for Traced { photons, seconds, .. } in gauge.into_iter().flat_map(|gauge| gauge.traced) {
        points.push(timed(photons as f64, seconds));
    }
    Ok(points)
}

/// The first move with so many photons.
fn first_move(bench: &mut Workbench, photons: usize, progress: &Progress) -> Result<MovingSegment> {
    let mut project = bench.project.clone();
    project.render.photons = photons as u64;
    bench.engine.moving_segment(&project, None, &progress.inner())
}

/// The pairs are made anew at each size. Around walls the continuous part takes the same time whatever the number.
fn matching(bench: &mut Workbench, progress: &Progress) -> Result<Vec<Point>> {
    let mut points = Vec::new();
    for count in counts(bench) {
        let photons = first_move(bench, count, progress)?;
        points.extend(photons.match_seconds().map(|seconds| timed(photons.source.len() as f64, seconds)));
    }
    Ok(points)
}

/// Guides as many as the project's, moved by a hundredth of their way from one fit to the next.
fn fit(bench: &mut Workbench, progress: &Progress) -> Result<Vec<Point>> {
    let photons = bench.first_move(progress)?;
    let settings = &bench.project.flow;
    let (source, ways) = ways(&photons, settings.guides as usize);
    let moved: Vec<Vec2> = source.iter().zip(&ways).map(|(from, way)| *from + 0.01 * *way).collect();
    let mut points = Vec::new();
    for cells in [32, 64, 128, 256, 512].into_iter().take(bench.pick(3, 5)) {
        let mut fitter = Fitter::new(coupled(cells, &photons, settings.alpha, settings.tolerance.into()))?;
        let (_, report) = fitter.fit(source, &ways, progress)?;
        let mut at_start = false;
        let (_, seconds) = fastest(6, ENOUGH, || {
            at_start = !at_start;
            fitter.fit(if at_start { &moved } else { source }, &ways, progress)
        })?;
        points.push(timed(report.unknowns as f64, seconds));
    }
    Ok(points)
}

fn advection(bench: &mut Workbench, progress: &Progress) -> Result<Vec<Point>> {
    let settings = FlowSettings { steps: 10, ..bench.project.flow.clone() };
    let few = bench.first_move(progress)?;
    let (fields, _) = fit_segment(&without_walls(&few, &settings), &progress.inner())?;
    let mut points = Vec::new();
    for count in counts(bench) {
        let photons = first_move(bench, count, progress)?;
        points.push(timed(photons.source.len() as f64, carry_seconds(&fields, &photons, progress)?));
    }
    Ok(points)
}

/// On 1024 texels along the longer side.
fn splatting(bench: &mut Workbench, progress: &Progress) -> Result<Vec<Point>> {
    let mut points = Vec::new();
    for count in counts(bench) {
        let photons = first_move(bench, count, progress)?;
        let layout = TextureLayout::new(photons.extent, 1024, 0.0);
        points.push(timed(photons.source.len() as f64, splat_seconds(layout, &photons, progress)?));
    }
    Ok(points)
}

/// Three frames; seconds of the passes alone, and their memory, which shall not grow.
fn passes(bench: &mut Workbench, progress: &Progress) -> Result<Vec<Point>> {
    let (first, last) = (bench.project.keys[0].frame, bench.project.keys[bench.project.keys.len() - 1].frame);
    let mut points = Vec::new();
    for passes in [1, 2, 4, 8] {
        let mut project = bench.project.clone();
        project.output.frames = Some(format!("{first},{},{last}", first.midpoint(last)));
        project.render.passes = passes;
        project.render.background_samples = 1;
        let summary = bench.render(&project, progress)?;
        let render = summary.stages.iter().find(|stage| stage.stage == "render");
        points.extend(render.map(|stage| Point {
            size: f64::from(passes),
            seconds: stage.seconds,
            memory: stage.peak_memory_mib,
        }));
    }
    Ok(points)
}

/// Walls of ten points each, at random over the plane, a tenth of it long.
fn walls(bench: &mut Workbench, progress: &Progress) -> Result<Vec<Point>> {
    let photons = bench.first_move(progress)?;
    let settings =
        FlowSettings { steps: 20, guides: bench.pick(5_000, 50_000), ..bench.project.flow.clone() };
    let all: Vec<ActiveWall> = (0..20).filter_map(|i| random_wall(i, photons.extent)).collect();
    let mut points = Vec::new();
    for count in [0, 1, 2, 5, 10, 20] {
        let course = Segment { walls: &all[..count.min(all.len())], ..photons.segment(&settings) };
        points.push(timed(count as f64, fit_seconds(1, &course, progress)?));
    }
    Ok(points)
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

/// In pools of their own.
fn threads(bench: &mut Workbench, progress: &Progress) -> Result<Vec<Point>> {
    let photons = bench.first_move(progress)?;
    let settings = FlowSettings { steps: 10, ..bench.project.flow.clone() };
    let all = rayon::current_num_threads();
    let mut counts: Vec<usize> = (0..10).map(|power| 1 << power).take_while(|count| *count < all).collect();
    counts.push(all);
    let mut points = Vec::new();
    for count in counts {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        let pool = pool.map_err(|error| Error::Numeric { stage: "report", what: error.to_string() })?;
        let course = without_walls(&photons, &settings);
        points.push(timed(count as f64, pool.install(|| fit_seconds(2, &course, progress))?));
    }
    Ok(points)
}
