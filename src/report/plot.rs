//! Plots with panels of lines and points, as SVG.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;
use serde::Serialize;

use crate::number::short;
use lightloom_core::{Error, Result};

/// Panels under a title.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plot {
    /// Stem of its SVG file.
    pub name: String,
    /// Headline.
    pub title: String,
    /// The panels, two in a row.
    pub panels: Vec<Panel>,
}

/// A panel of a plot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Panel {
    /// What it shows.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Its lines, the first at the bottom.
    pub lines: Vec<Line>,
}

/// An axis of a panel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// Whether it is logarithmic; numbers that are not positive are then left out.
    pub log: bool,
}

/// A line or a group of points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Entry in the legend; none where it is empty.
    pub label: String,
    /// Style.
    pub style: Style,
    /// x and y.
    pub points: Vec<(f64, f64)>,
}

/// The style of a line. Styles of the same number have the same colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Style {
    /// A line with a dot at each point.
    Line(usize),
    /// Dots.
    Dots(usize),
    /// Large rings around points that stand out.
    Rings(usize),
    /// A thin grey line, for a law or a limit.
    Law,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), log: false }
    }

    /// A logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), log: true }
    }
}

impl Line {
    /// Points with a label and a style.
    pub fn new(label: impl Into<String>, style: Style, points: Vec<(f64, f64)>) -> Self {
        Self { label: label.into(), style, points }
    }
}

/// Width and height of a panel in pixels.
const PANEL: (u32, u32) = (440, 300);
const TITLE: u32 = 34;
/// Blue, red, green, violet, orange, teal: distinct on white, in print and for most eyes.
const COLOURS: [RGBColor; 6] = [
    RGBColor(31, 90, 170),
    RGBColor(200, 60, 40),
    RGBColor(60, 140, 60),
    RGBColor(130, 80, 160),
    RGBColor(220, 140, 20),
    RGBColor(20, 140, 150),
];

impl Plot {
    /// The plot as SVG, its panels in rows of two.
    ///
    /// # Errors
    /// `Numeric` when a number is not finite.
    pub fn to_svg(&self) -> Result<String> {
        let failed = |what: String| Error::Numeric { stage: "report", what };
        let points = || self.panels.iter().flat_map(|panel| &panel.lines).flat_map(|line| &line.points);
        if let Some(point) = points().find(|(x, y)| !(x.is_finite() && y.is_finite())) {
            return Err(failed(format!("{point:?} is not finite; take a larger alpha")));
        }
        let columns = self.panels.len().clamp(1, 2);
        let rows = self.panels.len().div_ceil(2);
        let mut svg = String::new();
        {
            let size = (columns as u32 * PANEL.0, TITLE + rows as u32 * PANEL.1);
            let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
            root.fill(&WHITE)
                .and_then(|()| root.titled(&self.title, ("sans-serif", 20)))
                .and_then(|area| {
                    let cells = area.split_evenly((rows, columns));
                    cells.iter().zip(&self.panels).try_for_each(|(cell, panel)| draw_panel(cell, panel))
                })
                .and_then(|()| root.present())
                .map_err(|error| failed(error.to_string()))?;
        }
        Ok(svg)
    }
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Failure<'a> = DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>;

/// Draws a panel with linear or logarithmic axes.
fn draw_panel<'a>(area: &Area<'a>, panel: &Panel) -> Result<(), Failure<'a>> {
    let shown: Vec<Line> = panel.lines.iter().map(|line| visible(line, panel)).collect();
    let x = bounds(shown.iter().flat_map(|line| &line.points).map(|p| p.0), panel.x.log, false);
    let y = bounds(shown.iter().flat_map(|line| &line.points).map(|p| p.1), panel.y.log, true);
    let shown = (shown.as_slice(), emptier_corner(panel, &shown, &x, &y));
    match (panel.x.log, panel.y.log) {
        (false, false) => draw_lines(area, panel, shown, x, y),
        (false, true) => draw_lines(area, panel, shown, x, y.log_scale()),
        (true, false) => draw_lines(area, panel, shown, x.log_scale(), y),
        (true, true) => draw_lines(area, panel, shown, x.log_scale(), y.log_scale()),
    }
}

/// The line without the points that its axes cannot show.
fn visible(line: &Line, panel: &Panel) -> Line {
    let shows = |&&(x, y): &&(f64, f64)| (!panel.x.log || x > 0.0) && (!panel.y.log || y > 0.0);
    Line { points: line.points.iter().filter(shows).copied().collect(), ..line.clone() }
}

