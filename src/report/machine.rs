//! The limits of this machine, measured on all threads together.

use std::hint::black_box;
use std::time::Instant;

use rayon::prelude::*;
use wide::f32x8;

/// Memory bandwidth and arithmetic rate, the two limits of the roofline model (Williams, Waterman, Patterson 2009).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Machine {
    pub(crate) bytes_per_second: f64,
    /// A fused multiply-add counts as two.
    pub(crate) operations_per_second: f64,
}

impl Machine {
    pub(crate) fn measure() -> Self {
        Self { bytes_per_second: bytes_per_second(), operations_per_second: operations_per_second() }
    }

    /// The least seconds for moving bytes and for operations, whichever takes longer, and which of the two it is.
    pub(crate) fn seconds(&self, bytes: f64, operations: f64) -> (f64, &'static str) {
        let (memory, arithmetic) = (bytes / self.bytes_per_second, operations / self.operations_per_second);
        if memory > arithmetic { (memory, "memory") } else { (arithmetic, "arithmetic") }
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
