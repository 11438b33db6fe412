//! A smooth step.

/// From 0 at 0 to 1 at 1 without a kink at either end; constant beyond.
pub fn smoothstep(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
