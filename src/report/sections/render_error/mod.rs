//! The error of the light on the plane against a long reference, over passes and photons.

mod reference;
mod runs;

use super::section_def::SectionDef;
use crate::content::{Cell, Picture, Pictures, Section, Table, Tone};
use crate::context::Context;
use crate::number::short;
use crate::plot::{Axis, Line, Panel, Plot, Style};
use crate::slope::slope;
use lightloom_core::export::png::encode;
use lightloom_core::matching::MatchingMethod;
use lightloom_core::project::Project;
use lightloom_core::{Progress, Result};
use runs::{PassError, Runs, Series};

pub(super) const SECTION: SectionDef =
    SectionDef { name: "render", skip: same_in_every_pass, measure, seconds: [10.0, 220.0] };

/// The exponent of the error over photons that progressive photon mapping converges with: variance and squared bias both
/// fall as N^(-2/3) (Knaus and Zwicker 2011).
const LIMIT: f64 = -1.0 / 3.0;

/// Exponents above this one are those of edges under a shrinking kernel (-1/12), not of noise.
const BLUR: f64 = -0.2;
/// Noise of the reference, over the mean light, that is visible.
const NOISY: f64 = 0.2;

fn same_in_every_pass(project: &Project) -> Option<&'static str> {
    (project.matching == MatchingMethod::Given)
        .then_some("rows of point files are paired as given, so more passes bring no other photons")
}

fn measure(context: &mut Context, progress: &Progress) -> Result<Section> {
    let runs = runs::run(context, progress)?;
    let mut section = Section::new("render", "What passes and photons buy");
    section.text(runs.method());
    section.text(runs.summary());
    section.plot(runs.plot());
    section.pictures(runs.pictures()?);
    section.table(runs.table());
    Ok(section)
}

impl Series {
    /// Exponents of the rms error and the perceptual error over the photons.
    fn slopes(&self) -> [Option<f64>; 2] {
        [|row: &PassError| row.rms, |row: &PassError| row.perceptual].map(|error| {
            let points: Vec<_> =
                self.rows.iter().map(|row| ((self.photons * row.passes) as f64, error(row))).collect();
            slope(&points)
        })
    }

    fn name(&self) -> String {
        format!("{} per pass", short(self.photons as f64))
    }
}

impl Runs {
    /// The passes of the project's own size, and the row of its own number of passes where that was reached.
    fn own(&self) -> Option<(&Series, Option<&PassError>)> {
        let (photons, passes) = self.planned;
        let series = self.series.iter().find(|series| series.photons == photons)?;
        Some((series, series.rows.iter().find(|row| row.passes == passes)))
    }

    fn is_own(&self, series: &Series, row: &PassError) -> bool {
        self.planned == (series.photons, row.passes)
    }

    fn method(&self) -> String {
        let still = 100.0 * self.reference.still_share();
        format!(
            "The light on the plane at frame {}, seen straight on where it falls, so that no noise of the background \
             counts. The reference is the same flow lit by {} photons of other random numbers, spread by one kernel of \
             radius {} of the plane: finer blur is not seen as an error, and runs end where their kernel is finer. Rms \
             error: root mean square difference of the irradiance over its mean; the noise of the reference is taken out \
             by comparing with two independent halves of it. Perceptual error: 1 - SSIM (Wang et al. 2004) of the pictures through the view transform. \
             Frame-to-frame noise: rms change to the next frame, less that of the reference, over the light where the \
             reference changes by less than 2 % ({} % of the lit part). Seconds are those of the passes of all {} frames, \
             by one that was timed.",
            self.frame,
            short(self.photons as f64),
            short(f64::from(self.reference.radius)),
            short(still),
            self.frames
        )
    }

    /// The summary.
    fn summary(&self) -> String {
        let Some((series, own)) = self.own() else {
            return "The project's passes are too large to be followed here.".to_owned();
        };
        let Some(row) = own.or(series.rows.last()) else { return String::new() };
        let mut text = format!(
            "{}, about {} s, have an rms error of {}.",
            passes_of(row.passes, series.photons),
            short(row.seconds),
            short(row.rms)
        );
        if let Some(exponent) = series.slopes()[0] {
            text += &self.outlook(series, row, own.is_none(), exponent);
        }
        let best = self.best_within(row.seconds * 1.05);
        if let Some((other, better)) = best.filter(|(_, better)| better.rms < 0.95 * row.rms) {
            let passes = passes_of(better.passes, other.photons);
            text += &format!(" In the same time {passes} reach {}.", short(better.rms));
        }
        if self.reference.noise > NOISY {
            text += " The reference itself is noisy, which hides part of the perceptual differences.";
        }
        text
    }

    /// The expected error of more passes, if it falls with this exponent.
    fn outlook(&self, series: &Series, row: &PassError, is_short: bool, exponent: f64) -> String {
        let left = 100.0 * 2.0_f64.powf(exponent);
        let mut text = format!(" Twice the passes leave {left:.0} % of it (at the limit 79 %).");
        if exponent > BLUR {
            let radius = short(f64::from(series.radius));
            text += &format!(
                " What is left is mostly blur, which more passes hardly lower: a smaller render.radius than {radius} would."
            );
        } else {
            let times = short(2.0_f64.powf(-1.0 / exponent));
            text += &format!(" Half of it takes {times} times as long.");
        }
        let passes = self.planned.1;
        if is_short && passes > row.passes {
            let rms = row.rms * (passes as f64 / row.passes as f64).powf(exponent);
            text += &format!(" The {passes} passes of the project would reach {}.", short(rms));
        }
        text
    }

