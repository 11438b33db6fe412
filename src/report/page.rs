//! A report as one HTML page that needs no other file.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html as markup};

use crate::content::{Cell, Part, Pictures, Section, Table, Tone};
use crate::report::{Absent, Report};
use lightloom_core::Result;

const STYLE: &str = include_str!("page.css");

/// The page.
///
/// # Errors
/// `Numeric` when a plot holds a number that is not finite.
pub(crate) fn html(report: &Report) -> Result<String> {
    let sections = report.sections.iter().map(section).collect::<Result<Vec<_>>>()?;
    let page = markup! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "Lightloom: " (report.title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { (report.title) }
                p.made { (report.made_by) ", " (format!("{:.0} s", report.seconds)) }
                nav { @for section in &report.sections { a href={ "#" (section.name) } { (section.title) } } }
                @for section in &sections { (section) }
                @if !report.absent.is_empty() { (absent(&report.absent)) }
            }
        }
    };
    Ok(page.into_string())
}

fn section(section: &Section) -> Result<Markup> {
    let parts = section.parts.iter().map(part).collect::<Result<Vec<_>>>()?;
    Ok(markup! {
        section id=(section.name) {
            h2 { (section.title) }
            @for part in &parts { (part) }
        }
    })
}

fn part(part: &Part) -> Result<Markup> {
    Ok(match part {
        Part::Text(text) => markup! { p { (text) } },
        Part::Table(shown) => table(shown),
        Part::Plot(plot) => {
            let svg = plot.to_svg()?;
            markup! { figure.plot { (PreEscaped(svg)) } }
        }
        Part::Pictures(shown) => pictures(shown),
    })
}

fn table(table: &Table) -> Markup {
    markup! {
        figure {
            figcaption { (table.caption) }
            table {
                thead { tr { @for column in &table.columns { th { (column) } } } }
                tbody {
                    @for row in &table.rows {
                        tr class=[class(row.tone)] { @for cell in &row.cells { (place(cell)) } }
                    }
                }
            }
        }
    }
}

fn class(tone: Tone) -> Option<&'static str> {
    match tone {
        Tone::Plain => None,
        Tone::Marked => Some("marked"),
        Tone::Bad => Some("bad"),
    }
}

fn place(cell: &Cell) -> Markup {
    match cell {
        Cell::Text(_) => markup! { td { (cell.short()) } },
        Cell::Number(value) => markup! { td.number title=(value) { (cell.short()) } },
        Cell::Nothing => markup! { td.number { (cell.short()) } },
    }
}

fn pictures(shown: &Pictures) -> Markup {
    let columns = shown.columns.max(1);
    markup! {
        figure {
            figcaption { (shown.caption) }
            div.pictures style={ "grid-template-columns: repeat(" (columns) ", 1fr)" } {
                @for picture in &shown.pictures {
                    figure {
                        img alt=(picture.label) src={ "data:image/png;base64," (BASE64_STANDARD.encode(&picture.png)) };
                        figcaption { (picture.label) }
                    }
                }
            }
        }
    }
}

fn absent(sections: &[Absent]) -> Markup {
    markup! {
        section id="absent" {
            h2 { "Not in this report" }
            ul {
                @for Absent { section, why, failed } in sections {
                    li class=[failed.then_some("bad")] { b { (section) } ": " (why) }
                }
            }
        }
    }
}
