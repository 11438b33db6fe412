//! How near each stage comes to what this machine can do.
//!
//! For each stage a lower bound of its work is counted, bytes that must move and floating point operations that must be done,
//! and turned into seconds by the bandwidth and the rate of fused multiply-adds that the same run measures on the same threads
//! (the roofline of Williams, Waterman, Patterson 2009). Tracing is held against rays through the bare hierarchy.

use std::hint::black_box;
use std::time::Instant;

use glam::Vec3;
use rayon::prelude::*;
use wide::f32x8;

use super::super::chapter::{Chapter, Part, Table, Tone};
use super::super::workbench::{Workbench, fastest};
use super::stage::{ENOUGH, carry_seconds, coupled, splat_seconds, ways, without_walls};
use super::{Section, nothing_moves};
use lightloom_core::engine::{MovingSegment, Traced};
use lightloom_core::flow::fit::Fitter;
use lightloom_core::flow::{FlowSettings, Segment, fit_segment};
use lightloom_core::render::{ProgressiveRender, TextureLayout, Workspace};
use lightloom_core::{Progress, Result};

pub(crate) const SECTION: Section =
    Section { name: "machine", needless: nothing_moves, measure, seconds: [6.0, 20.0] };

/// What the machine can do, on all threads together.
struct Machine {
    bytes_per_second: f64,
    operations_per_second: f64,
}

/// One stage, its work at least, and the seconds it took.
struct Gauged {
    stage: &'static str,
    items: f64,
    item: &'static str,
    seconds: f64,
    /// The seconds the machine would need for the least work.
    limit: f64,
    by: &'static str,
    /// What the count is made of.
    counted: &'static str,
}

fn measure(bench: &mut Workbench, progress: &Progress) -> Result<Chapter> {
    progress.begin("machine", 1 + STAGES.len() as u64);
    let machine = Machine::measure();
    let photons = bench.first_move(progress)?;
    progress.advance(1);
    let columns = ["stage", "items per second", "item", "limit per second", "ratio", "limited by", "counted"];
    let caption = format!(
        "Threads: {}. Bandwidth {:.1} GB/s (a[i] = b[i] + s c[i] over 3 x 64 MiB), {:.0} billion fused multiply-adds \\
         per second counted as two operations each.",
        rayon::current_num_threads(),
        1e-9 * machine.bytes_per_second,
        1e-9 * machine.operations_per_second
    );
    let mut table = Table::new("machine", caption, &columns);
    for gauge in STAGES {
        if let Some(gauged) = gauge(bench, &machine, &photons, progress)? {
            let Gauged { stage, items, item, seconds, limit, by, counted } = gauged;
            let numbers = [items / seconds, items / limit, limit / seconds];
            let [rate, most, ratio] = numbers.map(Into::into);
            table.push(
                Tone::Plain,
                vec![stage.into(), rate, item.into(), most, ratio, by.into(), counted.into()],
            );
        }
        progress.advance(1);
    }
    let mut chapter = Chapter::new("machine", "How near to the machine's limits");
    chapter.say(
        "The limit counts only work that no program could avoid, as if everything in the caches were free: gathers, sorting, \
         and the latency of memory are not in it. A ratio of 1 cannot be reached.",
    );
    chapter.parts.push(Part::Table(table));
    Ok(chapter)
}

type Gauge = fn(&mut Workbench, &Machine, &MovingSegment, &Progress) -> Result<Option<Gauged>>;
const STAGES: [Gauge; 6] = [tracing, matching, solver, advection, splatting, storing];

impl Machine {
    fn measure() -> Self {
        Self { bytes_per_second: bytes_per_second(), operations_per_second: operations_per_second() }
    }

    /// Seconds for so many bytes and operations, whichever takes longer, and which it is.
    fn seconds(&self, bytes: f64, operations: f64) -> (f64, &'static str) {
        let (move_, compute) = (bytes / self.bytes_per_second, operations / self.operations_per_second);
        if move_ > compute { (move_, "memory") } else { (compute, "arithmetic") }
    }
}

