//! The noise of a growing frame against time, as an artist judges whether more passes are worth their time.

use std::time::Duration;

use egui::{Align2, FontId, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};
use lightloom_core::render::Image;

use crate::editor::theme;

/// Height of the curve, points.
const HEIGHT: f32 = 74.0;
/// Room for its words, points.
const WORDS: f32 = 16.0;

/// How the noise of one frame falls from pass to pass.
#[derive(Clone, Debug, Default)]
pub(super) struct Convergence {
    /// The frame, its passes and its picture after the last of them.
    last: Option<(i32, usize, Image)>,
    /// Passes, working time and noise, in rising order.
    points: Vec<Point>,
}

/// The noise after some passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Passes in the frame.
    pub passes: usize,
    /// Since the export began.
    pub time: Duration,
    /// Root mean square error by noise, estimated; share of white on the screen.
    pub noise: f64,
}

impl Convergence {
    /// Takes a picture of a frame after some passes. Another frame begins a curve of its own.
    pub(super) fn add(&mut self, (frame, passes): (i32, usize), time: Duration, image: &Image) {
        if let Some((of, before, last)) = &self.last {
            if *of != frame {
                self.points.clear();
            } else if let Some(square) = square((*before, last), (passes, image)) {
                let of_before = self.points.last().filter(|point| point.passes == *before);
                let known = of_before.map(|point| point.noise.powi(2));
                let noise = noise(known, (*before, passes), square);
                self.points.push(Point { passes, time, noise });
            }
        }
        self.last = Some((frame, passes, image.clone()));
    }

    /// The points of the curve.
    pub(super) fn points(&self) -> &[Point] {
        &self.points
    }
}

/// The curve, with what the last of its points says; nothing before there is one.
pub(super) fn show(ui: &mut Ui, points: &[Point]) {
    let Some(now) = points.last() else { return };
    // One point is no curve.
    let height = if points.len() > 1 { HEIGHT } else { WORDS };
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
    let words = format!("Noise {} after {}", percent(now.noise), counted(now.passes));
    let weak = ui.visuals().weak_text_color();
    ui.painter().text(rect.left_top(), Align2::LEFT_TOP, &words, FontId::proportional(11.0), weak);
    if points.len() > 1 {
        plot(ui, rect.with_min_y(rect.top() + WORDS), points);
    }
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &words));
    let more = now.passes.saturating_mul(4);
    response.on_hover_text(format!(
        "How far the shown frame is from its limit by noise alone, root mean square over the picture, against working time, both \
         logarithmic. It falls as one over the root of the passes: half of it takes four times as many, {more}."
    ));
}

fn plot(ui: &Ui, rect: Rect, points: &[Point]) {
    let visuals = ui.visuals();
    ui.painter().rect_filled(rect, 3.0, visuals.extreme_bg_color);
    let log = |point: &Point| (point.time.as_secs_f64().max(1e-3).ln(), point.noise.max(1e-6).ln());
    let ends = |values: &dyn Fn(&Point) -> f64| {
        let all = points.iter().map(values);
        let (low, high) = (all.clone().fold(f64::MAX, f64::min), all.fold(f64::MIN, f64::max));
        (low, (high - low).max(0.1))
    };
    let ((left, width), (low, height)) = (ends(&|p| log(p).0), ends(&|p| log(p).1));
    // The times stand below the curve.
    let inner = rect.shrink(7.0).with_max_y(rect.bottom() - WORDS);
    let at = |point: &Point| -> Pos2 {
        let (x, y) = (((log(point).0 - left) / width) as f32, ((log(point).1 - low) / height) as f32);
        pos2(inner.left() + x * inner.width(), inner.bottom() - y * inner.height())
    };
    let line: Vec<Pos2> = points.iter().map(at).collect();
    let painter = ui.painter_at(rect);
    for point in &line {
        painter.circle_filled(*point, 2.5, theme::ACCENT);
    }
    painter.add(Shape::line(line, Stroke::new(1.5, theme::ACCENT)));
    let [first, .., last] = points else { return };
    let seconds = |point: &Point| format!("{:.0} s", point.time.as_secs_f64());
    let corners = [
        (rect.left_bottom() + vec2(4.0, -2.0), Align2::LEFT_BOTTOM, seconds(first)),
        (rect.right_bottom() + vec2(-4.0, -2.0), Align2::RIGHT_BOTTOM, seconds(last)),
        (rect.right_top() + vec2(-4.0, 2.0), Align2::RIGHT_TOP, format!("from {}", percent(first.noise))),
    ];
    for (place, align, words) in corners {
        painter.text(place, align, words, FontId::proportional(10.0), visuals.weak_text_color());
    }
}

