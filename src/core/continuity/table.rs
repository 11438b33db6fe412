//! The figures of several bodies of light, one row for each.

use serde::Serialize;

use super::{Continuity, FIGURES};

/// A table of figures. As JSON it is the list of its rows.
#[derive(Clone, Debug, Default, Serialize)]
#[serde(transparent)]
pub struct Table {
    /// In their order.
    pub rows: Vec<Row>,
}

/// One body of light.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// What it is, in words.
    pub name: String,
    /// Its figures.
    #[serde(flatten)]
    pub figures: Continuity,
}

impl Table {
    /// As Markdown, its columns in line. Figures that no row has are left out.
    pub fn to_text(&self) -> String {
        let shown = FIGURES.iter().filter(|f| self.rows.iter().any(|row| f.text(&row.figures).is_some()));
        let mut columns = vec![column("", self.rows.iter().map(|row| row.name.clone()))];
        columns.extend(shown.map(|figure| {
            column(figure.name, self.rows.iter().map(|row| figure.text(&row.figures).unwrap_or_default()))
        }));
        let width = |column: &[String]| column.iter().map(|cell| cell.chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = columns.iter().map(|column| width(column)).collect();
        let mut text = String::new();
        for line in 0..=self.rows.len() {
            let cells = columns.iter().zip(&widths).enumerate();
            let cell = |(i, (column, &width)): (usize, (&Vec<String>, &usize))| {
                let cell = &column[line];
                // Names to the left, numbers to the right.
                if i == 0 { format!("| {cell:<width$} ") } else { format!("| {cell:>width$} ") }
            };
            text += &cells.map(cell).collect::<String>();
            text += "|\n";
            if line == 0 {
                let rule = |(i, width): (usize, &usize)| {
                    let (dashes, end) = ("-".repeat(width + 1), if i == 0 { "-" } else { ":" });
                    format!("|{dashes}{end}")
                };
                text += &widths.iter().enumerate().map(rule).collect::<String>();
                text += "|\n";
            }
        }
        text
    }
}

fn column(heading: &str, cells: impl Iterator<Item = String>) -> Vec<String> {
    [heading.to_owned()].into_iter().chain(cells).collect()
}