/// The best of some runs of the third loop of STREAM (McCalpin 1995), which counts three arrays.
fn bytes_per_second() -> f64 {
    const LENGTH: usize = 1 << 24;
    const CHUNK: usize = 1 << 16;
    let (b, c) = (vec![1.0_f32; LENGTH], vec![2.0_f32; LENGTH]);
    let mut a = vec![0.0_f32; LENGTH];
    let best = (0..5)
        .map(|run| {
            let start = Instant::now();
            let factor = run as f32;
            let parts = a.par_chunks_mut(CHUNK).zip(b.par_chunks(CHUNK)).zip(c.par_chunks(CHUNK));
            parts.for_each(|((a, b), c)| {
                a.iter_mut().zip(b).zip(c).for_each(|((a, b), c)| *a = b + factor * c);
            });
            start.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min);
    black_box(&a);
    (3 * LENGTH * size_of::<f32>()) as f64 / best.max(1e-9)
}

/// Multiply-adds in twelve independent chains per thread, all in registers.
fn operations_per_second() -> f64 {
    const ROUNDS: usize = 4_000_000;
    const CHAINS: usize = 12;
    let threads = rayon::current_num_threads();
    let start = Instant::now();
    (0..threads).into_par_iter().for_each(|thread| {
        let (factor, more) = (f32x8::splat(black_box(0.999)), f32x8::splat(black_box(0.001)));
        let mut chains = [f32x8::splat(thread as f32); CHAINS];
        for _ in 0..ROUNDS {
            chains.iter_mut().for_each(|chain| *chain = chain.mul_add(factor, more));
        }
        black_box(chains);
    });
    let operations = (threads * ROUNDS * CHAINS * 8 * 2) as f64;
    operations / start.elapsed().as_secs_f64().max(1e-9)
}

fn tracing(
    bench: &mut Workbench,
    _: &Machine,
    _: &MovingSegment,
    progress: &Progress,
) -> Result<Option<Gauged>> {
    let count = bench.pick(200_000, 1_000_000);
    let gauge = bench.engine.gauge_tracing(&bench.project, &[count], &progress.inner())?;
    let traced = gauge.and_then(|gauge| Some((*gauge.traced.first()?, gauge.bare_rays_per_second)));
    Ok(traced.map(|(Traced { photons, rays, seconds }, bare)| Gauged {
        stage: "tracing",
        items: photons as f64,
        item: "photons landed",
        seconds,
        limit: rays as f64 / bare,
        by: "bare rays",
        counted: "all rays followed, at the rate of random rays through the bare hierarchy",
    }))
}

/// Halving both sets down to single points: a reading and a writing of each level.
fn matching(
    _: &mut Workbench,
    machine: &Machine,
    photons: &MovingSegment,
    _: &Progress,
) -> Result<Option<Gauged>> {
    let count = photons.source.len() as f64;
    let (limit, by) = machine.seconds(count * count.log2() * 2.0 * 2.0 * 8.0, 0.0);
    Ok(photons.match_seconds().map(|seconds| Gauged {
        stage: "matching",
        items: count,
        item: "photons",
        seconds,
        limit,
        by,
        counted: "both columns of points read and written once per halving; not the map between the densities",
    }))
}

/// Products with the matrix of one iteration: one in double precision, and in single precision two smoothings of three
/// products each (the first of a smoothing from zero is free) and two more, on grids that add up to 4/3.
fn solver(
    bench: &mut Workbench,
    machine: &Machine,
    photons: &MovingSegment,
    progress: &Progress,
) -> Result<Option<Gauged>> {
    const SINGLE_PRODUCTS: f64 = 6.0 * 4.0 / 3.0;
    // Half of the 49 neighbours of a cubic spline for each of psi, phi and their coupling.
    const ENTRIES: f64 = 3.0 * 25.0;
    let cells = bench.pick(64, 256);
    let settings = coupled(cells, photons, bench.project.flow.alpha, 1e-8);
    let (source, ways) = ways(photons, 2000);
    let mut fitter = Fitter::new(settings)?;
    let (iterations, seconds) = fastest(3, ENOUGH, || {
        fitter.reset();
        Ok(fitter.fit(source, &ways, progress)?.1.iterations)
    })?;
    let nodes = settings.grid.nodes().iter().product::<usize>() as f64;
    let bytes = nodes * ENTRIES * (8.0 + 4.0 * SINGLE_PRODUCTS);
    let operations = 2.0 * nodes * ENTRIES * 2.0 * (1.0 + SINGLE_PRODUCTS);
    let (limit, by) = machine.seconds(bytes, operations);
    let rounds = iterations as f64;
    Ok((iterations > 0).then_some(Gauged {
        stage: "fit, solver (few photons)",
        items: rounds,
        item: "iterations",
        seconds,
        limit: rounds * limit,
        by,
        counted: "entries of the matrix in seven products on grids that add up to 4/3; setting it up is not in it",
    }))
}

/// Four velocities of 16 splines of two potentials each, and what the photon is.
fn advection(
    bench: &mut Workbench,
    machine: &Machine,
    photons: &MovingSegment,
    progress: &Progress,
) -> Result<Option<Gauged>> {
    const STEPS: usize = 10;
    const OPERATIONS: f64 = 4.0 * (16.0 * 2.0 * 2.0 * 2.0 + 40.0);
    const BYTES: f64 = 2.0 * 36.0;
    let settings = FlowSettings { steps: STEPS as u32, turbulence: None, ..bench.project.flow.clone() };
    let course = Segment { lines: &[], ..without_walls(photons, &settings) };
    let (fields, _) = fit_segment(&course, &progress.inner())?;
    let seconds = carry_seconds(&fields, photons, progress)?;
    let steps = (STEPS * photons.source.len()) as f64;
    let (limit, by) = machine.seconds(steps * BYTES, steps * OPERATIONS);
    Ok(Some(Gauged {
        stage: "advection",
        items: steps,
        item: "photon-steps",
        seconds,
        limit,
        by,
        counted: "RK4: four sums over 4 x 4 splines of psi and phi, and the photon read and written",
    }))
}

fn splatting(
    bench: &mut Workbench,
    machine: &Machine,
    photons: &MovingSegment,
    progress: &Progress,
) -> Result<Option<Gauged>> {
    let layout = TextureLayout::new(photons.extent, bench.pick(512, 1024), 0.0);
    let seconds = splat_seconds(layout, photons, progress)?;
    let count = photons.source.len() as f64;
    let bytes = count * 20.0 + layout.len() as f64 * 16.0;
    let (limit, by) = machine.seconds(bytes, count * 4.0 * 3.0 * 2.0);
    Ok(Some(Gauged {
        stage: "splatting",
        items: count,
        item: "photons",
        seconds,
        limit,
        by,
        counted: "place and flux read once, the texture written once",
    }))
}

/// One frame of one pass after the first: splatted, filtered, and added to the scratch file.
fn storing(
    bench: &mut Workbench,
    machine: &Machine,
    photons: &MovingSegment,
    progress: &Progress,
) -> Result<Option<Gauged>> {
    let layout = TextureLayout::new(photons.extent, bench.pick(512, 1024), 0.0);
    let flux = vec![Vec3::ONE; photons.source.len()];
    let render = ProgressiveRender::new(layout, 0.006, 1, bench.scratch)?;
    let mut work = Workspace::new(layout);
    let mut pass = 0;
    let (_, seconds) = fastest(6, ENOUGH, || {
        progress.check()?;
        pass += 1;
        render.add(0, pass, &photons.source, &flux, &mut work)
    })?;
    let texels = layout.len() as f64;
    let bytes = photons.source.len() as f64 * 20.0 + texels * (16.0 + 2.0 * 32.0 + 16.0 + 24.0);
    let (limit, by) = machine.seconds(bytes, texels * 2.0 * 3.0 * 4.0 * 5.0);
    Ok(Some(Gauged {
        stage: "frame and pass",
        items: texels,
        item: "texels",
        seconds,
        limit,
        by,
        counted: "splatting; rows and columns filtered, each read and written once; the sum read and written",
    }))
}
