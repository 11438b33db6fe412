//! Lines over one axis, some panels side by side, as SVG.

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::{Error, Result};

/// One line of a panel.
#[derive(Clone)]
pub(super) struct Line {
    pub(super) label: &'static str,
    pub(super) tone: Tone,
    pub(super) points: Vec<(f64, f64)>,
}

/// Colour of a line.
#[derive(Clone, Copy)]
pub(super) enum Tone {
    Blue,
    Red,
}

/// One picture of a figure.
pub(super) struct Panel {
    pub(super) title: &'static str,
    pub(super) lines: Vec<Line>,
}

/// Width and height of a panel in pixels.
const PANEL: (u32, u32) = (440, 300);
const TITLE: u32 = 34;

/// Draws the panels in rows of two under a title, over an axis of this name.
///
/// # Errors
/// `Numeric` when a number is not finite.
pub(super) fn draw(title: &str, axis: &str, panels: &[Panel]) -> Result<String> {
    let failed = |what: String| Error::Numeric { stage: "report", what };
    let points = || panels.iter().flat_map(|panel| &panel.lines).flat_map(|line| &line.points);
    if let Some(point) = points().find(|(x, y)| !(x.is_finite() && y.is_finite())) {
        return Err(failed(format!("{point:?} is not finite; take a larger alpha")));
    }
    let rows = panels.len().div_ceil(2);
    let mut svg = String::new();
    {
        let size = (2 * PANEL.0, TITLE + rows as u32 * PANEL.1);
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE)
            .and_then(|()| root.titled(title, ("sans-serif", 20)))
            .and_then(|area| {
                let cells = area.split_evenly((rows, 2));
                cells.iter().zip(panels).try_for_each(|(cell, panel)| draw_panel(cell, axis, panel))
            })
            .and_then(|()| root.present())
            .map_err(|error| failed(error.to_string()))?;
    }
    Ok(svg)
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Failure<'a> = DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>;

fn draw_panel<'a>(area: &Area<'a>, axis: &str, panel: &Panel) -> Result<(), Failure<'a>> {
    let points = || panel.lines.iter().flat_map(|line| &line.points);
    let (left, right) =
        points().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p.0), b.max(p.0)));
    // From 0, so that a line that looks flat is flat; nothing at all still needs an axis.
    let top = points().map(|p| p.1).fold(0.0, f64::max);
    let top = if top > 0.0 { 1.08 * top } else { 1.0 };
    let mut chart = ChartBuilder::on(area)
        .caption(panel.title, ("sans-serif", 15))
        .margin(8)
        .margin_right(16)
        .x_label_area_size(34)
        .y_label_area_size(44)
        .build_cartesian_2d(left..right, 0.0..top)?;
    chart.configure_mesh().x_desc(axis).light_line_style(TRANSPARENT).draw()?;
    for line in &panel.lines {
        let colour = match line.tone {
            Tone::Blue => RGBColor(31, 90, 170),
            Tone::Red => RGBColor(200, 60, 40),
        };
        let style = colour.stroke_width(2);
        chart
            .draw_series(LineSeries::new(line.points.iter().copied(), style).point_size(3))?
            .label(line.label)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
    }
    // On the right, where the lines are not.
    let ends = panel.lines.first().and_then(|line| Some((line.points.first()?.1, line.points.last()?.1)));
    let rises = ends.is_some_and(|(begin, end)| end > begin);
    chart
        .configure_series_labels()
        .position(if rises { SeriesLabelPosition::LowerRight } else { SeriesLabelPosition::UpperRight })
        .background_style(WHITE.mix(0.8))
        .border_style(TRANSPARENT)
        .draw()
}