/// The range of an axis: all values with a margin; a linear vertical axis begins at 0, so that a line that looks flat is flat.
fn bounds(values: impl Iterator<Item = f64>, log: bool, upwards: bool) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    // Nothing at all still needs an axis.
    match (log, upwards) {
        _ if low > high => 0.1..1.0,
        // Only powers of ten are labelled: there shall be two of them.
        (true, _) if (high.log10().floor() - low.log10().ceil()) < 1.0 => {
            0.999 * 10_f64.powf((low / 1.1).log10().floor())..1.001 * 10_f64.powf((high * 1.1).log10().ceil())
        }
        (true, _) => low / 1.3..high * 1.3,
        (false, true) if high > 0.0 => low.min(0.0)..1.08 * high,
        (false, _) if high > low => low..high,
        _ => low - 0.5..low + 0.5,
    }
}

fn draw_lines<'a, X, Y>(
    area: &Area<'a>,
    panel: &Panel,
    (lines, corner): (&[Line], SeriesLabelPosition),
    x: X,
    y: Y,
) -> Result<(), Failure<'a>>
where
    X: AsRangedCoord<Value = f64>,
    Y: AsRangedCoord<Value = f64>,
    X::CoordDescType: ValueFormatter<f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let mut chart = ChartBuilder::on(area)
        .caption(&panel.title, ("sans-serif", 15))
        .margin(8)
        .margin_right(16)
        .x_label_area_size(34)
        .y_label_area_size(56)
        .build_cartesian_2d(x, y)?;
    let number = |value: &f64| tick(*value);
    chart
        .configure_mesh()
        .x_desc(&panel.x.label)
        .y_desc(&panel.y.label)
        .x_labels(6)
        .y_labels(6)
        .x_label_formatter(&number)
        .y_label_formatter(&number)
        .light_line_style(TRANSPARENT)
        .draw()?;
    for line in lines {
        let points = line.points.iter().copied();
        let (colour, width, size, filled) = match line.style {
            Style::Line(i) => (COLOURS[i % COLOURS.len()], 2, 3, true),
            Style::Dots(i) => (COLOURS[i % COLOURS.len()], 0, 3, true),
            Style::Rings(i) => (COLOURS[i % COLOURS.len()], 0, 7, false),
            Style::Law => (RGBColor(130, 130, 130), 1, 0, false),
        };
        let stroke = colour.stroke_width(width.max(1));
        let dots = if filled { colour.filled() } else { colour.stroke_width(2) };
        if width > 0 {
            chart.draw_series(LineSeries::new(points.clone(), stroke))?;
        }
        let legend = chart.draw_series(points.map(|point| Circle::new(point, size, dots)))?;
        if !line.label.is_empty() {
            legend.label(&line.label).legend(move |(x, y)| {
                let mark = EmptyElement::at((x, y)) + Circle::new((9, 0), size.min(5), dots);
                mark + PathElement::new(if width > 0 { vec![(0, 0), (18, 0)] } else { vec![] }, stroke)
            });
        }
    }
    if lines.iter().all(|line| line.label.is_empty()) {
        return Ok(());
    }
    chart
        .configure_series_labels()
        .position(corner)
        .background_style(WHITE.mix(0.8))
        .border_style(TRANSPARENT)
        .draw()
}

/// The label of a number at an axis, without trailing zeros.
fn tick(value: f64) -> String {
    let text = short(value);
    let (digits, power) =
        text.split_once('e').map_or((text.as_str(), None), |(digits, power)| (digits, Some(power)));
    let digits =
        if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits };
    power.map_or(digits.to_owned(), |power| format!("{digits}e{power}"))
}

/// The corner with the fewest points, for the legend; one on the right where corners are equal.
fn emptier_corner(panel: &Panel, lines: &[Line], x: &Range<f64>, y: &Range<f64>) -> SeriesLabelPosition {
    let middle = |range: &Range<f64>, log: bool| {
        if log { (range.start * range.end).sqrt() } else { 0.5 * (range.start + range.end) }
    };
    let (x, y) = (middle(x, panel.x.log), middle(y, panel.y.log));
    let places = || lines.iter().flat_map(|line| &line.points);
    let crowd =
        |right: bool, above: bool| places().filter(|p| (p.0 > x) == right && (p.1 > y) == above).count();
    let corners = [
        (crowd(true, true), SeriesLabelPosition::UpperRight),
        (crowd(true, false), SeriesLabelPosition::LowerRight),
        (crowd(false, true), SeriesLabelPosition::UpperLeft),
        (crowd(false, false), SeriesLabelPosition::LowerLeft),
    ];
    let emptiest = corners.into_iter().min_by_key(|(points, _)| *points);
    emptiest.map_or(SeriesLabelPosition::UpperRight, |(_, corner)| corner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_have_no_digits_to_spare() {
        for (value, text) in
            [(0.01, "0.01"), (1e-4, "1e-4"), (2.5e7, "2.5e7"), (100.0, "100"), (0.0, "0"), (1.2, "1.2")]
        {
            assert_eq!(tick(value), text);
        }
    }
}