/// The mean square of the difference of two pictures of one frame, of which the earlier is the mean of its first passes; none
/// where they cannot be compared.
fn square((m, before): (usize, &Image), (n, now): (usize, &Image)) -> Option<f64> {
    if m == 0 || n <= m || before.pixels.len() != now.pixels.len() || now.pixels.is_empty() {
        return None;
    }
    let square = |(a, b): (&_, &_)| {
        let difference: glam::Vec3 = *b - *a;
        f64::from(difference.length_squared()) / 3.0
    };
    Some(before.pixels.iter().zip(&now.pixels).map(square).sum::<f64>() / now.pixels.len() as f64)
}

/// The noise of the mean of n passes, which differs from the mean of the first m by `square`, and whose variance was `known`.
///
/// A is the mean of the first m passes and B that of the k = n - m new ones, so the means differ by k (B - A) / n:
/// n² square = k² (V(A) + V(B)), and n² V = m² V(A) + k² V(B). Passes are not all as noisy: the kernel shrinks. At first
/// nothing is known of A, and all are taken for equal.
fn noise(known: Option<f64>, (m, n): (usize, usize), square: f64) -> f64 {
    let (m, n) = (m as f64, n as f64);
    let k = n - m;
    let of_first = known.unwrap_or(square / (1.0 / m - 1.0 / n) / m);
    let of_new = (n * n * square - k * k * of_first).max(0.0);
    (m * m * of_first + of_new).sqrt() / n
}

fn percent(noise: f64) -> String {
    format!("{:.2} %", 100.0 * noise)
}

/// A number of passes in words.
pub(super) fn counted(count: usize) -> String {
    if count == 1 { "1 pass".into() } else { format!("{count} passes") }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// Noise of the standard deviation .1, from a small generator of its own.
    fn passes_of(count: usize, pixels: usize) -> Vec<Vec<f32>> {
        let mut state = 1_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1_u64 << 24) as f32 - 0.5
        };
        let deviation = 0.1 * 12_f32.sqrt();
        (0..count).map(|_| (0..pixels).map(|_| 0.5 + deviation * uniform()).collect()).collect()
    }

    #[test]
    fn the_estimate_is_the_error_of_the_mean() {
        let (count, side) = (16, 64);
        let passes = passes_of(count, side * side);
        let mut curve = Convergence::default();
        for n in 1..=count {
            let mean = |i: usize| passes[..n].iter().map(|pass| pass[i]).sum::<f32>() / n as f32;
            let pixels = (0..side * side).map(|i| Vec3::splat(mean(i))).collect();
            curve.add((7, n), Duration::from_secs(n as u64), &Image { width: side, height: side, pixels });
        }
        assert_eq!(curve.points().len(), count - 1);
        for point in curve.points() {
            let known = 0.1 / (point.passes as f64).sqrt();
            // Of 4096 pixels the deviation is known to about one per cent; four of these.
            assert!((point.noise / known - 1.0).abs() < 0.05, "{point:?} against {known}");
        }
    }

    #[test]
    fn passes_of_growing_noise_are_told_by_their_mean() {
        let (count, side) = (9, 64);
        let mut passes = passes_of(count, side * side);
        let growth = |pass: usize| 1.0 + pass as f32 / 4.0;
        for (i, pass) in passes.iter_mut().enumerate() {
            pass.iter_mut().for_each(|value| *value = 0.5 + (*value - 0.5) * growth(i));
        }
        let mut curve = Convergence::default();
        for n in 1..=count {
            let mean = |i: usize| passes[..n].iter().map(|pass| pass[i]).sum::<f32>() / n as f32;
            let pixels = (0..side * side).map(|i| Vec3::splat(mean(i))).collect();
            curve.add((7, n), Duration::from_secs(n as u64), &Image { width: side, height: side, pixels });
        }
        let [.., last] = curve.points() else { panic!("no curve") };
        let known = (0..count).map(|i| f64::from(0.1 * growth(i)).powi(2)).sum::<f64>().sqrt() / count as f64;
        assert!((last.noise / known - 1.0).abs() < 0.05, "{last:?} against {known}");
    }

    #[test]
    fn another_frame_begins_anew_and_nothing_is_said_of_one_picture() {
        let mut curve = Convergence::default();
        let image = Image::new(4, 4);
        curve.add((1, 1), Duration::ZERO, &image);
        assert_eq!(curve.points(), []);
        curve.add((1, 2), Duration::ZERO, &image);
        assert_eq!(curve.points().len(), 1);
        curve.add((2, 3), Duration::ZERO, &image);
        assert_eq!(curve.points(), []);
    }
}