    /// The smallest rms error within this time.
    fn best_within(&self, seconds: f64) -> Option<(&Series, &PassError)> {
        let all = self.series.iter().flat_map(|series| series.rows.iter().map(move |row| (series, row)));
        all.filter(|(_, row)| row.seconds <= seconds).min_by(|a, b| a.1.rms.total_cmp(&b.1.rms))
    }

    fn plot(&self) -> Plot {
        let seconds = |row: &PassError| row.seconds;
        let passes = |row: &PassError| row.passes as f64;
        Plot {
            name: "render".to_owned(),
            title: "Error of the rendered light".to_owned(),
            panels: vec![
                self.panel("rms error", "seconds, all frames", seconds, |row| Some(row.rms), true),
                self.panel(
                    "perceptual error, 1 - SSIM",
                    "seconds, all frames",
                    seconds,
                    |row| Some(row.perceptual),
                    false,
                ),
                self.panel(
                    "frame-to-frame noise in still regions",
                    "passes",
                    passes,
                    |row| row.flicker,
                    false,
                ),
            ],
        }
    }

    /// One line for each size of passes, the project's own marked by a ring; with the theoretical slope if `limit`.
    fn panel(
        &self,
        title: &str,
        axis: &str,
        x: fn(&PassError) -> f64,
        y: fn(&PassError) -> Option<f64>,
        limit: bool,
    ) -> Panel {
        let mut lines = Vec::new();
        for (i, series) in self.series.iter().enumerate() {
            let points = series.rows.iter().filter_map(|row| Some((x(row), y(row)?))).collect();
            let label = match series.slopes()[0].filter(|_| limit) {
                Some(exponent) => format!("{}, slope {}", series.name(), short(exponent)),
                None => series.name(),
            };
            lines.push(Line::new(label, Style::Line(i), points));
            let own = series.rows.iter().find(|row| self.is_own(series, row));
            if let Some((row, value)) = own.and_then(|row| Some((row, y(row)?))) {
                lines.push(Line::new("as the project has it", Style::Rings(i), vec![(x(row), value)]));
            }
        }
        if let Some(law) = self.series.last().filter(|_| limit).and_then(|series| law(series, x, y)) {
            lines.insert(0, Line::new("N^(-1/3)", Style::Law, law));
        }
        lines.retain(|line| !line.points.is_empty());
        Panel { title: title.to_owned(), x: Axis::log(axis), y: Axis::log(""), lines }
    }

    fn pictures(&self) -> Result<Pictures> {
        let mut pictures = Vec::new();
        if let Some((series, _)) = self.own().or(self.series.last().map(|series| (series, None))) {
            let numbers =
                [series.rows.first(), series.rows.last()].map(|row| row.map_or(0, |row| row.passes));
            for (picture, passes) in series.pictures.iter().zip(numbers) {
                let label = format!("{passes} x {} photons", short(series.photons as f64));
                pictures.push(Picture { label, png: encode(picture)? });
            }
        }
        let label = format!("reference, {} photons", short(self.photons as f64));
        pictures.push(Picture { label, png: encode(&self.reference.picture)? });
        let caption = "The lit part of the plane after the first pass, after the last, and in the reference.";
        Ok(Pictures { caption: caption.to_owned(), columns: pictures.len(), pictures })
    }

    fn table(&self) -> Table {
        let columns = [
            "photons per pass",
            "passes",
            "seconds, all frames",
            "seconds, measured",
            "rms error",
            "perceptual error",
            "frame-to-frame noise",
            "slope, rms",
            "slope, perceptual",
        ];
        let caption = "After each doubling of the passes. The slopes are exponents over the photons, of all rows of one \
                       size; the limit is -1/3. The error of the reference is its own noise.";
        let mut table = Table::new("render", caption, &columns);
        for series in &self.series {
            for (i, row) in series.rows.iter().enumerate() {
                let is_last = i + 1 == series.rows.len();
                let [rms, perceptual] = if is_last { series.slopes() } else { [None; 2] };
                let tone = if self.is_own(series, row) { Tone::Marked } else { Tone::Plain };
                table.push(
                    tone,
                    vec![
                        series.photons.into(),
                        row.passes.into(),
                        row.seconds.into(),
                        row.measured.into(),
                        row.rms.into(),
                        row.perceptual.into(),
                        row.flicker.into(),
                        rms.into(),
                        perceptual.into(),
                    ],
                );
            }
        }
        let mut reference = vec![Cell::Nothing; columns.len()];
        reference[0] = format!("reference, {} in all", short(self.photons as f64)).into();
        reference[4] = self.reference.noise.into();
        table.push(Tone::Plain, reference);
        table
    }
}

fn passes_of(passes: usize, photons: usize) -> String {
    let word = if passes == 1 { "pass" } else { "passes" };
    format!("{passes} {word} of {} photons", short(photons as f64))
}

/// A line of the theoretical slope through the first point of a series.
fn law(
    series: &Series,
    x: fn(&PassError) -> f64,
    y: fn(&PassError) -> Option<f64>,
) -> Option<Vec<(f64, f64)>> {
    let first = series.rows.first()?;
    let (x0, y0) = (x(first), y(first)?);
    Some(series.rows.iter().map(|row| (x(row), y0 * (x(row) / x0).powf(LIMIT))).collect())
}
